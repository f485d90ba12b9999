// Light that bounced in the relief of one node, made again only when what it depends on has changed.
#pragma once

#include <memory>

#include "core/scene_description.hpp"
#include "shading/gpu_relief_light.hpp"
#include "shading/scene_assets.hpp"

namespace nacre {

/// What the light in a node's relief is made for.
struct NodeLightInput {
    const SceneRelief& relief;  ///< with an indirect light
    const SceneAssets& assets;
    const std::filesystem::path& file;  ///< of the relief's asset
    const Mesh& mesh;
    const glm::dmat4& toWorld;
    const Light& light;
};

class NodeLight {
public:
    /// \throws nacre::Error "FILE: expected heights and a scatter map, found them gone"
    void update(ProgramLoader& loader, const NodeLightInput& input);
    /// Radiance without direct light. \pre update() was called
    GlName scattered() const { return gpu_->scattered(); }

private:
    int asset_ = -1, version_ = 0, bounces_ = 0, paths_ = 0;
    Rgb albedo_{0};
    Vec3 direction_{0};
    std::unique_ptr<GpuReliefLight> gpu_;
    glm::dmat4 toWorld_{0};  ///< what `direction_` was found for, as is:
    Light light_;
};

}  // namespace nacre
