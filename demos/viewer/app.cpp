#include "demos/viewer/app.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "demos/viewer/frame_times.hpp"
#include "demos/viewer/gui.hpp"
#include "demos/viewer/orbit.hpp"
#include "demos/viewer/panel.hpp"
#include "demos/viewer/present.hpp"
#include "demos/viewer/window.hpp"
#include "demos/viewer/window_events.hpp"
#include "reference/image_compare.hpp"

namespace nacre {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kPoll = 0.5;  ///< seconds between two looks at the files
constexpr int kSettle = 3;     ///< frames after an event until the panel has taken it in

double secondsSince(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

class App {
public:
    App(const ViewerOptions& options, const ReferenceTracer& tracer, const SessionState* last)
        : options_(options),
          window_("nacre: " + options.file.filename().string(), options.width + (options.panel ? kPanelWidth : 0),
                  options.height, options.benchmark == 0),
          session_({options.file, options.assetFolders, options.samples}),
          restored_(last != nullptr),
          comparison_(
              tracer, [] { glfwPostEmptyEvent(); }, options.referencePasses, options.referenceScale) {
        if (last != nullptr) session_.restore(*last);
        if (options.target > 0) session_.quality.emplace(options.target);
        state_.open = options.panel;
        state_.white = options.white.value_or(1);
        state_.wantsAutoExposure = !options.white;
        state_.device = fmt::format("{}", reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
        glfwShowWindow(window_.handle());
    }

    /// \return false: the context was lost
    bool run() {
        auto lastTurn = Clock::now(), lastPoll = lastTurn;
        while (glfwWindowShouldClose(window_.handle()) == GLFW_FALSE && !state_.wantsQuit) {
            waitForEvents();
            if (events_.take()) settle();
            if (window_.lost() || (!restored_ && shownFrames_ == options_.loseContextAfter && shownFrames_ > 0))
                return false;
            session_.advance(std::min(secondsSince(lastTurn), 0.25));
            lastTurn = Clock::now();
            if (secondsSince(lastPoll) >= kPoll) {
                if (session_.poll()) settle();
                lastPoll = Clock::now();
            }
            turn();
            if (frames_.done()) {
                printBenchmark();
                break;
            }
        }
        return true;
    }

    SessionState session() const { return session_.state(); }

private:
    void settle() { unsettled_ = kSettle; }

    void waitForEvents() {
        const bool busy = unsettled_ > 0 || options_.benchmark > 0 || session_.refines() ||
                          (session_.playing && session_.scene().duration > 0 && session_.width() > 0);
        if (busy)
            glfwPollEvents();
        else
            glfwWaitEventsTimeout(comparison_.waits() ? 0.05 : kPoll);
    }

    /// Draws what changed.
    void turn() {
        int width = 0, height = 0;
        glfwGetFramebufferSize(window_.handle(), &width, &height);
        if (width < 1 || height < 1) return;  // minimised
        const auto begin = Clock::now();
        session_.resize(std::max(0, width - static_cast<int>(pictureOrigin(state_).x)), height);
        if (options_.benchmark > 0) session_.touch();
        const bool fresh = session_.draw();
        if (session_.target() == nullptr) return;
        if (state_.wantsAutoExposure) fitExposure();
        const bool compared = comparison_.poll(session_, state_.white);
        if (!fresh && !compared && unsettled_ == 0) return;
        if (fresh || compared) {
            if (comparison_.image())
                presenter_.take(*comparison_.image());
            else
                presenter_.take(*session_.target());
            settle();
        }
        --unsettled_;
        show(width, height);
        if (fresh && session_.pictures() == 1) session_.touch();  // the first one compiles: no time to show
        if (fresh && session_.pictures() > 1) {
            frames_.add(secondsSince(begin));
            state_.frameSeconds = frames_.smoothed();
        }
        afterFrame(fresh);
    }

    void show(int width, int height) {
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        glDisable(GL_SCISSOR_TEST);
        glClearColor(0.1f, 0.1f, 0.1f, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        const auto left = static_cast<int>(pictureOrigin(state_).x);
        const bool error = comparison_.image() && comparison_.shown == Shown::Difference;
        if (width > left) presenter_.show(session_.loader(), {left, 0, width - left, height}, error ? 1 : state_.white);
        gui_.begin();
        const double white = state_.white;
        const Shown shown = comparison_.shown;
        drawPanel(session_, comparison_, state_, pictureOrigin(state_), {width, height});
        gui_.draw();
        if (white != state_.white || shown != comparison_.shown) settle();
        glfwSwapBuffers(window_.handle());
        ++shownFrames_;
    }

    /// What the panel asked for.
    void afterFrame(bool fresh) {
        if (state_.wantsFind) {
            state_.found = findAssets(session_.assetFolders());
            state_.wantsFind = false;
            settle();
        }
        if (!state_.wantsCopy.empty()) {
            glfwSetClipboardString(window_.handle(), state_.wantsCopy.c_str());
            state_.note = "copied: " + std::exchange(state_.wantsCopy, {});
            settle();
        }
        if (std::exchange(state_.wantsScreenshot, false)) takeScreenshot();
        if (options_.trace) printTrace(fresh);
    }

    void takeScreenshot() {
        try {
            const bool error = comparison_.image() && comparison_.shown == Shown::Difference;
            const Image image = comparison_.image() ? *comparison_.image() : session_.target()->read();
            screenshot_ = writeScreenshot(image, options_.screenshots, error ? 1 : state_.white).string();
            state_.note = "wrote " + screenshot_ + " and .exr";
        } catch (const std::exception& failure) {
            state_.note = failure.what();
        }
        settle();
    }

    void fitExposure() {
        state_.wantsAutoExposure = false;
        state_.white = pictureWhite(session_.target()->read());
        settle();
    }

    void printTrace(bool fresh) {
        int x = 0, y = 0;
        glfwGetWindowPos(window_.handle(), &x, &y);
        nlohmann::json line = {{"frame", shownFrames_},
                               {"window", {x, y}},
                               {"pictures", session_.pictures()},
                               {"fresh", fresh},
                               {"width", session_.width()},
                               {"height", session_.height()},
                               {"origin", pictureOrigin(state_).x},
                               {"white", state_.white},
                               {"time", session_.time},
                               {"playing", session_.playing},
                               {"help", state_.help},
                               {"panel", state_.open},
                               {"node", state_.node},
                               {"quality", qualityName(session_.quality ? session_.quality->level() : 0)},
                               {"settled", unsettled_ == 0},
                               {"reference_passes", comparison_.passes()},
                               {"screenshot", screenshot_},
                               {"problems", session_.problems()}};
        line.update(nlohmann::json::parse("{" + cameraText(session_.camera) + "}"));
        for (const SceneNode& node : session_.scene().nodes) line["materials"].push_back(node.material);
        for (const SceneLight& light : session_.scene().lights) {
            const Vec3& p = light.light.position;
            line["lights"].push_back({p.x, p.y, p.z});
        }
        for (const SceneAsset& asset : session_.scene().assets)
            line["assets"].push_back(asset.file.filename().string());
        for (const auto& [name, at] : state_.places) line["places"][name] = {at.x, at.y};
        if (const auto& d = comparison_.difference()) line["psnr"] = d->psnrSrgb;
        std::printf("%s\n", line.dump().c_str());
        std::fflush(stdout);
    }

    void printBenchmark() const {
        nlohmann::json line = frames_.result();
        line.update({{"width", session_.width()},
                     {"height", session_.height()},
                     {"samples", options_.samples},
                     {"device", state_.device}});
        std::printf("%s\n", line.dump().c_str());
    }

    ViewerOptions options_;
    Window window_;  ///< first: the rest needs its context
    ViewerSession session_;
    Presenter presenter_;
    bool restored_;  ///< after a lost context
    Comparison comparison_;
    PanelState state_;
    WindowEvents events_{window_.handle(), session_, comparison_, state_};
    Gui gui_{window_.handle()};  ///< after the events: it chains to their callbacks
    FrameTimes frames_{options_.benchmark};
    int unsettled_ = kSettle, shownFrames_ = 0;
    std::string screenshot_;
};

}  // namespace

void runViewer(const ViewerOptions& options, const ReferenceTracer& tracer) {
    for (auto app = std::make_unique<App>(options, tracer, nullptr); !app->run();) {
        const SessionState last = app->session();
        app.reset();  // GLFW and Dear ImGui go with the old window
        app = std::make_unique<App>(options, tracer, &last);
    }
}

}  // namespace nacre
