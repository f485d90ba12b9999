// The surrounding as a light: meshes that reflect and transmit prefiltered maps, the surrounding as a background, and
// meshes lit by lamps and surrounding together.
#pragma once

#include "shading/gpu_environment.hpp"
#include "shading/lit_pass.hpp"
#include "shading/multipass/specular_view.hpp"

namespace nacre {

/// How the reflection joins what is below the surface (HSE section 1.5): W Lm + D, or W Lm + (1 − W) D.
enum class EnvironmentCombine { Add, Blend };

/// A prefiltered chain in use.
struct EnvironmentLookup {
    const GpuEnvironment* map = nullptr;  ///< none: contributes nothing
    double lod = 0;                       ///< level; clamped to the chain's. For a single map 0
    Rgb color{1};                         ///< factor
};

/// W = 1 without a table, F(n·v) with a Fresnel table, f0 · scale + bias with one of scale and bias.
/// D = transmission + diffuse. All maps have one layout. Pointers stay the caller's.
struct EnvironmentSurface {
    EnvironmentLookup reflection;    ///< by the viewing direction mirrored about the normal
    EnvironmentLookup transmission;  ///< by the viewing direction refracted once: what lies beyond is the medium
    EnvironmentLookup diffuse;       ///< by the normal; color = albedo, for maps normalised to irradiance/π
    double ior = 1.5;                ///< of the transmission, beyond the surface relative to the viewer's side, > 0
    const GpuEnvironmentTable* table = nullptr;
    Rgb f0{0.04};                     ///< with a table of scale and bias
    double perceptualRoughness = 0;   ///< the same
    bool multipleScattering = false;  ///< the same: adds what facets reflect among themselves
    EnvironmentCombine combine = EnvironmentCombine::Add;
    Mat3 fromWorld{1};  ///< turns world directions into the maps': the surrounding turns by its inverse
};

/// What W is; the order is shaders/nacre/bind/environment.glsl's.
enum class EnvironmentWeight { One, Fresnel, ScaleBias, ScaleBiasMultiple };

/// What of a surface a program is made for.
struct EnvironmentChoices {
    EnvLayout layout = EnvLayout::Cube;  ///< of the maps
    bool reflection = false, transmission = false, diffuse = false;
    EnvironmentWeight weight = EnvironmentWeight::One;
    EnvironmentCombine combine = EnvironmentCombine::Add;
};
ShaderDefines environmentDefines(const EnvironmentChoices& choices);
/// \throws std::invalid_argument when maps have different layouts, an lod isn't finite or ior ≤ 0
ShaderDefines environmentDefines(const EnvironmentSurface& surface);

/// Binds maps and table to units firstUnit …, each its own (samplers of two kinds on one unit fail the draw), and sets
/// the uniforms of nacre/bind/environment.glsl; leaves `program` in use.
inline constexpr int kEnvironmentUnits = 4;
void bindEnvironment(const Program& program, const EnvironmentSurface& surface, int firstUnit);

/// Draws into `target` as renderFactored does: depth test and write on, culling and blending off, left so; the program
/// in use and textures bound from unit 0. Doesn't clear. Surfaces seen from behind are black.
/// \throws std::invalid_argument when maps have different layouts, an lod isn't finite or ior ≤ 0; nacre::Error from
///         the shaders
/// With a relief its normals take the surface's place, and the share of the sky that ellipses know scales the diffuse
/// light; mirrored and refracted directions see no relief. toWorld places the mesh, as LitView's does.
void renderEnvironment(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const Camera& camera,
                       const EnvironmentSurface& surface, const BumpSurface& relief = {},
                       const glm::dmat4& toWorld = glm::dmat4(1));

/// The same plus lamps by a BRDF, in one shader: sum over lights of f cosα E, plus the surrounding, plus view.ambient.
/// The BRDF's textures are bound from unit 0, the surrounding's and the relief's after them.
void renderFactored(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const LitView& view,
                    const GpuFactoredBrdf& brdf, const EnvironmentSurface& surface, const BumpSurface& relief = {});
void renderDirect(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const LitView& view,
                  const GpuDirectBrdf& brdf, const EnvironmentSurface& surface, const BumpSurface& relief = {});

/// The surrounding where nothing was drawn: at the far plane, depth test LEQUAL without depth write, alpha 1. With an
/// orthographic camera all pixels look one way. Leaves depth test LESS and write on, culling and blending off.
void renderSky(ProgramLoader& loader, const RenderTarget& target, const Camera& camera, const EnvironmentLookup& sky,
               const Mat3& fromWorld = Mat3(1));

/// The same from a virtual viewpoint, in the state that is: what it draws is at the far plane. With NACRE_VIEW among
/// the defines as `light` says.
void drawSky(ProgramLoader& loader, const SpecularView& view, const EnvironmentLookup& sky, const Mat3& fromWorld,
             const ViewLight& light = {}, const ShaderDefines& defines = {});

}  // namespace nacre
