// The shadow maps of a scene's lights, drawn again only when what they were drawn from has changed.
#pragma once

#include "core/scene_description.hpp"
#include "shading/shadow_map.hpp"

namespace nacre {

/// Everything that a light is, alike.
bool sameLight(const Light& a, const Light& b);

/// A context must be current for all calls but clear().
class SceneShadowMaps {
public:
    /// Draws the maps of lights that moved, or whose casters did. \param lights  in the world, one each of the scene's
    /// \param drawn  bounds may be empty: nothing is done
    void update(ProgramLoader& loader, const std::vector<SceneLight>& sceneLights, const std::vector<Light>& lights,
                const ShadowScene& drawn);
    /// One a light, null where there is none; none at all where no light has one.
    std::vector<const ShadowMap*> maps() const;
    void clear() { kept_.clear(); }

private:
    /// A light's map, and what it was drawn from.
    struct Kept {
        std::optional<ShadowMap> map;
        Light light;
        std::vector<ShadowCaster> casters;
        std::vector<VolumeSurface> volumes;
        Bounds bounds;
        glm::dmat4 camera{0};  ///< of cascades
    };
    std::vector<Kept> kept_;  ///< one a light
};

}  // namespace nacre
