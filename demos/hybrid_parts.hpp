// What exhibits of hybrid rendering share.
#pragma once

#include "reference/scene_truths.hpp"
#include "shading/hybrid/hybrid_renderer.hpp"

namespace nacre {

/// A scene's unbaked BRDFs, and their albedos for light at 45 degrees. hybrid_exhibits.cpp
HybridMaterials materialsOf(const SceneTruths& truths);

}  // namespace nacre
