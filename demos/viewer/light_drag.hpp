// Lights and objects under the mouse. Pixels as in orbit.hpp; lights are in the world.
#pragma once

#include "core/scene_description.hpp"

namespace nacre {

/// A directional light turns with the mouse, half a turn for the picture's height; a point light moves across the view
/// at its depth, so that it stays under the mouse.
Light dragged(const Light& light, const Camera& camera, Vec2 pixels, int height);

/// A point light goes towards the eye, 10 % of its depth a step; a directional one stays.
Light pulled(const Light& light, const Camera& camera, double steps);

/// A spot shines elsewhere, turning with the mouse as a directional light does; others stay.
Light aimed(const Light& light, const Camera& camera, Vec2 pixels, int height);

/// The translation with which a node's mesh moves across the view, at the depth of its middle.
/// \param nodes  nodeTransforms of the scene at this moment
Vec3 draggedNode(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes, std::size_t node,
                 const Camera& camera, Vec2 pixels, int height);

/// `light` as it must stand in the scene to be `world` there: the inverse of lightsInWorld for one light.
/// \param nodes  nodeTransforms of the scene at this moment
SceneLight placedInWorld(const SceneLight& light, const Light& world, const std::vector<glm::dmat4>& nodes);

}  // namespace nacre
