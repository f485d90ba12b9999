// Small baked assets in a folder, and a scene that uses every one of them.
#pragma once

#include "core/scene_description.hpp"
#include "tests/core/scratch.hpp"

namespace nacre::test {

/// Files of a glossy BRDF, a surrounding (mirror chain and diffuse map), a Fresnel table and a relief with everything.
/// Baked once a process.
const tests::Scratch& bakedAssets();

/// A matt floor with the relief under a spot and a directional light, a glossy ball in the surrounding, and two
/// instances of one torus, one of them mirrored and turning. Nodes: floor, ball, torus, mirrored torus.
SceneDescription fullScene();

enum FullSceneAsset { kGlossy, kSky, kDiffuse, kFresnel, kWall };

}  // namespace nacre::test
