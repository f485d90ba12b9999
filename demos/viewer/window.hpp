// One window with an OpenGL context, and the two ways in which there is none.
#pragma once

#define GLFW_INCLUDE_NONE  // epoxy declares OpenGL
#include <GLFW/glfw3.h>

#include <string>

namespace nacre {

class Window {
public:
    /// Its context is current, at least OpenGL 3.3 core. Hidden until the first show().
    /// \param width, height  [screen units], ≥ 1
    /// \throws nacre::Error without a display; without OpenGL 3.3, with the version found
    Window(const std::string& title, int width, int height, bool wait);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    GLFWwindow* handle() const { return window_; }
    /// Whether the driver has lost the context: everything in it is gone.
    bool lost() const;

private:
    GLFWwindow* window_ = nullptr;
};

}  // namespace nacre
