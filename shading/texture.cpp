#include "shading/texture.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <half.h>

#include <cstdint>
#include <vector>

#include "core/error.hpp"
#include "shading/context.hpp"

namespace nacre {
namespace {

struct PixelFormat {
    GLint internal;
    GLenum format, type;
};

PixelFormat pixelFormat(TexelFormat format, int channels) {
    static constexpr GLenum kFormats[] = {GL_RED, GL_RG, GL_RGB, GL_RGBA};
    static constexpr GLint kHalf[] = {GL_R16F, GL_RG16F, GL_RGB16F, GL_RGBA16F};
    static constexpr GLint kFloat[] = {GL_R32F, GL_RG32F, GL_RGB32F, GL_RGBA32F};
    static constexpr GLint kUnorm8[] = {GL_R8, GL_RG8, GL_RGB8, GL_RGBA8};
    const auto c = static_cast<std::size_t>(channels - 1);
    switch (format) {
        case TexelFormat::Half:
            return {kHalf[c], kFormats[c], GL_HALF_FLOAT};
        case TexelFormat::Float:
            return {kFloat[c], kFormats[c], GL_FLOAT};
        case TexelFormat::Unorm8:
            return {kUnorm8[c], kFormats[c], GL_UNSIGNED_BYTE};
    }
    throw std::invalid_argument("pixelFormat: unknown texel format");
}

template <class Target, class Convert>
void define(const PixelFormat& pixels, const Image& image, Convert convert) {
    std::vector<Target> data(image.data().size());
    for (std::size_t i = 0; i < data.size(); ++i) data[i] = convert(image.data()[i]);
    glTexImage2D(GL_TEXTURE_2D, 0, pixels.internal, image.width(), image.height(), 0, pixels.format, pixels.type,
                 data.data());
}

}  // namespace

Texture::Texture(const AssetTexture& texture) { upload(texture.image, texture.format, Filter::Linear); }

Texture::Texture(const Image& image, Filter filter) { upload(image, TexelFormat::Float, filter); }

void Texture::upload(const Image& image, TexelFormat format, Filter filter) {
    require(!image.empty(), "Texture: empty image");
    width_ = image.width();
    height_ = image.height();
    glBindTexture(GL_TEXTURE_2D, name());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    const PixelFormat pixels = pixelFormat(format, image.channels());
    switch (format) {
        case TexelFormat::Half:  // the asset's values are exact in half precision, so this rounds nothing
            define<std::uint16_t>(pixels, image, [](float v) { return Imath::half(v).bits(); });
            break;
        case TexelFormat::Float:
            define<float>(pixels, image, [](float v) { return v; });
            break;
        case TexelFormat::Unorm8:  // k/255 gives k back
            define<std::uint8_t>(pixels, image, [](float v) { return static_cast<std::uint8_t>(v * 255.0f + 0.5f); });
            break;
    }
    const GLint mode = filter == Filter::Linear ? GL_LINEAR : GL_NEAREST;
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, mode);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, mode);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glBindTexture(GL_TEXTURE_2D, 0);
    checkGl(fmt::format("texture of {} x {} texels, {} channels", width_, height_, image.channels()));
}

void Texture::bind(int unit) const {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, name());
}

Image Texture::download(int channels) const {
    Image out(width_, height_, channels);
    const PixelFormat pixels = pixelFormat(TexelFormat::Float, channels);
    glBindTexture(GL_TEXTURE_2D, name());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTexImage(GL_TEXTURE_2D, 0, pixels.format, pixels.type, out.data().data());
    glBindTexture(GL_TEXTURE_2D, 0);
    checkGl("texture download");
    return out;
}

}  // namespace nacre
