#include "shading/gpu_bump.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <half.h>

#include <cmath>
#include <cstdint>

#include "bump/bump_levels.hpp"
#include "core/error.hpp"
#include "shading/context.hpp"

namespace nacre {
namespace {

constexpr float kLargestHalf = 65504;

GLint wrapMode(Wrap wrap) {
    return wrap == Wrap::Repeat ? GL_REPEAT : wrap == Wrap::Clamp ? GL_CLAMP_TO_EDGE : GL_MIRRORED_REPEAT;
}

enum class Blend { Linear, Nearest };

/// Uploads levels to textures and counts their bytes.
class Uploader {
public:
    Uploader(TexelFormat format, Wrap wrap, std::size_t& bytes)
        : half_(format == TexelFormat::Half), wrap_(wrap), bytes_(bytes) {}

    TextureName flat(const std::vector<Image>& levels, Blend blend, const char* what) const {
        TextureName out;
        glBindTexture(GL_TEXTURE_2D, out.name());
        for (std::size_t i = 0; i < levels.size(); ++i) define(levels[i], static_cast<int>(i), what);
        finish(GL_TEXTURE_2D, levels.size(), blend, what);
        return out;
    }

    /// \param levels  of each, the layers: RGBA
    TextureName layered(const std::vector<std::vector<Image>>& levels, Blend blend, const char* what) const {
        TextureName out;
        glBindTexture(GL_TEXTURE_2D_ARRAY, out.name());
        for (std::size_t i = 0; i < levels.size(); ++i) {
            const auto level = static_cast<GLint>(i), count = static_cast<GLint>(levels[i].size());
            glTexImage3D(GL_TEXTURE_2D_ARRAY, level, half_ ? GL_RGBA16F : GL_RGBA32F, levels[i][0].width(),
                         levels[i][0].height(), count, 0, GL_RGBA, half_ ? GL_HALF_FLOAT : GL_FLOAT, nullptr);
            for (GLint layer = 0; layer < count; ++layer)
                defineLayer(levels[i][static_cast<std::size_t>(layer)], level, layer, what);
        }
        finish(GL_TEXTURE_2D_ARRAY, levels.size(), blend, what);
        return out;
    }

private:
    std::vector<std::uint16_t> halves(const Image& image, const char* what) const {
        std::vector<std::uint16_t> out;
        out.reserve(image.data().size());
        for (const float v : image.data()) {
            if (!(std::abs(v) <= kLargestHalf))
                throw StorageError(
                    fmt::format("GpuBump: {}: expected at most {} in half, found {}", what, kLargestHalf, v));
            out.push_back(Imath::half(v).bits());
        }
        return out;
    }

    void define(const Image& image, int level, const char* what) const {
        const bool alpha = image.channels() == 4;
        const GLenum format = alpha ? GL_RGBA : GL_RGB;
        bytes_ += image.data().size() * (half_ ? 2 : 4);
        if (half_)
            glTexImage2D(GL_TEXTURE_2D, level, alpha ? GL_RGBA16F : GL_RGB16F, image.width(), image.height(), 0, format,
                         GL_HALF_FLOAT, halves(image, what).data());
        else
            glTexImage2D(GL_TEXTURE_2D, level, alpha ? GL_RGBA32F : GL_RGB32F, image.width(), image.height(), 0, format,
                         GL_FLOAT, image.data().data());
    }

    void defineLayer(const Image& image, int level, int layer, const char* what) const {
        bytes_ += image.data().size() * (half_ ? 2 : 4);
        if (half_)
            glTexSubImage3D(GL_TEXTURE_2D_ARRAY, level, 0, 0, layer, image.width(), image.height(), 1, GL_RGBA,
                            GL_HALF_FLOAT, halves(image, what).data());
        else
            glTexSubImage3D(GL_TEXTURE_2D_ARRAY, level, 0, 0, layer, image.width(), image.height(), 1, GL_RGBA,
                            GL_FLOAT, image.data().data());
    }

    void finish(GLenum target, std::size_t levels, Blend blend, const char* what) const {
        glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, static_cast<GLint>(levels) - 1);
        glTexParameteri(target, GL_TEXTURE_MIN_FILTER,
                        blend == Blend::Linear ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR_MIPMAP_NEAREST);
        glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        glTexParameteri(target, GL_TEXTURE_WRAP_S, wrapMode(wrap_));
        glTexParameteri(target, GL_TEXTURE_WRAP_T, wrapMode(wrap_));
        glBindTexture(target, 0);
        checkGl(fmt::format("texture of a relief's {}", what));
    }

    bool half_;
    Wrap wrap_;
    std::size_t& bytes_;
};

/// Four azimuths a layer, the last filled up with 0; then the spread.
std::vector<Image> layersOf(const HorizonLevel& level) {
    std::vector<Image> out;
    const int width = level.spread.width(), height = level.spread.height();
    const auto copy = [](const Image& from, Image& to, int channel) {
        for (int y = 0; y < to.height(); ++y)
            for (int x = 0; x < to.width(); ++x) to.at(x, y, channel) = from.at(x, y, 0);
    };
    for (std::size_t k = 0; k < level.elevation.size(); ++k) {
        if (k % 4 == 0) out.emplace_back(width, height, 4);
        copy(level.elevation[k], out.back(), static_cast<int>(k % 4));
    }
    out.emplace_back(width, height, 4);
    copy(level.spread, out.back(), 0);
    return out;
}

bool isEllipse(BumpShadow shadow) { return shadow == BumpShadow::HardEllipse || shadow == BumpShadow::Ellipse; }
bool isHorizon(BumpShadow shadow) { return shadow == BumpShadow::HardHorizon || shadow == BumpShadow::Horizon; }

void bindTexture(const Program& program, const char* sampler, GLenum target, GlName name, int unit) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(target, name);
    program.set(sampler, unit);
}

void check(const BumpSurface& s) {
    require(s.map->has(s.shadow), fmt::format("bump: the shadow needs {}, and the maps have none",
                                              isEllipse(s.shadow) ? "ellipses" : "horizons"));
    require(!s.roughness || s.map->hasRoughness(), "bump: roughness needs normals with a fourth channel");
    require(std::isfinite(s.tiles.x) && std::isfinite(s.tiles.y) && s.tiles.x > 0 && s.tiles.y > 0,
            fmt::format("bump: expected tiles finite, > 0, found {} and {}", s.tiles.x, s.tiles.y));
    require(s.indirect == 0 || s.indirectLight >= 0,
            fmt::format("bump: expected the index of a light, found {}", s.indirectLight));
}

}  // namespace

GpuBump::GpuBump(const BumpMaps& maps, const GpuBumpOptions& options)
    : width_(maps.width), height_(maps.height), wrap_(maps.wrap) {
    require(maps.normals.has_value() && !maps.normals->levels.empty(), "GpuBump: expected normals, found none");
    require(options.format != TexelFormat::Unorm8, "GpuBump: the format must be half or float");
    const Blend shadows = options.blendLevels ? Blend::Linear : Blend::Nearest;
    const Uploader upload(options.format, wrap_, bytes_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    normals_ = upload.flat(maps.normals->levels, Blend::Linear, "normals");
    roughness_ = maps.normals->levels[0].channels() == 4;
    if (maps.ellipses) {
        std::vector<Image> shapes, offsets;
        for (EllipseLevel& level : ellipseLevels(*maps.ellipses, options.threads)) {
            shapes.push_back(std::move(level.shape));
            offsets.push_back(std::move(level.offset));
        }
        shape_ = upload.flat(shapes, shadows, "ellipses");
        offset_ = upload.flat(offsets, shadows, "ellipses");
    }
    if (maps.horizons) {
        azimuths_ = maps.horizons->azimuths();
        std::vector<std::vector<Image>> levels;
        for (const HorizonLevel& level : horizonLevels(*maps.horizons, options.threads))
            levels.push_back(layersOf(level));
        horizons_ = upload.layered(levels, shadows, "horizons");
    }
}

bool GpuBump::has(BumpShadow shadow) const {
    return isEllipse(shadow) ? shape_.has_value() : isHorizon(shadow) ? horizons_.has_value() : true;
}

ShaderDefines bumpDefines(BumpShadow shadow, Wrap wrap, bool roughness, int indirectLight) {
    ShaderDefines out{{"NACRE_BUMP", "1"}};
    if (isEllipse(shadow)) out.emplace_back("NACRE_BUMP_SHADOW", "NACRE_BUMP_ELLIPSE");
    if (isHorizon(shadow)) out.emplace_back("NACRE_BUMP_SHADOW", "NACRE_BUMP_HORIZON");
    if (shadow == BumpShadow::Ellipse || shadow == BumpShadow::Horizon) out.emplace_back("NACRE_BUMP_SOFT", "1");
    if (wrap == Wrap::Mirror) out.emplace_back("NACRE_BUMP_MIRROR", "1");
    if (roughness) out.emplace_back("NACRE_BUMP_ROUGHNESS", "1");
    if (indirectLight >= 0) out.emplace_back("NACRE_BUMP_INDIRECT", std::to_string(indirectLight));
    return out;
}

ShaderDefines bumpDefines(const BumpSurface& surface) {
    if (surface.map == nullptr) return {};
    check(surface);
    return bumpDefines(surface.shadow, surface.map->wrap(), surface.roughness,
                       surface.indirect != 0 ? surface.indirectLight : -1);
}

void bindBump(const Program& program, const BumpSurface& surface, int firstUnit) {
    if (surface.map == nullptr) return;
    const GpuBump& map = *surface.map;
    program.set("nacre_bump_tiles", glm::vec2(surface.tiles));
    bindTexture(program, "nacre_bump_normals", GL_TEXTURE_2D, map.normals_.name(), firstUnit);
    if (isEllipse(surface.shadow)) {
        bindTexture(program, "nacre_bump_shape", GL_TEXTURE_2D, map.shape_->name(), firstUnit + 1);
        bindTexture(program, "nacre_bump_offset", GL_TEXTURE_2D, map.offset_->name(), firstUnit + 2);
    }
    if (isHorizon(surface.shadow)) {
        bindTexture(program, "nacre_bump_horizons", GL_TEXTURE_2D_ARRAY, map.horizons_->name(), firstUnit + 3);
        program.set("nacre_bump_azimuths", map.azimuths_);
    }
    if (surface.indirect != 0)
        bindTexture(program, "nacre_bump_indirect", GL_TEXTURE_2D, surface.indirect, firstUnit + 4);
}

}  // namespace nacre
