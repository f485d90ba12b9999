// An OpenGL context without a window (EGL): what renders the gallery, the bench and the tests.
#pragma once

#include <string>

namespace nacre {

/// What is asked for. Core33 is a lower bound: drivers give the newest compatible version.
enum class GlApi { Core33, Core45, Es3 };

/// Move-only owner of one EGL context without a surface. The displays tried, in order: surfaceless, each device, the
/// default one. The display is shared by the process and never terminated, since eglTerminate is not counted and would
/// break every other context on it.
class Context {
public:
    /// The new context is current on the calling thread.
    /// \throws nacre::Error that lists what was tried and each EGL error
    explicit Context(GlApi api = GlApi::Core33);
    ~Context();
    Context(Context&& other) noexcept;
    Context& operator=(Context&& other) noexcept;
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// \throws nacre::Error with the EGL error
    void makeCurrent() const;
    GlApi api() const { return api_; }
    /// "platform; vendor; renderer; version", as the driver names them. The context must be current.
    std::string description() const;

private:
    void release() noexcept;
    GlApi api_;
    void* display_ = nullptr;  ///< EGLDisplay, not owned
    void* context_ = nullptr;  ///< EGLContext
    std::string platform_;
};

/// \throws nacre::Error naming `what` and the codes when the current context has recorded errors; clears them
void checkGl(const std::string& what);

}  // namespace nacre
