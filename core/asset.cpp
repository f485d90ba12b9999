#include "core/asset.hpp"

#include <fmt/format.h>
#include <half.h>

#include <array>
#include <limits>

#include "core/error.hpp"

namespace nacre {

static constexpr float kHalfMax = 65504.0f;  ///< largest finite half

std::string toString(TexelFormat format) {
    switch (format) {
        case TexelFormat::Half:
            return "half";
        case TexelFormat::Float:
            return "float";
        case TexelFormat::Unorm8:
            return "unorm8";
    }
    throw std::invalid_argument("TexelFormat: not a format");
}

TexelFormat texelFormatFromString(const std::string& name) {
    for (const TexelFormat format : {TexelFormat::Half, TexelFormat::Float, TexelFormat::Unorm8})
        if (name == toString(format)) return format;
    throw std::invalid_argument(fmt::format("unknown texel format '{}': expected half, float or unorm8", name));
}

std::size_t bytesPerChannel(TexelFormat format) {
    switch (format) {
        case TexelFormat::Half:
            return 2;
        case TexelFormat::Float:
            return 4;
        case TexelFormat::Unorm8:
            return 1;
    }
    throw std::invalid_argument("TexelFormat: not a format");
}

/// Names the first texel whose value `format` can't hold.
static void requireStorable(const std::string& name, const Image& values, TexelFormat format) {
    for (std::size_t i = 0; i < values.data().size(); ++i) {
        const float v = values.data()[i];
        if (std::isfinite(v) && (format != TexelFormat::Half || std::abs(v) <= kHalfMax)) continue;
        const std::size_t texel = i / static_cast<std::size_t>(values.channels());
        const std::size_t width = static_cast<std::size_t>(values.width());
        throw StorageError(
            fmt::format("texture {}: texel ({}, {}) channel {}: expected a finite value{}, found {}", name,
                        texel % width, texel / width, i % static_cast<std::size_t>(values.channels()),
                        format == TexelFormat::Half ? " of at most 65504 in magnitude for half storage" : "", v));
    }
}

/// The codes' range is each channel's own range; a constant channel gets scale 0 and codes 0.
static void quantiseUnorm8(AssetTexture& texture) {
    const int channels = texture.image.channels();
    for (int c = 0; c < channels; ++c) {
        float low = std::numeric_limits<float>::infinity(), high = -low;
        for (std::size_t i = static_cast<std::size_t>(c); i < texture.image.data().size();
             i += static_cast<std::size_t>(channels)) {
            low = std::min(low, texture.image.data()[i]);
            high = std::max(high, texture.image.data()[i]);
        }
        const double range = static_cast<double>(high) - low;
        if (range > std::numeric_limits<float>::max())
            throw StorageError(
                fmt::format("texture {}: channel {}: range [{}, {}] too wide for unorm8", texture.name, c, low, high));
        texture.bias[c] = low;
        texture.scale[c] = static_cast<float>(range);
        for (std::size_t i = static_cast<std::size_t>(c); i < texture.image.data().size();
             i += static_cast<std::size_t>(channels)) {
            float& v = texture.image.data()[i];
            v = range > 0 ? static_cast<float>(std::nearbyint((static_cast<double>(v) - low) / range * 255)) / 255.0f
                          : 0.0f;
        }
    }
}

AssetTexture makeTexture(std::string name, std::string mapping, const Image& values, TexelFormat format) {
    require(!values.empty(), "makeTexture: empty image");
    requireStorable(name, values, format);
    AssetTexture out{std::move(name), std::move(mapping), format, values, glm::vec4(1.0f), glm::vec4(0.0f)};
    if (format == TexelFormat::Half)
        for (float& v : out.image.data()) v = static_cast<float>(half(v));  // Imath rounds to nearest even
    if (format == TexelFormat::Unorm8) quantiseUnorm8(out);
    return out;
}

std::size_t Asset::bytes() const {
    std::size_t sum = 0;
    for (const AssetTexture& texture : textures) sum += texture.bytes();
    return sum;
}

const AssetTexture& Asset::texture(const std::string& name) const {
    std::string found;
    for (const AssetTexture& candidate : textures) {
        if (candidate.name == name) return candidate;
        found += (found.empty() ? "" : ", ") + candidate.name;
    }
    throw Error(fmt::format("asset of kind '{}': expected a texture '{}', found {}", kind, name,
                            found.empty() ? "none" : found));
}

}  // namespace nacre
