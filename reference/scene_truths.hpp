// What a scene's baked assets approximate, as functions: the other half of reference/scene_trace.hpp.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bump/height_map.hpp"
#include "core/progress.hpp"
#include "core/scene_description.hpp"
#include "envmaps/lobes.hpp"
#include "factorize/reflectance.hpp"
#include "reference/bright_texels.hpp"
#include "reference/environment_shading.hpp"
#include "reference/relief_rays.hpp"

namespace nacre {

/// A height field, and the same unrolled for rays.
struct ReliefTruth {
    explicit ReliefTruth(HeightMap heights) : map(std::move(heights)), rays(map) {}
    HeightMap map;
    Relief rays;
};

/// Of one material. Directions are of the surrounding before SceneSky::rotationY turns it. All callables are safe to
/// call from several threads; empty ones contribute nothing.
struct MaterialTruth {
    BrdfFunction brdf{};       ///< unfactored
    BrdfFunction bakedBrdf{};  ///< what the asset holds: its own share of the error; empty for models
    std::shared_ptr<const ReliefTruth> relief{};
    SurroundedSurface surrounding{};  ///< integrals over the unbaked environment, exact weights
    /// Radiance of the environment that `surrounding.diffuse` integrates, without its factor: what is subtracted where
    /// it is blocked. Averaged over about 3°.
    std::shared_ptr<const BrightTexels> diffuseSource{};
    Rgb diffuseColor{1};
    /// The same of `surrounding.reflection`, factor included, with the lobe that it is blocked in.
    RadianceByDirection reflectionSource{};
    Lobe reflectionLobe{};
};

struct SceneTruths {
    std::vector<MaterialTruth> materials;  ///< one a material of the scene
    RadianceByDirection sky{};             ///< the background; before it is turned. Empty: the scene's colour
    std::vector<std::string> notes;        ///< one line each: where something else stands in for the truth, and why
};

/// Opens what SceneAsset::source, or else the asset itself, names: a reflectance (reference/factored_metrics.hpp's
/// truthOf), an environment, read as the asset says, with the lobe that it says of the level; a relief's heights, its
/// own or the source's. Where there is no source the baked asset stands in, and a note says so. Fresnel by the exact
/// formula, tables of scale and bias by integrateScaleBias at 1024 angles.
/// \throws nacre::Error naming file and problem
SceneTruths openTruths(const SceneDescription& scene, unsigned threads = 0, const Progress& progress = {});

}  // namespace nacre
