// The scenes that shadows are measured on.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/scene.hpp"

namespace nacre::bench {

/// A mesh on a floor before a wall, both thick: closed bodies alone.
struct ShadowBenchScene {
    std::string name;
    Mesh mesh;
    Camera camera;
};

struct ShadowLight {
    std::string name;
    Light light;
    bool dualParaboloid = false;
    int cascades = 1;
};

struct ShadowSceneList {
    std::vector<ShadowBenchScene> scenes;
    std::vector<std::string> notes;  ///< what was missing
};

/// Closed box, steps × steps squares a side.
Mesh boxMesh(const Vec3& low, const Vec3& high, int steps);

/// A torus, a ball and a fence of thin bars: what no file is needed for.
ShadowBenchScene syntheticShadowScene();

/// The synthetic one, then armadillo, bunny, dragon, elephant and camel (demos/fetch.sh) from the first folder that has
/// each: $NACRE_MESHES, then build/data/meshes.
ShadowSceneList shadowScenes();
ShadowSceneList shadowScenes(const std::vector<std::filesystem::path>& folders);

/// Spot, sun, bulb (cube, dual paraboloid), sun in cascades, and one that grazes the floor.
std::vector<ShadowLight> shadowLights();

}  // namespace nacre::bench
