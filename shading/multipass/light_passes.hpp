// Light of lamps as passes of their own, added where no shadow volume is counted.
#pragma once

#include <functional>

#include "shading/multipass/scene_shadow_volumes.hpp"
#include "shading/scene_programs.hpp"

namespace nacre {

/// A lamp with a SceneShadow, as points that cast hard shadows.
struct ShadowedLamp {
    std::size_t light = 0;
    std::vector<Light> points;
    std::size_t volumes = 0;  ///< number of the first point's in SceneShadowVolumes
    bool stored = true;       ///< each point has its own
};

/// The scene's. \param sources  takes the lights that volumes are stored for
std::vector<ShadowedLamp> shadowedLamps(const SceneDescription& scene, const SceneSwitches& on,
                                        const std::vector<glm::dmat4>& nodes, const std::vector<Light>& lights,
                                        std::vector<Vec4>& sources);

/// Light `light` of the scene as `value`, no other, added to what was drawn where the stencil lets it: on nodes that
/// receive shadows, or on those that don't.
using LampDrawer = std::function<void(std::size_t light, const Light& value, bool receivers)>;

/// A view whose surfaces stand in the target, without the light of lamps with a SceneShadow.
struct LitTarget {
    const RenderTarget& target;
    const ShadowSight& sight;
    const LampDrawer& draw;
};

/// Adds a lamp's light: each point's where the count of its volumes is zero (MPR section 7.2), or with
/// SoftShadows::Levels the middle's light, dimmed by how many points' volumes contain a pixel (PR94 "Soft shadows").
void addLamp(const LitTarget& to, ShadowStencil& stencil, const SceneShadowVolumes& volumes, const ShadowedLamp& lamp,
             const Light& middle, SoftShadows how);

}  // namespace nacre
