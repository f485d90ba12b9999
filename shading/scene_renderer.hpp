// Draws a SceneDescription: every node with its material, the lights' shadow maps, the surrounding as background.
// reference/scene_trace.hpp traces the same description.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/scene_description.hpp"
#include "shading/multipass/pass_schedule.hpp"
#include "shading/multipass/scene_shadow_volumes.hpp"
#include "shading/pass_clock.hpp"
#include "shading/program.hpp"
#include "shading/render_target.hpp"
#include "shading/scene_assets.hpp"
#include "shading/scene_programs.hpp"

namespace nacre {

/// Owns the scene's GPU objects. The context that was current in the constructor must be current in every call.
class SceneRenderer {
public:
    /// \param loader  outlives this
    /// \throws std::invalid_argument and nacre::Error: checkScene, SceneAssets::open, a model without a shader form,
    ///         more than kMaxLights lights, a context older than OpenGL 3.3 or ES 3.0
    SceneRenderer(ProgramLoader& loader, SceneDescription scene);
    ~SceneRenderer();
    SceneRenderer(SceneRenderer&&) noexcept;
    SceneRenderer& operator=(SceneRenderer&&) noexcept;

    const SceneDescription& scene() const;
    const SceneAssets& assets() const;

    /// Clears the target and draws the scene as it stands at `time` [s]. Alpha is 1 everywhere.
    /// Indirect light of reliefs and shadow maps are made again only when what they depend on has changed. The first
    /// frame compiles programs. Leaves depth test and write on, culling and blending off.
    void render(const RenderTarget& target, const Camera& camera, double time = 0);
    void render(const RenderTarget& target, double time = 0) { render(target, scene().camera, time); }

    SceneSwitches switches;  ///< of the next frame; change it freely. At first with the scene's usualLightDepth

    /// Of the last frame that had volumes.
    ShadowVolumeCounts shadowVolumes() const;

    /// With timing on, passes() tells what the parts of the last frame took; it costs a glFinish a part.
    void setTiming(bool on);
    const std::vector<PassTime>& passes() const;
    /// What the last frame was drawn by: one pass in scenes without specular faces.
    const PassSchedule& schedule() const;

    /// Edits. Each checks the new scene as the constructor does; on failure nothing has changed.
    void setLight(std::size_t light, const SceneLight& value);
    void setMaterial(std::size_t material, const SceneMaterial& value);
    void setNodeMaterial(std::size_t node, int material);
    void setNodeTranslation(std::size_t node, const Vec3& value);  ///< unless a track of the animation moves it
    void setSky(const SceneSky& value);
    /// Another scene, or the same one read again: assets and meshes that didn't change stay loaded.
    void setScene(SceneDescription scene);

    /// Assets whose files changed (SceneAssets::reload). One that no longer fits the scene keeps its last good state
    /// too.
    std::vector<AssetChange> reloadAssets();

    /// Radiance that leaves nodes' vertices on its own, drawn with the ambient light (MPR section 6): one list a node,
    /// empty or a value for each vertex of its mesh. Until the next setScene.
    /// \throws std::invalid_argument for other lengths
    void setIndirectLight(const std::vector<std::vector<glm::vec3>>& radiance);

    /// Programs of the scene under the present switches.
    std::vector<ListedProgram> programs() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace nacre
