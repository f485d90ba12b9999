#include "shading/context.hpp"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <array>
#include <utility>
#include <vector>

#include "core/error.hpp"

namespace nacre {
namespace {

constexpr GLenum kContextLost = 0x0507;  // GL_CONTEXT_LOST of OpenGL 4.5 and KHR_robustness

struct Candidate {
    std::string platform;
    EGLDisplay display;
};

std::string eglError() { return fmt::format("EGL error 0x{:04x}", static_cast<unsigned>(eglGetError())); }

/// Client extensions are asked of EGL_NO_DISPLAY.
bool hasClientExtension(const char* name) { return epoxy_has_egl_extension(EGL_NO_DISPLAY, name); }

std::vector<Candidate> candidateDisplays() {
    std::vector<Candidate> out;
    const bool platforms = hasClientExtension("EGL_EXT_platform_base");
    if (platforms && hasClientExtension("EGL_MESA_platform_surfaceless"))
        out.push_back(
            {"surfaceless", eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)});
    if (platforms && hasClientExtension("EGL_EXT_platform_device") &&
        (hasClientExtension("EGL_EXT_device_enumeration") || hasClientExtension("EGL_EXT_device_base"))) {
        std::array<EGLDeviceEXT, 16> devices{};
        EGLint count = 0;
        if (eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count))
            for (EGLint i = 0; i < count; ++i)
                out.push_back({fmt::format("device {}", i),
                               eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr)});
    }
    out.push_back({"default", eglGetDisplay(EGL_DEFAULT_DISPLAY)});
    return out;
}

/// \return EGL_NO_CONTEXT on failure, with the reason in `why`
EGLContext createOn(EGLDisplay display, GlApi api, std::string& why) {
    const auto fail = [&why](const char* call) {
        why = std::string(call) + ": " + eglError();
        return EGL_NO_CONTEXT;
    };
    EGLint major = 0, minor = 0;
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, &major, &minor)) return fail("eglInitialize");
    const bool es = api == GlApi::Es3;
    if (!eglBindAPI(es ? EGL_OPENGL_ES_API : EGL_OPENGL_API)) return fail("eglBindAPI");
    // The default surface type asks for a window, which headless displays don't have.
    const EGLint renderable = es ? EGL_OPENGL_ES3_BIT : EGL_OPENGL_BIT;
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, renderable, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint found = 0;
    if (!eglChooseConfig(display, wanted, &config, 1, &found) || found == 0) return fail("eglChooseConfig");
    const EGLint esVersion[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 0, EGL_NONE};
    const bool core45 = api == GlApi::Core45;
    const EGLint coreVersion[] = {EGL_CONTEXT_MAJOR_VERSION,
                                  core45 ? 4 : 3,
                                  EGL_CONTEXT_MINOR_VERSION,
                                  core45 ? 5 : 3,
                                  EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                  EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                  EGL_NONE};
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, es ? esVersion : coreVersion);
    if (context == EGL_NO_CONTEXT) return fail("eglCreateContext");
    if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
        fail("eglMakeCurrent");
        eglDestroyContext(display, context);
        return EGL_NO_CONTEXT;
    }
    return context;
}

/// What a display offers when asked for no version: "OpenGL 2.1 Mesa …"; empty when nothing.
std::string offeredBy(EGLDisplay display, GlApi api) {
    const bool es = api == GlApi::Es3;
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) return {};
    if (!eglBindAPI(es ? EGL_OPENGL_ES_API : EGL_OPENGL_API)) return {};
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                             es ? EGL_OPENGL_ES2_BIT : EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint found = 0;
    if (!eglChooseConfig(display, wanted, &config, 1, &found) || found == 0) return {};
    const EGLint es2[] = {EGL_CONTEXT_MAJOR_VERSION, 2, EGL_NONE};
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, es ? es2 : nullptr);
    if (context == EGL_NO_CONTEXT) return {};
    std::string out;
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
        if (const auto* text = reinterpret_cast<const char*>(glGetString(GL_VERSION)))
            out = std::string(es ? "" : "OpenGL ") + text;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
    return out;
}

const char* apiName(GlApi api) {
    switch (api) {
        case GlApi::Core33:
            return "OpenGL 3.3 core";
        case GlApi::Core45:
            return "OpenGL 4.5 core";
        case GlApi::Es3:
            return "OpenGL ES 3.0";
    }
    return "?";
}

}  // namespace

Context::Context(GlApi api) : api_(api) {
    std::string tried;
    for (const Candidate& candidate : candidateDisplays()) {
        std::string why;
        if (const EGLContext context = createOn(candidate.display, api, why); context != EGL_NO_CONTEXT) {
            display_ = candidate.display;
            context_ = context;
            platform_ = candidate.platform;
            return;
        }
        const std::string offered = offeredBy(candidate.display, api);
        tried += fmt::format("; {}: {}{}", candidate.platform, why,
                             offered.empty() ? "" : fmt::format(", found {}", offered));
    }
    throw Error(fmt::format("expected a context of {} without a window, found none{}", apiName(api), tried));
}

Context::~Context() { release(); }

Context::Context(Context&& other) noexcept
    : api_(other.api_),
      display_(std::exchange(other.display_, nullptr)),
      context_(std::exchange(other.context_, nullptr)),
      platform_(std::move(other.platform_)) {}

Context& Context::operator=(Context&& other) noexcept {
    if (this != &other) {
        release();
        api_ = other.api_;
        display_ = std::exchange(other.display_, nullptr);
        context_ = std::exchange(other.context_, nullptr);
        platform_ = std::move(other.platform_);
    }
    return *this;
}

void Context::release() noexcept {
    if (!context_) return;
    if (eglGetCurrentContext() == context_) eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
    context_ = nullptr;
}

void Context::makeCurrent() const {
    eglBindAPI(api_ == GlApi::Es3 ? EGL_OPENGL_ES_API : EGL_OPENGL_API);  // the current context is kept per API
    if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
        throw Error("eglMakeCurrent on " + platform_ + ": " + eglError());
}

std::string Context::description() const {
    const auto text = [](GLenum what) {
        const auto* s = reinterpret_cast<const char*>(glGetString(what));
        return std::string(s ? s : "unknown");
    };
    return fmt::format("{}; {}; {}; {}", platform_, text(GL_VENDOR), text(GL_RENDERER), text(GL_VERSION));
}

void checkGl(const std::string& what) {
    std::string codes;
    for (int i = 0; i < 16; ++i) {  // bounded: a lost context reports the same error for ever
        const GLenum code = glGetError();
        if (code == GL_NO_ERROR) break;
        if (code == kContextLost)
            throw Error(what +
                        ": the OpenGL context is lost (its device was reset or taken away): make a new one of "
                        "OpenGL 3.3 or OpenGL ES 3.0 and load everything again");
        codes += fmt::format(" 0x{:04x}", code);
    }
    if (!codes.empty()) throw Error(what + ": OpenGL errors" + codes);
}

}  // namespace nacre
