// Small scenes of Lambertian squares for tests of hybrid rendering.
#pragma once

#include "shading/hybrid/hybrid_renderer.hpp"

namespace nacre::test {

/// One white material of albedo 0.5, no light, a camera at (0, 0, 3).
SceneDescription emptyRoom();

/// A square of edge 2 · half in a plane through `at`, its front towards `normal`. \return  its node
std::size_t addSquare(SceneDescription& scene, double half, const Vec3& at, const Vec3& normal, int material = 0);

/// A material of this albedo. \return  its index
int addWhite(SceneDescription& scene, double albedo);

void addLight(SceneDescription& scene, const Light& light, bool shadow = true);

/// Of materials "lambert:kd=…" that addWhite made.
std::vector<Rgb> albedos(const SceneDescription& scene);
HybridMaterials materialsOf(const SceneDescription& scene);

}  // namespace nacre::test
