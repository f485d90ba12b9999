// Draws a lit mesh: per pixel the sum over lights of f(wi, wo) · cosα · E, with a factored BRDF or a directly evaluated
// one.
#pragma once

#include <span>
#include <vector>

#include "core/scene.hpp"
#include "shading/gpu_bump.hpp"
#include "shading/gpu_direct_brdf.hpp"
#include "shading/gpu_factored_brdf.hpp"
#include "shading/gpu_mesh.hpp"
#include "shading/render_target.hpp"

namespace nacre {

inline constexpr int kMaxLights = 8;        ///< PerPixel
inline constexpr int kMaxVertexLights = 4;  ///< PerVertex: each takes an interpolated vector

/// How the textures are addressed (HSE section 1.1). The later two are the paper's; what they cost in error shrinks
/// with the triangles.
enum class Addressing {
    PerPixel,      ///< normal and tangent are interpolated; all vectors are made and normalised in the pixel
    PerVertex,     ///< "fast Phong": local vectors made at the vertices, interpolated, not normalised again
    TextureMatrix  ///< equations 2 and 3: forms cosine and tangent, one directional light, orthographic camera
};

class ShadowMap;

struct LitView {
    Camera camera;
    std::vector<Light> lights;  ///< colors >= 0 or any sign; nothing is clamped
    Rgb ambient{0};             ///< radiance added to every point of the surface
    glm::dmat4 toWorld{1};      ///< places the mesh: drawn as nacre::transformed(mesh, toWorld), mirrored ones too
    /// Of the lights, one each or null (shading/shadow_map.hpp); none at all: no shadows. Addressing::PerPixel only.
    std::vector<const ShadowMap*> shadows{};
};

/// Draws into `target` with depth test and depth write on, face culling and blending off, and leaves these so, with the
/// program in use and the BRDF's textures bound from unit 0. Doesn't clear. Back faces are black (plus ambient).
/// Shadow maps are bound from unit 13.
/// \throws std::invalid_argument with shadow maps that aren't as shadowDefines (shading/shadow_map.hpp) says, more
/// lights than the addressing takes, a directional light that is not unit
///         length, a spot's cone that isn't as SpotCone says, or TextureMatrix with another form, light or camera than
///         it can do; nacre::Error from the shaders
void renderFactored(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const LitView& view,
                    const GpuFactoredBrdf& brdf, Addressing addressing = Addressing::PerPixel);

/// The same with the model evaluated in the shader: the baseline for run-time cost. PerPixel or PerVertex.
void renderDirect(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const LitView& view,
                  const GpuDirectBrdf& brdf, Addressing addressing = Addressing::PerPixel);

/// With a relief: bumped normals and the shadows that the relief casts on itself, per pixel. Where the mesh's own
/// normal faces away from a light it is dark. The share of the sky that ellipses know scales view.ambient. The relief's
/// textures are bound after the BRDF's.
/// \throws as above; std::invalid_argument for what the relief's maps don't have (bumpDefines)
void renderFactored(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const LitView& view,
                    const GpuFactoredBrdf& brdf, const BumpSurface& relief);
void renderDirect(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const LitView& view,
                  const GpuDirectBrdf& brdf, const BumpSurface& relief);

}  // namespace nacre
