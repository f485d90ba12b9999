// Which shaders a scene needs: one program for each combination of what its materials are made of. No OpenGL in here,
// so that `nacre info scene.json` can list them on any machine.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bump/height_map.hpp"
#include "core/asset.hpp"
#include "core/draw_share.hpp"
#include "core/environment.hpp"
#include "core/scene_description.hpp"
#include "shading/gl_objects.hpp"
#include "shading/multipass/specular_options.hpp"
#include "shading/shader_source.hpp"

namespace nacre {

/// How lamps' light on a material is computed. FactoredOrModel: as the material says. Direct: by the model's formula
/// in the shader where the asset was baked from one that has it. FastPhong: meshes alone, factored or model, addressed
/// per vertex (HSE section 1.1): of at most kMaxVertexLights lights, without relief, shadows and surrounding.
enum class SceneReflectance { FactoredOrModel, Direct, FastPhong };

/// How shadows of lights that have a SceneShadow are found. Maps: shading/shadow_map.hpp. Volumes: hard ones, exact to
/// the pixel (shading/multipass/shadow_volume.hpp), of meshes alone; desktop OpenGL. Levels: found already for each
/// pixel (shading/hybrid/sampled_shadows.hpp), on meshes alone; not in what mirrors and panes show.
enum class ShadowMethod { Maps, Volumes, Levels };

/// How volumes soften the shadows of lights with an area, by points of it. Regenerated: each point has its own volumes
/// and its light is added. Pivot: the volumes of the middle, swept from each point (MPR section 4.4: silhouettes stay);
/// one volume is stored instead of one a point. Levels: all points' volumes are counted at once, and the light of the
/// middle is dimmed by the count (PR94's darkness levels): wrong where volumes of one point overlap.
enum class SoftShadows { Regenerated, Pivot, Levels };

/// The approximations of a picture, each to be switched off by itself.
struct SceneSwitches {
    SceneReflectance reflectance = SceneReflectance::FactoredOrModel;
    bool lamps = true;  ///< light of the scene's lights
    bool ambient = true;
    bool shadows = true;  ///< of lights that have a SceneShadow
    ShadowMethod shadowMethod = ShadowMethod::Maps;
    SoftShadows softShadows = SoftShadows::Regenerated;  ///< with volumes
    int lightPoints = 16;                                ///< of an area, 1 to 63
    DrawShare share{};                                   ///< with volumes, of lamps' points; without, the first has all
    GlName lightLevels = 0;  ///< with Levels: an R32F array texture of the target's size, a layer a light; 0: none
    bool relief = true;      ///< bumped normals, and all of a relief's light
    std::optional<BumpShadow> reliefShadow{};  ///< instead of the materials' own, where the asset has it
    bool indirect = true;                      ///< bounced light in reliefs
    bool surrounding = true;                   ///< the environment on surfaces
    bool sky = true;                           ///< the environment as background
    SpecularOptions specular{};                ///< mirrors and panes; depth 0 shows them black. They send
                                               ///< light on with `shadows`, of meshes alone
};

/// What of a baked asset decides about programs.
struct AssetTraits {
    std::string kind;                    ///< brdf, environment, fresnel, scale_bias, bump
    std::string source;                  ///< what it says it was baked from; may be empty
    ShaderDefines brdf;                  ///< of a brdf
    EnvLayout layout = EnvLayout::Cube;  ///< of an environment
    Wrap wrap = Wrap::Repeat;            ///< of a bump asset, as are:
    bool ellipses = false, horizons = false, roughness = false, scatter = false, heights = false;
};

/// \param name  what messages call the file. \throws nacre::Error when the asset is broken or of an unknown kind
AssetTraits traitsOf(const Asset& asset, const std::string& name);

/// Checks what the scene's indices point to: they exist, and are assets of the kind that their member needs. Meshes
/// with a relief have uv. \throws std::invalid_argument for an index that is out of range; nacre::Error "material
/// 'wall': relief: expected an
///         asset of kind bump, found 'marble' of kind brdf"
void checkScene(const SceneDescription& scene, const std::vector<AssetTraits>& assets);

struct SceneProgram {
    std::string vertex, fragment;  ///< files of shaders/
    ShaderDefines defines;

    bool operator==(const SceneProgram&) const = default;
};

/// Whether lights matter: they are on, there are some, and the material has a BRDF.
bool takesLamps(const SceneDescription& scene, const SceneMaterial& material, const SceneSwitches& switches);

/// SpecularOptions::lightDepth unless another is asked for; 0 in scenes with volumes, where no light is sent on.
int usualLightDepth(const SceneDescription& scene);

/// Whether shadow maps are drawn and looked up.
bool mapsShadows(const SceneSwitches& switches);

/// The program that draws a material. \param shadows  shadowDefines of the lights' maps, for nodes that receive them
SceneProgram materialProgram(const SceneDescription& scene, const SceneMaterial& material,
                             const std::vector<AssetTraits>& assets, const SceneSwitches& switches,
                             const ShaderDefines& shadows = {});

/// The program that draws a volume of this material.
SceneProgram volumeProgram(const SceneDescription& scene, const SceneVolume& volume, const SceneMaterial& material,
                           const std::vector<AssetTraits>& assets, const SceneSwitches& switches,
                           const ShaderDefines& shadows = {});

/// Of all programs of a scene with specular faces: they draw from virtual viewpoints (shading/multipass/).
ShaderDefines viewDefines(const SceneDescription& scene);

/// What of the switches holds for volumes, which have no vertices to address textures from: FastPhong is
/// FactoredOrModel.
SceneSwitches volumeSwitches(SceneSwitches switches);

/// The relief that is drawn under these switches: none, or the material's with what they leave of it.
std::optional<SceneRelief> reliefOf(const SceneMaterial& material, const std::vector<AssetTraits>& assets,
                                    const SceneSwitches& switches);

/// The text of the model that Direct evaluates for a material: its own or that its asset was baked from; empty when
/// there is none with a shader form.
std::string directModelOf(const SceneDescription& scene, const SceneMaterial& material,
                          const std::vector<AssetTraits>& assets);

struct ListedProgram {
    SceneProgram program;
    std::vector<int> nodes;  ///< that it draws
};

/// Every program that draws nodes of the scene, in the order of the first node of each; the sky's, which draws none,
/// comes last.
std::vector<ListedProgram> scenePrograms(const SceneDescription& scene, const std::vector<AssetTraits>& assets,
                                         const SceneSwitches& switches = {});

}  // namespace nacre
