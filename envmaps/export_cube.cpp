#include "envmaps/export_cube.hpp"

#include <fmt/format.h>
#include <half.h>

#include "core/error.hpp"
#include "core/texture.hpp"
#include "envmaps/cube_layouts.hpp"

namespace nacre::exporting {

void requireChain(std::span<const EnvMap> levels, double scale) {
    require(!levels.empty() && std::isfinite(scale) && scale > 0, "export: no levels, or scale not finite, > 0");
    for (std::size_t i = 0; i < levels.size(); ++i) {
        require(levels[i].layout == EnvLayout::Cube && !levels[i].image.empty(), "export: expected cubes");
        const int expected = levels[0].size() >> i;
        require(levels[i].size() == expected,
                fmt::format("export: level {}: expected faces of {} texels, found {}", i, expected, levels[i].size()));
    }
}

void appendFace(const EnvMap& level, int face, double scale, std::string& bytes) {
    static constexpr double kHalfMax = 65504;
    const Image image = glFace(level, face);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const Rgb v = image.rgb(x, y) / scale;
            if (!isFinite(v) || maxComponent(glm::abs(v)) > kHalfMax)
                throw StorageError(
                    fmt::format("export: face {} of {} texels, texel ({}, {}): expected at most 65504 in magnitude for "
                                "half floats, found {:g} {:g} {:g} at scale {:g}",
                                face, level.size(), x, y, v.r, v.g, v.b, scale));
            for (int c = 0; c < 3; ++c) appendNumber(bytes, half(static_cast<float>(v[c])).bits());
            appendNumber(bytes, half(1.0f).bits());
        }
}

}  // namespace nacre::exporting
