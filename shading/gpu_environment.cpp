#include "shading/gpu_environment.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <half.h>

#include <cstdint>

#include "core/error.hpp"
#include "shading/context.hpp"

namespace nacre {
namespace {

constexpr float kLargestHalf = 65504;

/// Size N of level `level` where mip levels halve, rounding down.
int mipSize(int size, int level) { return std::max(1, size >> level); }

void checkLevels(std::span<const EnvMap> levels, TexelFormat format) {
    require(!levels.empty(), "GpuEnvironment: no level");
    require(format != TexelFormat::Unorm8, "GpuEnvironment: the format must be half or float");
    const int size = levels[0].size();
    const glm::ivec2 base = envExtent(levels[0].layout, size);
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const int level = static_cast<int>(i), found = levels[i].size();
        require(levels[i].layout == levels[0].layout,
                fmt::format("GpuEnvironment: level {} is {}, level 0 {}", i, toString(levels[i].layout),
                            toString(levels[0].layout)));
        const glm::ivec2 extent = envExtent(levels[i].layout, found);
        const bool cube = levels[0].layout == EnvLayout::Cube;
        const bool fits = found == mipSize(size, level) &&
                          (cube || (extent.x == mipSize(base.x, level) && extent.y == mipSize(base.y, level)));
        require(fits,
                fmt::format("GpuEnvironment: sizes of levels must halve like mip levels; level 0 has {}, level {} "
                            "has {}",
                            size, i, found));
    }
}

/// One face or one plane as the driver wants it, right to left or upside down where asked.
struct Turn {
    bool leftRight = false, upDown = false;
};

template <class Target, class Convert>
std::vector<Target> texels(const Image& image, int top, int height, const Turn& turn, Convert convert) {
    const int width = image.width();
    std::vector<Target> out;
    out.reserve(static_cast<std::size_t>(width) * height * 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) {
                const int column = turn.leftRight ? width - 1 - x : x, row = turn.upDown ? height - 1 - y : y;
                out.push_back(convert(image.at(column, top + row, c)));
            }
    return out;
}

void checkValues(const EnvMap& map, int level, const GpuEnvironmentOptions& options) {
    const float largest = options.format == TexelFormat::Half ? kLargestHalf : std::numeric_limits<float>::max();
    const Image& image = map.image;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            for (int c = 0; c < 3; ++c) {
                const double v = image.at(x, y, c) / options.scale;
                if (!(std::abs(v) <= largest))
                    throw StorageError(fmt::format(
                        "GpuEnvironment: level {}, texel ({}, {}): expected at most {} in {}, found {}; a scale "
                        "of {} would make the largest half float this radiance",
                        level, x, y, largest, toString(options.format), v, std::abs(v) / kLargestHalf * options.scale));
            }
}

void define(GLenum target, int level, const Image& image, int top, int height, const Turn& turn,
            const GpuEnvironmentOptions& options) {
    const float inverse = static_cast<float>(1 / options.scale);
    if (options.format == TexelFormat::Half) {
        const auto data =
            texels<std::uint16_t>(image, top, height, turn, [&](float v) { return Imath::half(v * inverse).bits(); });
        glTexImage2D(target, level, GL_RGB16F, image.width(), height, 0, GL_RGB, GL_HALF_FLOAT, data.data());
    } else {
        const auto data = texels<float>(image, top, height, turn, [&](float v) { return v * inverse; });
        glTexImage2D(target, level, GL_RGB32F, image.width(), height, 0, GL_RGB, GL_FLOAT, data.data());
    }
}

GLenum targetOf(EnvLayout layout) { return layout == EnvLayout::Cube ? GL_TEXTURE_CUBE_MAP : GL_TEXTURE_2D; }

/// One channel becomes three: shaders read rgb.
AssetTexture asRgb(const AssetTexture& table) {
    if (table.image.channels() != 1) return table;
    AssetTexture out = table;
    out.image = Image(table.image.width(), table.image.height(), 3);
    for (int y = 0; y < table.image.height(); ++y)
        for (int x = 0; x < table.image.width(); ++x) out.image.setRgb(x, y, table.image.rgb(x, y));
    out.scale = glm::vec4(table.scale.x);
    out.bias = glm::vec4(table.bias.x);
    return out;
}

bool checkedIsFresnel(const AssetTexture& table) {
    const int channels = table.image.channels();
    if (table.mapping == "cos_perceptual") {
        require(channels == 2,
                fmt::format("environment table {}: expected 2 channels, found {}", table.name, channels));
        return false;
    }
    require(table.mapping == "sqrt_cos",
            fmt::format("environment table {}: expected the mapping sqrt_cos or cos_perceptual, found '{}'", table.name,
                        table.mapping));
    require(channels == 1 || channels == 3,
            fmt::format("environment table {}: expected 1 or 3 channels, found {}", table.name, channels));
    return true;
}

}  // namespace

GpuEnvironment::GpuEnvironment(std::span<const EnvMap> levels, const GpuEnvironmentOptions& options)
    : scale_(options.scale) {
    checkLevels(levels, options.format);
    require(std::isfinite(scale_) && scale_ > 0, "GpuEnvironment: the scale must be finite, > 0");
    layout_ = levels[0].layout;
    size_ = levels[0].size();
    levels_ = static_cast<int>(levels.size());
    const GLenum target = targetOf(layout_);
    const bool cube = layout_ == EnvLayout::Cube;
    glBindTexture(target, texture_.name());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    for (int level = 0; level < levels_; ++level) {
        const EnvMap& map = levels[static_cast<std::size_t>(level)];
        checkValues(map, level, options);
        bytes_ += map.image.data().size() * bytesPerChannel(options.format);
        for (int face = 0; cube && face < 6; ++face)
            define(GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face), level, map.image, face * map.size(),
                   map.size(), {face / 2 != 1, face / 2 == 1}, options);
        if (!cube) define(target, level, map.image, 0, map.image.height(), {}, options);
    }
    const GLint between = cube ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR_MIPMAP_NEAREST;
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, levels_ > 1 ? between : GL_LINEAR);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(target, GL_TEXTURE_WRAP_S, layout_ == EnvLayout::LatLong ? GL_REPEAT : GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_BASE_LEVEL, 0);
    glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, levels_ - 1);
    if (cube && epoxy_is_desktop_gl()) glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    glBindTexture(target, 0);
    checkGl(fmt::format("environment map {} of size {}, {} levels", toString(layout_), size_, levels_));
}

ShaderDefines layoutDefines(EnvLayout layout) {
    static constexpr const char* kNames[] = {"NACRE_ENV_LATLONG", "NACRE_ENV_CUBE", "NACRE_ENV_DUAL_PARABOLOID",
                                             "NACRE_ENV_OCTAHEDRAL"};
    return {{"NACRE_ENV_LAYOUT", kNames[static_cast<int>(layout)]}};
}

void GpuEnvironment::bind(int unit) const {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(targetOf(layout_), texture_.name());
}

GpuEnvironmentTable::GpuEnvironmentTable(const AssetTexture& table)
    : fresnel_(checkedIsFresnel(table)), texture_(asRgb(table)), scale_(table.scale), bias_(table.bias) {
    if (table.image.channels() == 1) scale_ = glm::vec4(table.scale.x), bias_ = glm::vec4(table.bias.x);
}

void GpuEnvironmentTable::bind(const Program& program, int unit) const {
    texture_.bind(unit);
    program.set("nacre_env_table", unit);
    program.set("nacre_env_table_scale", scale_);
    program.set("nacre_env_table_bias", bias_);
}

}  // namespace nacre
