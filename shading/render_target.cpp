#include "shading/render_target.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/error.hpp"
#include "shading/context.hpp"

namespace nacre {
namespace {

void attach(GlName renderbuffer, GLenum attachment, GLenum format, const RenderTargetOptions& options, int samples) {
    glBindRenderbuffer(GL_RENDERBUFFER, renderbuffer);
    if (samples > 1)
        glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, options.width, options.height);
    else
        glRenderbufferStorage(GL_RENDERBUFFER, format, options.width, options.height);
    glBindRenderbuffer(GL_RENDERBUFFER, 0);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, renderbuffer);
}

void checkComplete(const RenderTargetOptions& options) {
    const std::string what =
        fmt::format("render target of {} x {}, {} samples", options.width, options.height, options.samples);
    checkGl(what);
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        throw Error(fmt::format("{}: expected a complete framebuffer, found status 0x{:04x}", what, status));
}

}  // namespace

RenderTarget::RenderTarget(const RenderTargetOptions& options) : options_(options) {
    require(options.width >= 1 && options.height >= 1 && options.samples >= 1,
            "RenderTarget: width, height and samples must be >= 1");
    GLint most = 1;
    glGetIntegerv(GL_MAX_SAMPLES, &most);
    if (options.samples > std::max(most, 1))
        throw Error(
            fmt::format("render target: expected at most the driver's {} samples, found {}", most, options.samples));
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most);
    if (options.width > most || options.height > most)
        throw Error(
            fmt::format("render target: expected edges of at most {} pixels, which the driver can hold, found "
                        "{} x {}",
                        most, options.width, options.height));
    const GLenum format = options.color == ColorFormat::Rgba16F ? GL_RGBA16F : GL_RGBA32F;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    attach(color_.name(), GL_COLOR_ATTACHMENT0, format, options, options.samples);
    if (options.depth) {
        depth_.emplace();
        attach(depth_->name(), GL_DEPTH_STENCIL_ATTACHMENT, GL_DEPTH24_STENCIL8, options, options.samples);
    }
    checkComplete(options);
    if (options.samples > 1) {
        resolve_.emplace();
        resolveColor_.emplace();
        glBindFramebuffer(GL_FRAMEBUFFER, resolve_->name());
        attach(resolveColor_->name(), GL_COLOR_ATTACHMENT0, format, options, 1);
        checkComplete(options);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void RenderTarget::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, options_.width, options_.height);
}

void RenderTarget::clear(const glm::vec4& color) const {
    bind();
    glClearColor(color.r, color.g, color.b, color.a);
    glDepthMask(GL_TRUE);  // a masked buffer would not be cleared
    glStencilMask(~0u);
    glClearStencil(0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
}

void RenderTarget::bindForReading() const {
    if (resolve_) {
        glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.name());
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolve_->name());
        glBlitFramebuffer(0, 0, width(), height(), 0, 0, width(), height(), GL_COLOR_BUFFER_BIT, GL_NEAREST);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, resolve_ ? resolve_->name() : framebuffer_.name());
}

Image RenderTarget::read(int channels) const {
    bindForReading();
    std::vector<float> pixels(static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()) * 4);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width(), height(), GL_RGBA, GL_FLOAT, pixels.data());
    bind();
    checkGl("reading a render target");
    Image out(width(), height(), channels);
    for (int y = 0; y < height(); ++y)  // OpenGL's first row is the lowest
        for (int x = 0; x < width(); ++x)
            for (int c = 0; c < channels; ++c)
                out.at(x, height() - 1 - y, c) =
                    pixels[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width()) + x) * 4 + c];
    return out;
}

}  // namespace nacre
