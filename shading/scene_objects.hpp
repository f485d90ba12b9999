// A scene and what of it is on the GPU: what SceneRenderer's frames are drawn from.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "core/scene_description.hpp"
#include "core/shadow_view.hpp"
#include "shading/environment_pass.hpp"
#include "shading/gpu_direct_brdf.hpp"
#include "shading/lit_pass.hpp"
#include "shading/node_light.hpp"
#include "shading/scene_assets.hpp"
#include "shading/scene_programs.hpp"
#include "shading/volume_pass.hpp"

namespace nacre {

struct DrawnMesh {
    std::optional<GpuMesh> gpu;  ///< none: without triangles
    Bounds box;
    Vec3 centre{0};
    double radius = 0;
};

/// A context must be current for all calls.
class SceneObjects {
public:
    /// \param loader  outlives this
    /// \throws std::invalid_argument and nacre::Error: checkScene, SceneAssets::open, a model without a shader form
    SceneObjects(ProgramLoader& loader, SceneDescription&& scene);

    const SceneDescription& scene() const { return scene_; }
    const SceneAssets& assets() const { return assets_; }
    const std::vector<AssetTraits>& traits() const { return traits_; }
    const GpuAsset& asset(int index) const { return assets_[static_cast<std::size_t>(index)]; }
    const SceneMaterial& materialOf(std::size_t node) const {
        return scene_.materials[static_cast<std::size_t>(scene_.nodes[node].material)];
    }

    const DrawnMesh* meshOf(std::size_t node) const;  ///< null: none, or without triangles
    std::optional<VolumeSurface> volumeOf(std::size_t node, const glm::dmat4& toWorld) const;
    bool hasVolumes() const { return !volumes_.empty(); }
    const Texture* faceTextureOf(const SceneSpecular& specular) const;                  ///< null: none
    const std::optional<Texture>& faceImages() const { return faceImages_; }            ///< bindFaceImages's
    const Buffer* radianceOf(std::size_t node) const;                                   ///< a vertex; null: none
    bool hasNodeLight(std::size_t node) const { return nodeLights_.count(node) != 0; }  ///< of its relief
    Mat3 worldToSky() const;
    /// About all that is drawn.
    Bounds box(const std::vector<glm::dmat4>& nodes) const;

    /// Light that reliefs scatter, made again where something moved.
    void updateNodeLights(const SceneSwitches& on, const std::vector<glm::dmat4>& nodes,
                          const std::vector<Light>& lights);
    /// Everything of a node but its place.
    void bindMaterial(const Program& program, std::size_t node, const SceneSwitches& on, const LitView& view) const;

    // As SceneRenderer's.
    void setLight(std::size_t light, const SceneLight& value) { edit(scene_.lights.at(light), value); }
    void setMaterial(std::size_t material, const SceneMaterial& value) { edit(scene_.materials.at(material), value); }
    void setNodeMaterial(std::size_t node, int material) { edit(scene_.nodes.at(node).material, material); }
    void setNodeTranslation(std::size_t node, const Vec3& value) { edit(scene_.nodes.at(node).translation, value); }
    void setSky(const SceneSky& value) { edit(scene_.sky, value); }
    void setScene(SceneDescription&& next);
    void setIndirectLight(const std::vector<std::vector<glm::vec3>>& radiance);
    std::vector<AssetChange> reloadAssets();

private:
    void prepareModels();
    EnvironmentLookup lookup(const SceneLookup& l) const;
    EnvironmentSurface surfaceOf(const SceneSurrounding& s) const;
    BumpSurface bumpOf(std::size_t node, const SceneRelief& relief, bool lamps) const;

    /// Takes the value, unless the scene is unsound with it.
    template <class T>
    void edit(T& member, T value) {
        std::swap(member, value);
        try {
            checkScene(scene_, traits_);
        } catch (...) {
            std::swap(member, value);
            throw;
        }
        prepareModels();
    }

    ProgramLoader& loader_;
    SceneDescription scene_;
    SceneAssets assets_;
    std::vector<AssetTraits> traits_;
    std::vector<DrawnMesh> meshes_;
    std::map<std::shared_ptr<const Volume>, GpuVolume> volumes_;
    std::map<std::shared_ptr<const Image>, Texture> faceTextures_;
    std::optional<Texture> faceImages_;                 ///< of all specular materials; addressed by texelFetch
    std::vector<std::optional<GpuDirectBrdf>> models_;  ///< one a material: what Direct evaluates
    std::map<std::size_t, NodeLight> nodeLights_;       ///< of nodes whose relief has indirect light
    std::map<std::size_t, Buffer> nodeRadiance_;        ///< a vertex, of nodes that have it
};

}  // namespace nacre
