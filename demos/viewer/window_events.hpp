// What mouse and keys do in the window.
#pragma once

#include <functional>
#include <utility>

#include "demos/viewer/comparison.hpp"
#include "demos/viewer/panel.hpp"
#include "demos/viewer/window.hpp"

namespace nacre {

/// The callbacks of one window, which edit a session and what the user has chosen. All of them outlive it.
class WindowEvents {
public:
    WindowEvents(GLFWwindow* window, ViewerSession& session, Comparison& comparison, PanelState& state);
    WindowEvents(const WindowEvents&) = delete;
    WindowEvents& operator=(const WindowEvents&) = delete;

    /// Whether there were any since the last call.
    bool take() { return std::exchange(any_, false); }

private:
    enum class Drag { None, Orbit, Pan, Light, Aim, Object };

    static WindowEvents& of(GLFWwindow* window);
    bool inPictureArea(Vec2 at) const;
    void press(int button, bool down, int mods);
    bool choose();  ///< what is under the mouse, if anything
    void moveObject(Vec2 by);
    void moveMouse(Vec2 to);
    void scroll(double steps);
    void changeLight(const std::function<Light(const Light&)>& change);

    GLFWwindow* window_;
    ViewerSession& session_;
    Comparison& comparison_;
    PanelState& state_;
    Drag drag_ = Drag::None;
    Vec2 mouse_{0}, pressed_{0};
    bool moved_ = false, any_ = false;
};

}  // namespace nacre
