// What a SceneRenderer with ShadowMethod::Levels needs before it draws a view: the view's geometry, and levels of its
// lights.
#pragma once

#include <map>

#include "shading/hybrid/sampled_shadows.hpp"

namespace nacre {

class LevelPass {
public:
    /// \param scene  outlives this; its lights may change, its meshes not
    LevelPass(ProgramLoader& loader, const SceneDescription& scene)
        : loader_(loader), scene_(scene), shadows_(loader, scene) {}

    /// \param width, height  the picture's, ≥ 1 \return  for SceneSwitches::lightLevels; 0 in scenes without lights
    /// \throws as SampledShadows::draw
    GlName draw(int width, int height, const Camera& camera, double time, const SampledShadowOptions& options);
    const SampledShadowChoice& choice() const { return shadows_.choice(); }

private:
    ProgramLoader& loader_;
    const SceneDescription& scene_;
    SampledShadows shadows_;
    std::map<int, GpuMesh> meshes_;
    std::optional<GeometryBuffer> geometry_;
};

}  // namespace nacre
