// Lights with an extent, as sets of points (MPR section 4.4, PR94): what soft shadows are made of.
#pragma once

#include <optional>
#include <vector>

#include "core/scene_description.hpp"

namespace nacre {

/// The scene's areas in the world, given nodeTransforms' result: one a light.
std::vector<std::optional<LightArea>> areasInWorld(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes);

/// The light in one point of its area. \param square  in [0, 1]²
Light pointOfArea(const Light& light, const LightArea& area, const Vec2& square);

/// `count` points with equal shares of the light's color, evenly over the area; their mean is its middle.
/// \throws std::invalid_argument: count < 1, a directional light
std::vector<Light> pointsOfArea(const Light& light, const LightArea& area, int count);

}  // namespace nacre
