// Which lights a frame adds by passes, and what shadow volumes they need. Without OpenGL.
#pragma once

#include "shading/multipass/shadow_source.hpp"
#include "shading/multipass/virtual_light.hpp"
#include "shading/scene_programs.hpp"

namespace nacre {

/// A lamp with a SceneShadow, as points that cast hard shadows.
struct ShadowedLamp {
    std::size_t light = 0;
    Light middle;
    std::vector<Light> points;
};

/// Lamps whose shadows are counted, or that faces send on. Points are more than one with ShadowMethod::Volumes alone.
/// \throws std::invalid_argument unless on.lightPoints is 1 to 63
std::vector<ShadowedLamp> shadowedLamps(const SceneDescription& scene, const SceneSwitches& on,
                                        const std::vector<glm::dmat4>& nodes, const std::vector<Light>& lights);

/// The points that a share takes, or with SoftShadows::Levels the lamps: what counts at once can't be parted. Lamps
/// without points go.
void keepShare(std::vector<ShadowedLamp>& lamps, const SceneSwitches& on);

/// Whether lamps' own light is added by passes: with volumes.
bool countsShadows(const SceneSwitches& on);

/// Each lamp, when its shadows are counted, then its points' images in faces. None where shadows or lamps are off, or
/// with FastPhong: what isn't blocked isn't sent on. \throws nacre::Error for nodes with volumes, when there are any
std::vector<ScheduledLight> scheduledLights(const SceneDescription& scene, const SceneSwitches& on,
                                            const std::vector<ShadowedLamp>& lamps,
                                            const std::vector<SpecularFace>& faces);

/// Of a lamp's point itself.
ShadowSource sourceOf(const ShadowedLamp& lamp, std::size_t point);
/// Of a stage of an image: what blocks there, with what lies beyond the stage's faces left out.
ShadowSource sourceOf(const VirtualLight& image, std::size_t stage, const std::vector<SpecularFace>& faces);

}  // namespace nacre
