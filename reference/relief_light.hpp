// Light on a relief by tracing paths over its surface: the truth of direct and indirect light in bump maps.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "bump/height_map.hpp"

namespace nacre {

/// Unit normal of texel (x, y) by the mean slope of the patches that meet there, four of them central differences: what
/// a normal map stores. Patches with a hole don't count; of none, +z.
Vec3 texelNormal(const HeightMap& map, int x, int y);

/// Linear RGB at a point of the plane [texels], bilinear between texel centres, beyond the borders as the relief. An
/// image of the map's size; keeps a copy.
std::function<Rgb(const Vec2& p)> bilinearAlbedo(const Image& image, Wrap wrap);

/// The callables are called from several threads and must not throw.
struct ReliefLightOptions {
    Vec3 light{0, 0, 1};                                 ///< unit, towards the light
    Rgb irradiance{1};                                   ///< of a surface that faces it [W/m²]
    std::function<Rgb(const Vec3& direction)> sky = {};  ///< radiance that comes from there; none: black
    std::function<Rgb(const Vec2& p)> albedo = [](const Vec2&) { return Rgb(0.7); };  ///< at a point [texels]
    std::function<Vec3(int x, int y)> normal = {};  ///< unit, at the texels asked for; none: texelNormal
    int bounces = 3;                                ///< B ≥ 0: light is reflected up to B times before the texel
    int paths = 1000;                               ///< for each texel, ≥ 1
    std::uint64_t seed = 1;
    unsigned threads = 0;  ///< same bits for any
};

/// Radiance that leaves a texel (Lambert: towards every viewer), in parts that add up.
struct TexelLight {
    Rgb direct{0};         ///< of the light, unshadowed part; exact
    Rgb sky{0};            ///< of the sky, straight from there
    Rgb indirect{0};       ///< of light and sky, reflected 1 … B times before
    Rgb standardError{0};  ///< of sky + indirect: the estimate's own noise (standard deviation of the mean)

    Rgb total() const { return direct + sky + indirect; }
};

/// Monte Carlo over the bilinear surface (relief_rays.hpp) with its own normals; only at the texels' centres, where
/// four patches meet, the normal is an argument. Rays are drawn with the cosine about the normal, so some go down;
/// those that start below a patch see it at distance 0. Holes give 0. Unbiased for the light reflected up to B times.
/// \return one for each of `texels`, which must be inside the map
/// \throws std::invalid_argument for a bad map, option or texel
std::vector<TexelLight> traceReliefLight(const HeightMap& map, std::span<const glm::ivec2> texels,
                                         const ReliefLightOptions& options);

}  // namespace nacre
