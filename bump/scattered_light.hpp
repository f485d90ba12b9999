// Indirect light in bump maps (HSE section 3.2): light is passed on over the whole relief at once through a scatter
// map, one bump-mapping step after the other. shading/gpu_relief_light.hpp does the same on the GPU.
#pragma once

#include <functional>

#include "bump/scatter_plan.hpp"

namespace nacre {

/// The callables are called from several threads and must not throw.
struct ScatteredLightOptions {
    Vec3 light{0, 0, 1};                                 ///< unit, towards the light
    Rgb irradiance{1};                                   ///< of a surface that faces it [W/m²]
    std::function<Rgb(const Vec3& direction)> sky = {};  ///< radiance that comes from there; none: black
    Rgb albedo{0.7};
    Image albedoMap = {};  ///< RGB factor of `albedo`, of the relief's size; empty: 1
    Image normals = {};    ///< of the relief's size, unit; empty: those of surfaceSlopes
    /// f(wi, wo)/albedo [1/sr] in the frame of the texel's normal, x along the relief's x; none: Lambert's 1/π.
    std::function<Rgb(const Vec3& wi, const Vec3& wo)> brdf = {};
    Vec3 viewer{0, 0, 1};  ///< unit, towards the viewer; Lambert's light is the same for all
    int bounces = 3;       ///< B ≥ 0: light is reflected up to B times before the texel
    int paths = 100;       ///< P ≥ 1; more or less than the scatter map's directions
    /// Lambert only. true: what a texel passes on is the mean of all that has come to it, as its radiance is the same
    /// in all directions (planScatter); false: each path is alone, as in equation 10 and for any other BRDF
    /// (scatterPaths). Both are P·B steps.
    bool pathsMeet = true;
    int detail =
        3;  ///< k odd, ≥ 1, where paths meet: light that is passed on has (k + 1)² samples a patch (PatchSamples)
    unsigned threads = 0;  ///< same bits for any
};

/// Radiance [W/(sr m²)] that leaves the texels, in RGB images that add up; holes are 0.
struct ScatteredLight {
    Image direct;    ///< of the light; exact at the texels' centres
    Image sky;       ///< straight from the sky: by all of the map's directions or, paths alone, those of segment 0
    Image indirect;  ///< of both, reflected 1 … B times before

    Image total() const;
};

/// L_b(x) = L_d(x) + Σ w f ⟨n, d⟩ L_{b+1}(S_d(x)) (HSE equation 10, figure 11), the deepest texture first; seen points
/// are read with the bilinear filter, continued as the relief.
///
/// Where Lambert's paths meet, points seen are drawn for each texel out of all directions that hit (SeenPoints), and
/// what misses is summed over all of the map's directions: so no light is made or lost. What leaves a patch towards
/// other texels leaves about the patch's own normal, as the surface does; the texels' smoother normals are for the
/// viewer alone. What a ray below the own patch sees is that patch at the texel's centre. Otherwise Lambert's weights
/// sum to 1 over the paths, any BRDF's are the map's.
///
/// Beyond the borders: repeated, all repeats. Clamped, the relief goes on at its border's height, and what is seen
/// there has the light of the border, about the normal with which it goes on; only shadows there are those at the
/// border. Mirrored, the tiles are turned over and the light is not: where paths meet, each of the four has its own
/// light; paths that are alone read the relief's, a bias. \throws std::invalid_argument for a bad map, option, or a
/// scatter map of another size Cost: texels × (P·B + M), mirrored up to twice that; the plan 5 M a texel, direct light
/// rays for k² times the texels.
ScatteredLight scatterLight(const HeightMap& map, const ScatterMap& scatter, const ScatteredLightOptions& options = {});

}  // namespace nacre
