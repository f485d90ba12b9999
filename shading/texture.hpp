// Two-dimensional textures for lookups: linear filter, clamp to edge, no mip levels.
#pragma once

#include "core/asset.hpp"
#include "core/image.hpp"
#include "shading/gl_objects.hpp"

namespace nacre {

/// Filter of a texture that a lookup reads (Linear) or of one addressed by texelFetch alone (Nearest).
enum class Filter { Linear, Nearest };

/// Texel (0, 0) of the image is the texel at u = v = 0, as in sampleBilinear.
class Texture {
public:
    /// The texture's own format: Half as R/RG/RGB/RGBA16F from half data, Float as …32F, Unorm8 as …8.
    /// Binds GL_TEXTURE_2D of the active unit to 0 and sets the unpack alignment to 1.
    /// \throws nacre::Error when the driver refuses, std::invalid_argument on an empty image
    explicit Texture(const AssetTexture& texture);
    /// 32-bit floats.
    explicit Texture(const Image& image, Filter filter = Filter::Nearest);

    GlName name() const { return texture_.name(); }
    int width() const { return width_; }
    int height() const { return height_; }
    /// Binds to texture unit `unit` and leaves that unit active.
    void bind(int unit) const;
    /// What the driver stores, as floats: for tests and for reading render targets. Desktop OpenGL only.
    Image download(int channels) const;

private:
    void upload(const Image& image, TexelFormat format, Filter filter);
    TextureName texture_;
    int width_ = 0, height_ = 0;
};

}  // namespace nacre
