// What the passes that draw meshes have in common: camera and lights as uniforms, and the state of a draw.
#pragma once

#include "shading/lit_pass.hpp"
#include "shading/multipass/specular_view.hpp"

namespace nacre {

Vec3 orthographicDirection(const Camera& camera);  ///< towards the viewer, unit

/// \throws std::invalid_argument with more than `most` lights, a directional one that is not unit length, or what
///         checkCone says
void checkLights(std::span<const Light> lights, int most);
/// Adds NACRE_LIGHTS: one program for each number of lights, see bind/lights.glsl; and NACRE_LIGHT_CONES with spots.
ShaderDefines withLights(ShaderDefines defines, std::span<const Light> lights);
/// The same, and those of the lights' shadow maps.
ShaderDefines withLights(ShaderDefines defines, const LitView& view);
/// One list after the other.
ShaderDefines joined(ShaderDefines first, const ShaderDefines& second);

/// Uniforms of nacre/bind/view.glsl, lights.glsl and shadows.glsl; binds shadow maps from kShadowUnit. Leave `program`
/// in use.
void setView(const Program& program, const Camera& camera, const RenderTarget& target);
void setView(const Program& program, const Camera& camera, double aspect);  ///< width / height
/// A virtual viewpoint: the rest is for programs with NACRE_VIEW. \param share  of a surface's light that isn't
/// specular
void setView(const Program& program, const SpecularView& view, const ViewLight& light = {}, double share = 1);
void setLights(const Program& program, const LitView& view);

/// Texture units after a BRDF's, three maps and a table of a surrounding, and a relief's.
inline constexpr int kShadowUnit = 13;

/// Uniforms of nacre/bind/light_levels.glsl: an array texture, at kShadowUnit, as there are no maps beside it. Leaves
/// `program` in use.
void bindLightLevels(const Program& program, GlName texture);

/// Uniforms of nacre/bind/model.glsl. Leaves `program` in use. \throws std::invalid_argument unless toWorld is finite
void setModel(const Program& program, const glm::dmat4& toWorld);

/// Binds the target; depth test and depth write on, face culling and blending off.
void setDrawState(const RenderTarget& target);

/// Fill: setDrawState. AddLight: what has the depth that stands in the target already is added to its colour, alpha and
/// depth stay (MPR section 7.2); the same vertex shader must have drawn it.
enum class DrawMode { Fill, AddLight };

/// Draws in that state, and leaves it so. radiance: of GpuMesh::draw. Front
/// faces are those seen from outside, mirrored or not; afterwards counter-clockwise ones again.
void drawMesh(const Program& program, const RenderTarget& target, const GpuMesh& mesh,
              const glm::dmat4& toWorld = glm::dmat4(1), DrawMode mode = DrawMode::Fill,
              const Buffer* radiance = nullptr);

/// The same in the state that is. \param mirroredView  outlines turn the other way
void drawPlaced(const Program& program, const GpuMesh& mesh, const glm::dmat4& toWorld, bool mirroredView = false,
                const Buffer* radiance = nullptr);
/// The state of DrawMode::AddLight, from that of setDrawState, which ends it. \param weighted  times destination alpha
void setAddLight(bool weighted = false);

}  // namespace nacre
