// A whole scene as values: what shading/ draws and reference/ traces. shading/scene_file.hpp reads it from JSON, and
// from the mesh files that the JSON names. Indices count elements of the vector that the member's name says; -1 = none.
#pragma once

#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/image.hpp"
#include "core/scene.hpp"
#include "core/volume.hpp"

namespace nacre {

/// How a relief shadows itself. Soft: edges one pixel wide. All fade to the mean of what they stand for from afar.
enum class BumpShadow { None, HardEllipse, Ellipse, HardHorizon, Horizon };

/// One call of the command: `nacre VERB SOURCE -o FILE OPTIONS…`.
struct BakeRecipe {
    std::string verb;                  ///< factorize, envmap, fresnel or bump
    std::string source;                ///< a model's text, or a path (absolute, or from the working folder)
    std::vector<std::string> options;  ///< as typed: "--max-error", "0.01"
    std::vector<std::string> inputs;   ///< those of source and options that are files
};

/// A baked-asset file (core/asset.hpp).
struct SceneAsset {
    std::string name;
    std::filesystem::path file;      ///< absolute, or from the working folder
    std::optional<BakeRecipe> bake;  ///< none: the file was made elsewhere
    std::string source;  ///< what the bake approximates, for the reference: a model's text or a path. Empty: unknown
};

struct SceneLookup {
    int asset = -1;  ///< a prefiltered environment map or chain
    double lod = 0;  ///< level of a chain, ≥ 0
    Rgb color{1};
};

/// The surrounding as a light (shading/environment_pass.hpp: the same members, the same meaning).
struct SceneSurrounding {
    SceneLookup reflection, transmission, diffuse;
    double ior = 1.5;
    int table = -1;  ///< asset: a Fresnel table, or one of scale and bias
    Rgb f0{0.04};
    double perceptualRoughness = 0;
    bool multipleScattering = false;
    bool blend = false;  ///< W Lm + (1 − W) D instead of W Lm + D
};

/// A relief on the surface (shading/gpu_bump.hpp).
struct SceneRelief {
    int asset = -1;
    BumpShadow shadow = BumpShadow::Ellipse;
    Vec2 tiles{1};           ///< of the relief per unit of the mesh's uv, > 0
    bool roughness = false;  ///< widens microfacet models by the slopes that a far view blends
    int indirectLight = -1;  ///< whose bounced light is added; the asset then holds a scatter map
    Rgb albedo{0.7};         ///< of the bounces
    int bounces = 2, paths = 64;
};

/// The surface mirrors or refracts what is around it: of planar meshes alone. A mirror does so on both sides.
struct SceneSpecular {
    /// Of what is behind (the normal points to the front) over what is before, > 0; none: a mirror.
    std::optional<double> ior{};
    Rgb reflection{1}, transmission{1};  ///< factors of what is reflected and refracted
    /// A refracting face reflects by Fresnel and refracts the rest; false: all or nothing, at the critical angle
    /// (PR94).
    bool partial = true;
    double surface = 0;  ///< share of the material's own light, in [0, 1]; the rest is specular
    /// Over the mesh's uv: rgb times the own light, alpha times `surface`. Four channels, row 0 at v = 0. None: all 1.
    std::shared_ptr<const Image> texture{};
    /// Over the mesh's uv: rgb times `transmission`, of a mirror times `reflection`, so stained glass; alpha isn't
    /// used. Four channels, the same size as the texture. None: all 1. Its uv, and the texture's, are one affine map of
    /// the plane.
    std::shared_ptr<const Image> filter{};
    /// What is seen in the face fades to this radiance, wholly at this distance from its plane; 0: no fog.
    Rgb fog{0};
    double fogDistance = 0;
    /// Frosted or glossy: the slopes of directions against the normal are off by a Gaussian of this deviation (MPR 3).
    double spread = 0;
    /// Or a rough face, of microfacets of Beckmann's distribution with this α; views are sheared as its facets turn
    /// rays.
    double roughness = 0;
    std::vector<std::filesystem::path> pictures{};  ///< the files of texture and filter

    bool scatters() const { return spread > 0 || roughness > 0; }
};

/// What a surface is made of. Any subset: each member that is set adds its light.
struct SceneMaterial {
    std::string name;
    int brdf = -1;      ///< asset: a factored BRDF, lit by the scene's lights; or …
    std::string model;  ///< … an analytic model's text, evaluated in the shader. Both unset: lights don't matter
    Rgb ambient{0};     ///< radiance added
    std::optional<SceneRelief> relief;
    std::optional<SceneSurrounding> surrounding;
    std::optional<SceneSpecular> specular;
};

/// A mesh or volume, or instance of one, in the hierarchy. Local to parent: translation · rotation · scale.
struct SceneNode {
    std::string name;
    int parent = -1;  ///< an index below this node's own
    glm::dvec3 translation{0}, scale{1};
    glm::dquat rotation{1, 0, 0, 0};  ///< unit
    int mesh = -1, volume = -1;  ///< one of them, with a material without relief for a volume; or none of the three
    int material = -1;
    bool castsShadow = true, receivesShadow = true;
    bool isStatic = true;  ///< false: the node, or one above it, has a track or says so; its shadows are redrawn
};

/// 16- or 32-bit linear depth seen from the light (shading/shadow_map.hpp).
struct SceneShadow {
    int size = 1024;  ///< texels along an edge of each map
    int bits = 32;    ///< 16 or 32
    int filter = 3;   ///< edge of the percentage-closer filter [texels], 1 = none
    enum class Faces { Both, Front, Back } faces = Faces::Both;  ///< drawn into the map
    std::optional<double> bias;   ///< [world units]; none: derived from texel size, depth resolution and slope
    double near = 0, far = 0;     ///< [world units]; 0: fitted to the scene
    int cascades = 1;             ///< of a directional light, 1 to 4
    bool dualParaboloid = false;  ///< of a point light, instead of a cube
};

/// Spreads a point light or spot evenly over the points position + s u + t v, s and t in [-1, 1]. Each shines as the
/// light does, with its share of the color. Seen by shadow volumes and the reference; elsewhere it is in the middle.
struct LightArea {
    glm::dvec3 u{0}, v{0};  ///< local as the position is
};

struct SceneLight {
    std::string name;
    int node = -1;  ///< the light moves with it; position and axis are then local to it
    Light light;
    std::optional<SceneShadow> shadow;
    std::optional<LightArea> area{};  ///< of a light that isn't directional
};

/// Key frames of one node's translation, rotation or scale.
struct SceneTrack {
    int node = -1;
    enum class Path { Translation, Rotation, Scale } path = Path::Translation;
    std::vector<double> times;       ///< [s], ascending, at least one
    std::vector<glm::dvec4> values;  ///< one a time; a rotation is x, y, z, w
    bool step = false;               ///< keeps a value until the next time; else linear, rotations slerped
};

struct SceneMesh {
    std::string name;
    Mesh mesh;
};

/// The surface value = iso of a volume (shading/volume_surface.hpp), in the volume's own space.
struct SceneVolume {
    std::string name;
    std::shared_ptr<const Volume> volume;  ///< never null; copies of the scene share it
    double iso = 0;
    VolumeMethod method = VolumeMethod::March;
    double step = 0.5;  ///< between slices or of the march [texels], > 0
};

struct SceneSky {
    int asset = -1;        ///< what the background shows; an environment map or chain, or -1 for `color`
    double lod = 0;        ///< of a chain
    Rgb color{0};          ///< radiance of the background without a map
    double rotationY = 0;  ///< turns the surrounding about the world's up axis, for materials too [rad]
};

struct SceneDescription {
    std::filesystem::path file;  ///< read from here
    std::vector<SceneAsset> assets;
    std::vector<SceneMesh> meshes;
    std::vector<SceneVolume> volumes;
    std::vector<SceneMaterial> materials;
    std::vector<SceneNode> nodes;
    std::vector<SceneLight> lights;
    std::vector<SceneTrack> tracks;
    SceneSky sky;
    Camera camera;
    double duration = 0;  ///< of the animation, which repeats [s]; 0: none
};

/// A node's place at `time` [s]: local to world, one a node. Tracks repeat after scene.duration and hold their first
/// and last value outside their times. \throws std::invalid_argument when a parent isn't before its child or time
/// isn't finite
std::vector<glm::dmat4> nodeTransforms(const SceneDescription& scene, double time);

/// The scene's lights in the world, given nodeTransforms' result: positions moved, axes turned, intensities kept.
std::vector<Light> lightsInWorld(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes);

/// A mesh in the world. Normals by the inverse transpose, tangents by the matrix itself, orthogonal to the normal and
/// unit again; with a mirroring matrix triangles are turned over and w changes its sign.
Mesh transformed(const Mesh& mesh, const glm::dmat4& toWorld);

}  // namespace nacre
