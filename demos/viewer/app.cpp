#include "demos/viewer/app.hpp"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "demos/viewer/key_map.hpp"
#include "demos/viewer/light_drag.hpp"
#include "demos/viewer/orbit.hpp"
#include "demos/viewer/panel.hpp"
#include "demos/viewer/present.hpp"
#include "demos/viewer/window.hpp"
#include "reference/image_compare.hpp"

namespace nacre {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kPoll = 0.5;         ///< seconds between two looks at the files
constexpr int kSettle = 3;            ///< frames after an event until the panel has taken it in
constexpr double kMarkRadius = 9;     ///< of a light's mark [pixels]
constexpr double kClickDistance = 3;  ///< a press that moves less is a click [pixels]

static_assert(GLFW_KEY_F1 == 290 && GLFW_KEY_TAB == 258 && GLFW_KEY_HOME == 268 && GLFW_KEY_LEFT == 263 &&
              GLFW_KEY_RIGHT == 262 && GLFW_KEY_F5 == 294 && GLFW_KEY_ESCAPE == 256 && GLFW_KEY_S == 'S' &&
              GLFW_KEY_EQUAL == '=' && GLFW_KEY_SPACE == ' ');

double secondsSince(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// Dear ImGui's global context, as long as a window.
class Gui {
public:
    explicit Gui(GLFWwindow* window) {
        IMGUI_CHECKVERSION();
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr;  // no imgui.ini in the current folder
        ImGui::StyleColorsDark();
        ImGui_ImplGlfw_InitForOpenGL(window, true);
        ImGui_ImplOpenGL3_Init("#version 330 core");
    }
    ~Gui() {
        ImGui_ImplOpenGL3_Shutdown();
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
    }
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;
};

enum class Drag { None, Orbit, Pan, Light, Aim };

class App {
public:
    App(const ViewerOptions& options, const ReferenceTracer& tracer, const ViewerSession* last)
        : options_(options),
          window_("nacre: " + options.file.filename().string(), options.width + (options.panel ? kPanelWidth : 0),
                  options.height, options.benchmark == 0),
          session_({options.file, options.assetFolders, options.samples}),
          comparison_(
              tracer, [] { glfwPostEmptyEvent(); }, options.referencePasses, options.referenceScale) {
        if (last != nullptr) session_.restore(*last);
        state_.open = options.panel;
        state_.white = options.white.value_or(1);
        state_.wantsAutoExposure = !options.white;
        state_.device = fmt::format("{}", reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
        listen();
        gui_.emplace(window_.handle());  // chains to our callbacks
        glfwShowWindow(window_.handle());
    }

    /// \return false: the context was lost
    bool run() {
        auto lastTurn = Clock::now(), lastPoll = lastTurn;
        while (glfwWindowShouldClose(window_.handle()) == GLFW_FALSE) {
            waitForEvents();
            if (window_.lost()) return false;
            session_.advance(std::min(secondsSince(lastTurn), 0.25));
            lastTurn = Clock::now();
            if (secondsSince(lastPoll) >= kPoll) {
                if (session_.poll()) settle();
                lastPoll = Clock::now();
            }
            if (turn() && options_.benchmark > 0 && benchmarkDone()) break;
        }
        return true;
    }

    const ViewerSession& session() const { return session_; }

private:
    void settle() { unsettled_ = kSettle; }

    void waitForEvents() {
        const bool busy = unsettled_ > 0 || options_.benchmark > 0 ||
                          (session_.playing && session_.scene().duration > 0 && session_.width() > 0);
        if (busy)
            glfwPollEvents();
        else
            glfwWaitEventsTimeout(comparison_.waits() ? 0.05 : kPoll);
    }

    Vec2 origin() const { return {state_.open ? kPanelWidth : 0, 0}; }

    /// Draws what changed. \return whether a frame was shown
    bool turn() {
        int width = 0, height = 0;
        glfwGetFramebufferSize(window_.handle(), &width, &height);
        if (width < 1 || height < 1) return false;  // minimised
        const auto begin = Clock::now();
        session_.resize(std::max(0, width - static_cast<int>(origin().x)), height);
        if (options_.benchmark > 0) session_.touch();
        const bool fresh = session_.draw();
        if (session_.target() == nullptr) return false;
        if (state_.wantsAutoExposure) fitExposure();
        const bool compared = comparison_.poll(session_, state_.white);
        if (!fresh && !compared && unsettled_ == 0) return false;
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
        if (fresh && session_.pictures() > 1) measure(secondsSince(begin));
        afterFrame(fresh);
        return true;
    }

    void show(int width, int height) {
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        glDisable(GL_SCISSOR_TEST);
        glClearColor(0.1f, 0.1f, 0.1f, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        const auto left = static_cast<int>(origin().x);
        const bool error = comparison_.image() && comparison_.shown == Shown::Difference;
        if (width > left) presenter_.show(session_.loader(), {left, 0, width - left, height}, error ? 1 : state_.white);
        ImGui_ImplOpenGL3_NewFrame();
        ImGui_ImplGlfw_NewFrame();
        ImGui::NewFrame();
        const double white = state_.white;
        const Shown shown = comparison_.shown;
        drawPanel(session_, comparison_, state_, origin(), {width, height});
        ImGui::Render();
        ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
        if (white != state_.white || shown != comparison_.shown) settle();
        glfwSwapBuffers(window_.handle());
        ++shownFrames_;
    }

    void measure(double seconds) {
        frames_.push_back(seconds);
        if (options_.benchmark == 0 && frames_.size() > 64) frames_.erase(frames_.begin());
        double& kept = state_.frameSeconds;
        kept = kept == 0 || seconds > 10 * kept || seconds < 0.1 * kept ? seconds : kept + 0.2 * (seconds - kept);
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
                               {"origin", origin().x},
                               {"white", state_.white},
                               {"time", session_.time},
                               {"playing", session_.playing},
                               {"help", state_.help},
                               {"panel", state_.open},
                               {"node", state_.node},
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
        if (const auto& d = comparison_.difference()) line["psnr"] = d->psnrSrgb;
        std::printf("%s\n", line.dump().c_str());
        std::fflush(stdout);
    }

    bool benchmarkDone() {
        constexpr std::size_t kWarm = 3;  // the first frames compile
        if (frames_.size() <= kWarm) cpuStart_ = std::clock();
        if (frames_.size() < static_cast<std::size_t>(options_.benchmark) + kWarm) return false;
        const double cpu = static_cast<double>(std::clock() - cpuStart_) / CLOCKS_PER_SEC;
        std::vector<double> times(frames_.begin() + kWarm, frames_.end());
        double sum = 0;
        for (const double t : times) sum += t;
        std::sort(times.begin(), times.end());
        const auto count = static_cast<double>(times.size());
        std::printf("%s\n", nlohmann::json{{"frames", times.size()},
                                           {"width", session_.width()},
                                           {"height", session_.height()},
                                           {"samples", options_.samples},
                                           {"frames_per_second", count / sum},
                                           {"median_ms", 1e3 * times[times.size() / 2]},
                                           {"slowest_ms", 1e3 * times.back()},
                                           {"cpu_ms", 1e3 * cpu / count},
                                           {"device", state_.device}}
                                .dump()
                                .c_str());
        return true;
    }

    // ---- events
    static App& of(GLFWwindow* window) { return *static_cast<App*>(glfwGetWindowUserPointer(window)); }

    void listen() {
        GLFWwindow* w = window_.handle();
        glfwSetWindowUserPointer(w, this);
        glfwSetKeyCallback(w, [](GLFWwindow* window, int key, int, int action, int mods) {
            App& app = of(window);
            app.settle();
            const bool typing = ImGui::GetIO().WantTextInput || (mods & (GLFW_MOD_CONTROL | GLFW_MOD_ALT)) != 0;
            if (action != GLFW_RELEASE && !typing)
                if (const std::optional<Action> known = actionOf(key)) app.act(*known);
        });
        glfwSetMouseButtonCallback(w, [](GLFWwindow* window, int button, int action, int mods) {
            of(window).settle();
            of(window).press(button, action == GLFW_PRESS, mods);
        });
        glfwSetCursorPosCallback(w, [](GLFWwindow* window, double x, double y) {
            of(window).settle();
            of(window).moveMouse({x, y});
        });
        glfwSetScrollCallback(w, [](GLFWwindow* window, double, double steps) {
            of(window).settle();
            of(window).scroll(steps);
        });
        glfwSetDropCallback(w, [](GLFWwindow* window, int count, const char** paths) {
            if (count > 0) of(window).session_.open(paths[0]);
            of(window).state_.wantsFind = true;
            of(window).settle();
        });
        glfwSetFramebufferSizeCallback(w, [](GLFWwindow* window, int, int) { of(window).settle(); });
        glfwSetWindowRefreshCallback(w, [](GLFWwindow* window) { of(window).settle(); });
        glfwSetCharCallback(w, [](GLFWwindow* window, unsigned) { of(window).settle(); });
    }

    bool inPictureArea(Vec2 at) const {
        return at.x >= origin().x && !ImGui::GetIO().WantCaptureMouse && session_.width() > 0;
    }

    void press(int button, bool down, int mods) {
        if (!down) {
            if (drag_ == Drag::Orbit && !moved_ && button == GLFW_MOUSE_BUTTON_LEFT) choose();
            drag_ = Drag::None;
            return;
        }
        if (!inPictureArea(mouse_)) return;
        pressed_ = mouse_;
        moved_ = false;
        const bool control = (mods & GLFW_MOD_CONTROL) != 0, shift = (mods & GLFW_MOD_SHIFT) != 0;
        if (button == GLFW_MOUSE_BUTTON_MIDDLE) drag_ = Drag::Pan;
        if (button != GLFW_MOUSE_BUTTON_LEFT) return;
        drag_ = control && shift ? Drag::Aim : control ? Drag::Light : shift ? Drag::Pan : Drag::Orbit;
        if (drag_ != Drag::Orbit) return;
        for (const LightMark& mark : lightMarks(session_))
            if (glm::length(mark.at - (mouse_ - origin())) <= kMarkRadius) {
                state_.light = mark.light;
                drag_ = Drag::Light;
            }
    }

    void choose() {
        const int node = nodeAt(session_.scene(), nodeTransforms(session_.scene(), session_.time), session_.camera,
                                mouse_ - origin(), {session_.width(), session_.height()});
        if (node >= 0) state_.node = node;
    }

    void moveMouse(Vec2 to) {
        const Vec2 by = to - mouse_;
        mouse_ = to;
        if (drag_ == Drag::None || session_.height() < 1) return;
        if (!moved_ && glm::length(mouse_ - pressed_) < kClickDistance) {
            mouse_ = pressed_;  // what isn't a drag yet counts once it is
            return;
        }
        moved_ = true;
        const int height = session_.height();
        if (drag_ == Drag::Orbit) session_.move(orbited(session_.camera, by, height));
        if (drag_ == Drag::Pan) session_.move(panned(session_.camera, by, height));
        if (drag_ == Drag::Light)
            changeLight([&](const Light& light) { return dragged(light, session_.camera, by, height); });
        if (drag_ == Drag::Aim)
            changeLight([&](const Light& light) { return aimed(light, session_.camera, by, height); });
    }

    void scroll(double steps) {
        if (!inPictureArea(mouse_)) return;
        const bool control = glfwGetKey(window_.handle(), GLFW_KEY_LEFT_CONTROL) == GLFW_PRESS ||
                             glfwGetKey(window_.handle(), GLFW_KEY_RIGHT_CONTROL) == GLFW_PRESS;
        if (control)
            changeLight([&](const Light& light) { return pulled(light, session_.camera, steps); });
        else
            session_.move(zoomed(session_.camera, steps));
    }

    template <class Change>
    void changeLight(Change&& change) {
        const SceneDescription& scene = session_.scene();
        if (scene.lights.empty()) return;
        const auto chosen =
            static_cast<std::size_t>(std::clamp(state_.light, 0, static_cast<int>(scene.lights.size()) - 1));
        const std::vector<glm::dmat4> nodes = nodeTransforms(scene, session_.time);
        const Light now = lightsInWorld(scene, nodes)[chosen];
        session_.setLight(chosen, placedInWorld(scene.lights[chosen], change(now), nodes));
    }

    void act(Action action) {
        SceneSwitches& on = session_.switches;
        const auto flip = [&](bool& value) {
            value = !value;
            session_.touch();
        };
        const double duration = session_.scene().duration;
        const auto step = [&](double share) {
            session_.playing = false;
            session_.seek(session_.time + share * duration);
        };
        switch (action) {
            case Action::Help:
                state_.help = !state_.help;
                break;
            case Action::Panel:
                state_.open = !state_.open;
                break;
            case Action::Screenshot:
                state_.wantsScreenshot = true;
                break;
            case Action::PlayPause:
                session_.playing = duration > 0 && !session_.playing;
                break;
            case Action::StepBack:
                step(-0.05);
                break;
            case Action::StepForward:
                step(0.05);
                break;
            case Action::ResetCamera:
                session_.resetCamera();
                break;
            case Action::Darker:
                state_.white *= std::exp2(1.0 / 3);
                break;
            case Action::Brighter:
                state_.white /= std::exp2(1.0 / 3);
                break;
            case Action::AutoExposure:
                state_.wantsAutoExposure = true;
                break;
            case Action::Reflectance:
                on.reflectance = static_cast<SceneReflectance>((static_cast<int>(on.reflectance) + 1) % 3);
                session_.touch();
                break;
            case Action::Shadows:
                flip(on.shadows);
                break;
            case Action::Relief:
                flip(on.relief);
                break;
            case Action::Indirect:
                flip(on.indirect);
                break;
            case Action::Surrounding:
                flip(on.surrounding);
                break;
            case Action::Sky:
                flip(on.sky);
                break;
            case Action::View:
                comparison_.shown = static_cast<Shown>((static_cast<int>(comparison_.shown) + 1) % 3);
                break;
            case Action::NextLight:
                if (const auto count = static_cast<int>(session_.scene().lights.size()); count > 0)
                    state_.light = (state_.light + 1) % count;
                break;
            case Action::NextMaterial:
                nextMaterial();
                break;
            case Action::CopyCamera:
                state_.wantsCopy = cameraText(session_.camera);
                break;
            case Action::Reload:
                session_.reload();
                break;
            case Action::Quit:
                if (state_.help)
                    state_.help = false;
                else
                    glfwSetWindowShouldClose(window_.handle(), GLFW_TRUE);
                break;
        }
    }

    void nextMaterial() {
        if (state_.node < 0 || state_.node >= static_cast<int>(session_.scene().nodes.size())) return;
        const auto node = static_cast<std::size_t>(state_.node);
        const auto count = static_cast<int>(session_.scene().materials.size());
        session_.setNodeMaterial(node, (session_.scene().nodes[node].material + 1) % count);
    }

    ViewerOptions options_;
    Window window_;  ///< first: the rest needs its context
    ViewerSession session_;
    Presenter presenter_;
    Comparison comparison_;
    PanelState state_;
    std::optional<Gui> gui_;
    int unsettled_ = kSettle, shownFrames_ = 0;
    std::vector<double> frames_;  ///< seconds
    std::clock_t cpuStart_ = 0;   ///< of the benchmark, all cores
    std::string screenshot_;
    Drag drag_ = Drag::None;
    Vec2 mouse_{0}, pressed_{0};
    bool moved_ = false;
};

}  // namespace

void runViewer(const ViewerOptions& options, const ReferenceTracer& tracer) {
    auto app = std::make_unique<App>(options, tracer, nullptr);
    while (!app->run()) app = std::make_unique<App>(options, tracer, &app->session());  // a lost context
}

}  // namespace nacre
