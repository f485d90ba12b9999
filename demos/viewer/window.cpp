#include "demos/viewer/window.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <cstdlib>

#include "core/error.hpp"

namespace nacre {
namespace {

std::string glfwMessage() {
    const char* text = nullptr;
    return glfwGetError(&text) == GLFW_NO_ERROR || text == nullptr ? "no reason given" : text;
}

void hints(int major, int minor, int api) {
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    glfwWindowHint(GLFW_CONTEXT_CREATION_API, api);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, major);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, minor);
    if (major * 10 + minor >= 32) glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);  // scenes are drawn off screen
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
}

/// What the driver gives when nothing is asked for.
std::string anyVersion() {
    for (const int api : {GLFW_EGL_CONTEXT_API, GLFW_NATIVE_CONTEXT_API}) {
        hints(1, 0, api);
        GLFWwindow* window = glfwCreateWindow(16, 16, "nacre", nullptr, nullptr);
        if (window == nullptr) continue;
        glfwMakeContextCurrent(window);
        const auto* text = reinterpret_cast<const char*>(glGetString(GL_VERSION));
        std::string found = fmt::format("OpenGL {}", text ? text : "of no version");
        glfwDestroyWindow(window);
        return found;
    }
    return "no OpenGL at all";
}

}  // namespace

Window::Window(const std::string& title, int width, int height, bool wait) {
    if (glfwInit() == GLFW_FALSE) {
        const char* display = std::getenv("DISPLAY");
        throw Error(fmt::format("view: expected a display to open a window on, found none ({}; DISPLAY is {})",
                                glfwMessage(), display ? fmt::format("'{}'", display) : "not set"));
    }
    std::string why;
    // EGL as everywhere in nacre; GLX, WGL where a driver has no EGL for windows.
    for (const int api : {GLFW_EGL_CONTEXT_API, GLFW_NATIVE_CONTEXT_API}) {
        hints(3, 3, api);
        window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
        if (window_ != nullptr) break;
        why += (why.empty() ? "" : "; ") + glfwMessage();
    }
    if (window_ == nullptr) {
        const std::string found = anyVersion();
        glfwTerminate();
        throw Error(fmt::format("view: expected OpenGL 3.3 core, found {} ({})", found, why));
    }
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(wait ? 1 : 0);
}

Window::~Window() {
    if (window_ != nullptr) glfwDestroyWindow(window_);
    glfwTerminate();
}

bool Window::lost() const {
    const bool known = epoxy_gl_version() >= 45 || epoxy_has_gl_extension("GL_KHR_robustness");
    return known && glGetGraphicsResetStatus() != GL_NO_ERROR;
}

}  // namespace nacre
