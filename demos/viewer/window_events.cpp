#include "demos/viewer/window_events.hpp"

#include <imgui.h>

#include <algorithm>

#include "demos/viewer/actions.hpp"
#include "demos/viewer/light_drag.hpp"
#include "demos/viewer/orbit.hpp"

namespace nacre {

static constexpr double kMarkRadius = 9;     ///< of a light's mark [pixels]
static constexpr double kClickDistance = 3;  ///< a press that moves less is a click [pixels]

static_assert(GLFW_KEY_F1 == 290 && GLFW_KEY_TAB == 258 && GLFW_KEY_HOME == 268 && GLFW_KEY_LEFT == 263 &&
              GLFW_KEY_RIGHT == 262 && GLFW_KEY_F5 == 294 && GLFW_KEY_ESCAPE == 256 && GLFW_KEY_S == 'S' &&
              GLFW_KEY_EQUAL == '=' && GLFW_KEY_SPACE == ' ');

WindowEvents& WindowEvents::of(GLFWwindow* window) {
    return *static_cast<WindowEvents*>(glfwGetWindowUserPointer(window));
}

WindowEvents::WindowEvents(GLFWwindow* on, ViewerSession& session, Comparison& comparison, PanelState& state)
    : window_(on), session_(session), comparison_(comparison), state_(state) {
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int mods) {
        WindowEvents& events = of(window);
        events.any_ = true;
        const bool typing = ImGui::GetIO().WantTextInput || (mods & (GLFW_MOD_CONTROL | GLFW_MOD_ALT)) != 0;
        if (action != GLFW_RELEASE && !typing)
            if (const std::optional<Action> known = actionOf(key))
                act(*known, events.session_, events.comparison_, events.state_);
    });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* window, int button, int action, int mods) {
        of(window).any_ = true;
        of(window).press(button, action == GLFW_PRESS, mods);
    });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* window, double x, double y) {
        of(window).any_ = true;
        of(window).moveMouse({x, y});
    });
    glfwSetScrollCallback(window_, [](GLFWwindow* window, double, double steps) {
        of(window).any_ = true;
        of(window).scroll(steps);
    });
    glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
        if (count > 0) of(window).session_.open(paths[0]);
        of(window).state_.wantsFind = true;
        of(window).any_ = true;
    });
    glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* window, int, int) { of(window).any_ = true; });
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* window) { of(window).any_ = true; });
    glfwSetCharCallback(window_, [](GLFWwindow* window, unsigned) { of(window).any_ = true; });
}

bool WindowEvents::inPictureArea(Vec2 at) const {
    return at.x >= pictureOrigin(state_).x && !ImGui::GetIO().WantCaptureMouse && session_.width() > 0;
}

void WindowEvents::press(int button, bool down, int mods) {
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
    if (button == GLFW_MOUSE_BUTTON_RIGHT && choose()) drag_ = Drag::Object;
    if (button != GLFW_MOUSE_BUTTON_LEFT) return;
    drag_ = control && shift ? Drag::Aim : control ? Drag::Light : shift ? Drag::Pan : Drag::Orbit;
    if (drag_ != Drag::Orbit) return;
    for (const LightMark& mark : lightMarks(session_))
        if (glm::length(mark.at - (mouse_ - pictureOrigin(state_))) <= kMarkRadius) {
            state_.light = mark.light;
            drag_ = Drag::Light;
        }
}

bool WindowEvents::choose() {
    const int node = nodeAt(session_.scene(), nodeTransforms(session_.scene(), session_.time), session_.camera,
                            mouse_ - pictureOrigin(state_), {session_.width(), session_.height()});
    if (node >= 0) state_.node = node;
    return node >= 0;
}

/// The chosen one.
void WindowEvents::moveObject(Vec2 by) {
    const auto node = static_cast<std::size_t>(state_.node);
    const SceneDescription& scene = session_.scene();
    if (node >= scene.nodes.size()) return;
    session_.setNodeTranslation(
        node, draggedNode(scene, nodeTransforms(scene, session_.time), node, session_.camera, by, session_.height()));
}

void WindowEvents::moveMouse(Vec2 to) {
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
    if (drag_ == Drag::Object) moveObject(by);
    if (drag_ == Drag::Light)
        changeLight([&](const Light& light) { return dragged(light, session_.camera, by, height); });
    if (drag_ == Drag::Aim) changeLight([&](const Light& light) { return aimed(light, session_.camera, by, height); });
}

void WindowEvents::scroll(double steps) {
    if (!inPictureArea(mouse_)) return;
    const bool control = glfwGetKey(window_, GLFW_KEY_LEFT_CONTROL) == GLFW_PRESS ||
                         glfwGetKey(window_, GLFW_KEY_RIGHT_CONTROL) == GLFW_PRESS;
    if (control)
        changeLight([&](const Light& light) { return pulled(light, session_.camera, steps); });
    else
        session_.move(zoomed(session_.camera, steps));
}

void WindowEvents::changeLight(const std::function<Light(const Light&)>& change) {
    const SceneDescription& scene = session_.scene();
    if (scene.lights.empty()) return;
    const auto chosen =
        static_cast<std::size_t>(std::clamp(state_.light, 0, static_cast<int>(scene.lights.size()) - 1));
    const std::vector<glm::dmat4> nodes = nodeTransforms(scene, session_.time);
    const Light now = lightsInWorld(scene, nodes)[chosen];
    session_.setLight(chosen, placedInWorld(scene.lights[chosen], change(now), nodes));
}

}  // namespace nacre
