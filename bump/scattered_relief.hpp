// Inside of scatterLight: what its two ways share.
#pragma once

#include <cmath>

#include "bump/scattered_light.hpp"
#include "core/parallel.hpp"

namespace nacre {

/// Radiance, and 1 for a surface or 0 for a hole: lookups divide by it, so that holes don't darken what is beside them.
using RadianceTexture = std::vector<glm::vec4>;

/// A texture of the relief, or with detail × detail texels for each of the relief's.
struct RadianceLookup {
    const RadianceTexture& texels;
    int width, height, detail;
    Wrap wrap;

    /// \param p  in the relief's texels, not wrapped
    Rgb operator()(const Vec2& p) const {
        const double x = p.x * detail - 0.5, y = p.y * detail - 0.5, i = std::floor(x), j = std::floor(y);
        const auto s = static_cast<float>(x - i), t = static_cast<float>(y - j);
        const int i0 = wrapIndex(static_cast<int>(i), width, wrap),
                  i1 = wrapIndex(static_cast<int>(i) + 1, width, wrap);
        const std::size_t j0 = row(static_cast<int>(j)), j1 = row(static_cast<int>(j) + 1);
        const glm::vec4 v = (1 - t) * ((1 - s) * texels[j0 + i0] + s * texels[j0 + i1]) +
                            t * ((1 - s) * texels[j1 + i0] + s * texels[j1 + i1]);
        return v.a > 0 ? Rgb(v) / static_cast<double>(v.a) : Rgb(0);
    }
    std::size_t row(int j) const { return static_cast<std::size_t>(wrapIndex(j, height, wrap)) * width; }
};

/// What the steps share.
struct ScatteredRelief {
    const HeightMap& map;
    const ScatterMap& scatter;
    const ScatteredLightOptions& options;
    Image lit;
    std::vector<Vec3> normals = {};
    std::vector<Rgb> albedo = {};
    std::vector<Vec2> along = {};  ///< of each direction, unit in the plane; 0 for vertical ones

    bool hole(std::size_t i) const { return std::isnan(map.heights.data()[i]); }
    float distance(std::size_t k, std::size_t i) const { return scatter.distance[k].data()[i]; }
    Vec2 seen(int x, int y, std::size_t k, float distance) const {
        return Vec2(x + 0.5, y + 0.5) + along[k] * static_cast<double>(distance);
    }
    Rgb skyOf(std::size_t k) const { return options.sky ? options.sky(scatter.directions[k]) : Rgb(0); }
    RadianceLookup lookup(const RadianceTexture& texels) const {
        return {texels, map.width(), map.height(), 1, map.wrap};
    }
    template <typename Body>  // body(x, y, i) of all texels that are no holes
    void eachTexel(const Body& body) const {
        parallelFor(static_cast<std::size_t>(map.height()), options.threads, [&](std::size_t y) {
            for (int x = 0; x < map.width(); ++x) {
                const std::size_t i = y * static_cast<std::size_t>(map.width()) + static_cast<std::size_t>(x);
                if (!hole(i)) body(x, static_cast<int>(y), i);
            }
        });
    }
};

inline Image imageOf(const ScatteredRelief& relief, const std::vector<Rgb>& values) {
    Image out(relief.map.width(), relief.map.height(), 3);
    for (std::size_t i = 0; i < values.size(); ++i)
        for (int c = 0; c < 3; ++c) out.data()[3 * i + static_cast<std::size_t>(c)] = static_cast<float>(values[i][c]);
    return out;
}

inline RadianceTexture textureOf(const ScatteredRelief& relief, const std::vector<Rgb>& values) {
    RadianceTexture out(values.size(), glm::vec4(0));
    relief.eachTexel([&](int, int, std::size_t i) { out[i] = glm::vec4(values[i], 1); });
    return out;
}

/// Lambert's paths that meet: sets out.sky and out.indirect.
void meetPaths(const ScatteredRelief& relief, const ScatterPlan& plan, ScatteredLight& out);

}  // namespace nacre
