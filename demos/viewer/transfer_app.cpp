#include "demos/viewer/transfer_app.hpp"

#include <epoxy/gl.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "demos/viewer/frame_times.hpp"
#include "demos/viewer/gui.hpp"
#include "demos/viewer/key_map.hpp"
#include "demos/viewer/orbit.hpp"
#include "demos/viewer/panel.hpp"
#include "demos/viewer/present.hpp"
#include "demos/viewer/transfer_panel.hpp"
#include "demos/viewer/window.hpp"
#include "reference/image_compare.hpp"

namespace nacre {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kSettle = 3;  ///< frames after an event until the panel has taken it in

double secondsSince(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

class TransferApp {
public:
    explicit TransferApp(const ViewerOptions& options)
        : options_(options),
          window_("nacre: " + options.file.filename().string(), options.width + (options.panel ? kPanelWidth : 0),
                  options.height, options.benchmark == 0),
          session_({options.file.string(), options.liveTransfer, options.environments, options.samples}) {
        state_.open = options.panel;
        state_.white = options.white.value_or(1);
        state_.wantsAutoExposure = !options.white;
        state_.device = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
        glfwShowWindow(window_.handle());
    }

    void run() {
        auto lastTurn = Clock::now();
        while (glfwWindowShouldClose(window_.handle()) == GLFW_FALSE && !frames_.done()) {
            if (session_.playing || unsettled_ > 0 || options_.benchmark > 0)
                glfwPollEvents();
            else
                glfwWaitEvents();
            if (window_.lost()) throw Error("view: the driver has lost the context");
            session_.advance(std::min(secondsSince(lastTurn), 0.25));
            lastTurn = Clock::now();
            turn();
        }
        if (!frames_.done()) return;
        nlohmann::json line = frames_.result();
        line.update({{"width", session_.width()},
                     {"height", session_.height()},
                     {"samples", options_.samples},
                     {"vertices_per_second", session_.verticesPerSecond()},
                     {"device", state_.device}});
        std::printf("%s\n", line.dump().c_str());
    }

private:
    static TransferApp& of(GLFWwindow* window) { return *static_cast<TransferApp*>(glfwGetWindowUserPointer(window)); }
    int left() const { return state_.open ? kPanelWidth : 0; }

    GLFWwindow* listen() {
        GLFWwindow* window = window_.handle();
        glfwSetWindowUserPointer(window, this);
        glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int mods) {
            of(w).settle();
            if (action != GLFW_RELEASE && (mods & (GLFW_MOD_CONTROL | GLFW_MOD_ALT)) == 0)
                if (const std::optional<Action> known = actionOf(key)) of(w).act(*known);
        });
        glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int mods) {
            of(w).settle();
            of(w).press(button, action == GLFW_PRESS, mods);
        });
        glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
            of(w).settle();
            of(w).moveMouse({x, y});
        });
        glfwSetScrollCallback(window, [](GLFWwindow* w, double, double steps) {
            of(w).settle();
            if (!ImGui::GetIO().WantCaptureMouse) of(w).session_.move(zoomed(of(w).session_.camera, steps));
        });
        glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { of(w).settle(); });
        glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { of(w).settle(); });
        return window;
    }

    void settle() { unsettled_ = kSettle; }

    void act(Action action) {
        const double third = std::exp2(1.0 / 3);
        if (action == Action::Panel) state_.open = !state_.open;
        if (action == Action::Screenshot) state_.wantsScreenshot = true;
        if (action == Action::PlayPause) session_.playing = session_.player().frameCount() > 1 && !session_.playing;
        if (action == Action::StepBack) session_.step(-1);
        if (action == Action::StepForward) session_.step(1);
        if (action == Action::ResetCamera) session_.resetCamera();
        if (action == Action::Darker) state_.white *= third;
        if (action == Action::Brighter) state_.white /= third;
        if (action == Action::AutoExposure) state_.wantsAutoExposure = true;
        if (action == Action::Quit) glfwSetWindowShouldClose(window_.handle(), GLFW_TRUE);
    }

    void press(int button, bool down, int mods) {
        drag_ = Drag::None;
        if (!down || ImGui::GetIO().WantCaptureMouse || mouse_.x < left()) return;
        if (button == GLFW_MOUSE_BUTTON_MIDDLE) drag_ = Drag::Pan;
        if (button != GLFW_MOUSE_BUTTON_LEFT) return;
        drag_ = mods & GLFW_MOD_CONTROL ? Drag::Light : mods & GLFW_MOD_SHIFT ? Drag::Pan : Drag::Orbit;
    }

    void moveMouse(Vec2 to) {
        const Vec2 by = to - mouse_;
        mouse_ = to;
        const int height = session_.height();
        if (height < 1) return;
        if (drag_ == Drag::Orbit) session_.move(orbited(session_.camera, by, height));
        if (drag_ == Drag::Pan) session_.move(panned(session_.camera, by, height));
        if (drag_ == Drag::Light) session_.turnLight(kPi / height * by.x);  // as fast as a drag turns the scene
    }

    /// Draws what changed.
    void turn() {
        int width = 0, height = 0;
        glfwGetFramebufferSize(window_.handle(), &width, &height);
        if (width < 1 || height < 1) return;  // minimised
        const auto begin = Clock::now();
        session_.resize(std::max(0, width - left()), height);
        if (options_.benchmark > 0) benchmarkStep();
        const bool fresh = session_.draw();
        if (!fresh && unsettled_ == 0) return;
        if (fresh) {
            presenter_.take(*session_.target());
            settle();
        }
        if (session_.pictures() > 0 && std::exchange(state_.wantsAutoExposure, false))
            state_.white = pictureWhite(session_.target()->read());
        --unsettled_;
        show(width, height);
        if (fresh && session_.pictures() > 1) {  // the first one compiles
            frames_.add(secondsSince(begin));
            state_.frameSeconds = frames_.smoothed();
        }
        if (std::exchange(state_.wantsScreenshot, false)) takeScreenshot();
        if (options_.trace) printTrace();
    }

    /// One frame after the other, however long they take; a mesh that stands still turns its light.
    void benchmarkStep() {
        session_.step(1);
        session_.turnLight(0.01);
    }

    void show(int width, int height) {
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        glDisable(GL_SCISSOR_TEST);
        glClearColor(0.1f, 0.1f, 0.1f, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        if (width > left() && session_.pictures() > 0)
            presenter_.show(session_.loader(), {left(), 0, width - left(), height}, state_.white);
        gui_.begin();
        const double white = state_.white;
        drawTransferPanel(session_, state_, height);
        gui_.draw();
        if (white != state_.white) settle();
        glfwSwapBuffers(window_.handle());
        ++shownFrames_;
    }

    void takeScreenshot() {
        try {
            screenshot_ = writeScreenshot(session_.target()->read(), options_.screenshots, state_.white).string();
            state_.note = "wrote " + screenshot_ + " and .exr";
        } catch (const std::exception& failure) {
            state_.note = failure.what();
        }
        settle();
    }

    void printTrace() const {
        int x = 0, y = 0;
        glfwGetWindowPos(window_.handle(), &x, &y);
        nlohmann::json line = {{"frame", shownFrames_},
                               {"window", {x, y}},
                               {"pictures", session_.pictures()},
                               {"width", session_.width()},
                               {"height", session_.height()},
                               {"origin", left()},
                               {"white", state_.white},
                               {"shown", session_.player().frameNumber(session_.frame())},
                               {"playing", session_.playing},
                               {"turn", session_.light.turn},
                               {"weights", session_.light.weights},
                               {"computed", session_.player().cost().computed},
                               {"vertices_per_second", session_.verticesPerSecond()},
                               {"settled", unsettled_ == 0},
                               {"screenshot", screenshot_},
                               {"problem", session_.problem()}};
        line.update(nlohmann::json::parse("{" + cameraText(session_.camera) + "}"));
        std::printf("%s\n", line.dump().c_str());
        std::fflush(stdout);
    }

    enum class Drag { None, Orbit, Pan, Light };

    ViewerOptions options_;
    Window window_;  ///< first: the rest needs its context
    TransferSession session_;
    Presenter presenter_;
    TransferPanelState state_;
    Gui gui_{listen()};  ///< it chains to the callbacks
    FrameTimes frames_{options_.benchmark};
    Drag drag_ = Drag::None;
    Vec2 mouse_{0};
    int unsettled_ = kSettle, shownFrames_ = 0;
    std::string screenshot_;
};

}  // namespace

void runTransferViewer(const ViewerOptions& options) { TransferApp(options).run(); }

}  // namespace nacre
