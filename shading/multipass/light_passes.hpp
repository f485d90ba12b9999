// Light of lamps, and of their images in mirrors and panes, as passes of their own: added where no shadow volume is
// counted.
#pragma once

#include <functional>

#include "shading/multipass/light_schedule.hpp"
#include "shading/multipass/scene_shadow_volumes.hpp"

namespace nacre {

/// Light `light` of the scene as `value`, no other, added to what was drawn where the stencil lets it: on nodes that
/// receive shadows, or on those that don't. \param image  of the lamp that it is, or null
using LampDrawer =
    std::function<void(std::size_t light, const Light& value, const VirtualLight* image, bool receivers)>;

/// A view whose surfaces stand in the target, without the light that is added.
struct LitTarget {
    const RenderTarget& target;
    const ShadowSight& sight;
    int level = 0;  ///< the stencil value of its pixels
    const LampDrawer& draw;
};

/// Of one frame. A context must be current for all calls.
class LightPasses {
public:
    /// Makes the volumes that are missing. All but `loader` and `on` outlive this; volumes aren't updated meanwhile.
    LightPasses(ProgramLoader& loader, SceneShadowVolumes& volumes, const SceneSwitches& on,
                const std::vector<ShadowedLamp>& lamps, const std::vector<SpecularFace>& faces,
                const std::vector<ScheduledLight>& lights, const std::vector<glm::dmat4>& nodes);

    /// A lamp: each point's light where the count of its volumes is zero (MPR section 7.2), or with SoftShadows::Levels
    /// the middle's light, dimmed by how many points' volumes contain a pixel (PR94 "Soft shadows").
    /// An image: where all light volumes of its faces overlap (MPR figure 5) and no shadow of any stage falls, before
    /// and after the faces (PR94's two phases). Leaves the state of setDrawState, stencil test off.
    void add(const LitTarget& to, std::size_t light);

private:
    void addPoints(const LitTarget& to, const ShadowedLamp& lamp, std::size_t first);
    void addLevels(const LitTarget& to, const ShadowedLamp& lamp, std::size_t first);
    void addImage(const LitTarget& to, const VirtualLight& image, std::size_t light);
    const ShadowedLamp& lampOf(std::size_t light) const;

    SceneShadowVolumes& volumes_;
    SoftShadows soft_;
    const std::vector<ShadowedLamp>& lamps_;
    const std::vector<ScheduledLight>& lights_;
    std::vector<std::size_t> firstSource_;  ///< a light: of its points, or of its stages
    std::vector<std::vector<std::optional<PlacedShadowVolume>>> lightVolumes_;  ///< a light, a bounce
    ShadowStencil stencil_;
};

/// Whether programs that draw this light need NACRE_LIGHT_PATH.
bool needsLightPath(const VirtualLight& image);
/// What they are loaded with.
ShaderDefines lightPathDefines(const VirtualLight& image);
/// Uniforms of bind/light_path.glsl.
void setLightPath(const Program& program, const VirtualLight& image);
/// The image as a light of programs that draw it.
Light lightOf(const VirtualLight& image);

}  // namespace nacre
