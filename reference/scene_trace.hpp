// The true picture of a scene: the same SceneDescription as shading/scene_renderer.hpp draws, traced.
#pragma once

#include "core/image.hpp"
#include "core/progress.hpp"
#include "core/scene_description.hpp"
#include "reference/scene_truths.hpp"

namespace nacre {

/// What light a picture has: the same words as SceneSwitches of shading/scene_programs.hpp.
struct SceneParts {
    bool lamps = true, ambient = true;
    bool shadows = true;       ///< of surfaces on surfaces, for lights that have a SceneShadow
    bool relief = true;        ///< bumped normals, and all of a relief's light
    bool reliefShadow = true;  ///< the relief on itself: of lamps, ambient and diffuse light
    bool indirect = true;      ///< bounced light in reliefs
    bool surrounding = true;
    bool sky = true;
    bool bakedBrdf = false;        ///< the baked BRDF in place of the unfactored one
    bool interreflection = false;  ///< light of lamps that other meshes reflected before, by their BRDFs
    int bounces = 0;               ///< at most, of interreflection; 0: as SceneTraceOptions says
    /// Rays whose first surface is specular, or all others: a picture's parts, whose sum is the picture.
    enum class FirstSurface { Any, Specular, Other } firstSurface = FirstSurface::Any;
    bool occlusion = false;  ///< surfaces block the surrounding's light (reflected and diffuse, not transmitted)
};

struct SceneTraceOptions {
    int width = 512, height = 512;  ///< [pixels] ≥ 1
    int supersample = 2;            ///< n × n rays a pixel on a regular grid, ≥ 1
    std::vector<Vec2> points{};     ///< of a pixel's rays, from its upper left corner to (1, 1); none: the grid
    double time = 0;                ///< [s]
    int specularDepth = 4;          ///< specular surfaces along a path; the last shows its own light alone
    int lightDepth = 2;             ///< the same along a path from a light; 0: they block and send nothing on
    int spreadRays = 16;            ///< of a ray that meets a frosted or glossy one
    int facePoints = 16;            ///< of a ray, on each frosted, glossy or rough face that scatters a light on
    int skyRays = 4;                ///< of a ray, into a relief's sky: what of the diffuse and ambient light is blocked
    int indirectPaths = 4;          ///< of a ray
    int occlusionRays = 8;          ///< of a ray, into each of the surrounding's lobes; with SceneParts::occlusion
    int lightPoints = 4;            ///< of a ray, in each light's area
    int interreflectionPaths = 8;   ///< of a ray; with SceneParts::interreflection
    int interreflectionBounces = 8;  ///< at most, of a path
    std::uint64_t seed = 1;
    unsigned threads = 0;  ///< same bits for any
    Progress progress{};
};

/// One picture for each of `parts`, of the same rays. At the first triangle between near and far plane, either side, or
/// the first point inside a volume's surface (volume_field.hpp), whatever comes first:
///   lamps        Σ f · cosα · irradiance, f unfactored; shadow rays to lights with a SceneShadow past nodes that cast
///                lights with an area: the mean over its points
///   interreflection  paths with cosine-weighted directions, lamps at each of their ends; reliefs reflect as planes
///   relief       the normal of the height field's own patch at uv · tiles; where that faces away from the eye it is
///                tilted as the shader does; a lamp is dark below the exact horizon and where the mesh faces away
///   ambient      times the share of cosine-weighted directions about the normal that leave the relief
///   indirect     paths over the height field with its own patches, of SceneRelief's light at this point's direction,
///                albedo and bounces; Lambert
///   surrounding  integrals of the unbaked environment over the lobe that the baked level states, exact Fresnel; minus,
///                of the diffuse part, what the relief blocks
///   specular     mirrors and panes send rays on, exactly (specular_path.hpp); what is above is of where they end
///   light paths  lamps with a SceneShadow by way of mirrors and panes (light_path.hpp; of those that scatter,
///                scattered_light.hpp), with SceneParts::shadows; not in the bounced light of reliefs
/// The three lines before the last are of random rays (Monte Carlo; the estimate is unbiased but for averages over 3°
/// of what is blocked). In neither picture: light that bounces between meshes, or in reliefs from other lights and the
/// surrounding; reliefs as seen in mirrored and refracted directions; parallax. \throws std::invalid_argument: sizes or
/// counts < 1, truths for another number of materials, non-finite positions
std::vector<Image> traceScene(const SceneDescription& scene, const Camera& camera, const SceneTruths& truths,
                              const std::vector<SceneParts>& parts, const SceneTraceOptions& options = {});

}  // namespace nacre
