// An off-screen float image to render into, and its way back to a core Image.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "core/image.hpp"
#include "shading/gl_objects.hpp"

namespace nacre {

/// Rgba16F truncates toward zero on some drivers and saturates at 65504; Rgba32F keeps the shader's value.
enum class ColorFormat { Rgba16F, Rgba32F };

struct RenderTargetOptions {
    int width = 512, height = 512;  ///< [pixels], >= 1
    ColorFormat color = ColorFormat::Rgba32F;
    bool depth = true;  ///< 24 bits, and 8 of stencil
    int samples = 1;    ///< per pixel; > 1 is resolved (box filter) by read()
};

class RenderTarget {
public:
    /// Leaves the default framebuffer bound.
    /// \throws nacre::Error when the driver has fewer samples or refuses the size, or with the status when it finds the
    ///         framebuffer incomplete
    explicit RenderTarget(const RenderTargetOptions& options);

    int width() const { return options_.width; }
    int height() const { return options_.height; }
    /// Binds as framebuffer for drawing and reading and sets the viewport.
    void bind() const;
    /// bind(), then fills colour, depth with 1 and stencil with 0.
    void clear(const glm::vec4& color = glm::vec4(0)) const;
    /// Resolves samples and binds what holds one a pixel, for glReadPixels and glCopyTexSubImage2D; row 0 is the
    /// lowest.
    void bindForReading() const;
    /// The pixels, row 0 on top. Resolves samples first. Leaves this bound.
    /// \param channels  1 to 4
    Image read(int channels = 3) const;

private:
    RenderTargetOptions options_;
    FramebufferName framebuffer_;
    Renderbuffer color_;
    std::optional<Renderbuffer> depth_;
    std::optional<FramebufferName> resolve_;  ///< one sample a pixel; only with samples > 1
    std::optional<Renderbuffer> resolveColor_;
};

}  // namespace nacre
