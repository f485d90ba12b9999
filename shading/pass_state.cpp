#include "shading/pass_state.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/error.hpp"
#include "shading/context.hpp"
#include "shading/gpu_bump.hpp"
#include "shading/shadow_map.hpp"

namespace nacre {

static_assert(kShadowUnit == kMaxFactoredTextures + 4 + kBumpUnits);

Vec3 orthographicDirection(const Camera& camera) { return glm::normalize(camera.eye - camera.target); }

void checkLights(std::span<const Light> lights, int most) {
    const auto count = static_cast<int>(lights.size());
    require(count <= most, fmt::format("lit pass: at most {} lights, found {}", most, count));
    for (const Light& light : lights) {
        require(!light.directional || std::abs(glm::length(light.position) - 1) < 1e-6,
                "lit pass: the direction to a directional light must have unit length");
        checkCone(light);
    }
}

ShaderDefines withLights(ShaderDefines defines, std::span<const Light> lights) {
    defines.emplace_back("NACRE_LIGHTS", std::to_string(lights.size()));
    const auto isSpot = [](const Light& light) { return light.cone.has_value(); };
    if (std::any_of(lights.begin(), lights.end(), isSpot)) defines.emplace_back("NACRE_LIGHT_CONES", "1");
    return defines;
}

ShaderDefines withLights(ShaderDefines defines, const LitView& view) {
    return joined(withLights(std::move(defines), view.lights), shadowDefines(view.shadows, view.lights));
}

ShaderDefines joined(ShaderDefines first, const ShaderDefines& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

void setView(const Program& program, const Camera& camera, const RenderTarget& target) {
    setView(program, camera, static_cast<double>(target.width()) / target.height());
}

void setView(const Program& program, const Camera& camera, double aspect) { setView(program, viewOf(camera, aspect)); }

void setView(const Program& program, const SpecularView& view, const ViewLight& light, double share) {
    program.set("nacre_world_to_clip", glm::mat4(view.toClip));
    program.set("nacre_eye", glm::vec4(view.eye));
    program.set("nacre_view_clip", glm::vec4(view.clip.value_or(Plane(0, 0, 0, 1))));
    program.set("nacre_view_factor", glm::vec3(light.factor));
    program.set("nacre_view_share", static_cast<float>(share));
    program.set("nacre_view_fog", glm::vec4(Vec4(light.fog, light.fogDistance > 0 ? 1 / light.fogDistance : 0)));
}

static glm::vec4 coneUniform(const std::optional<SpotCone>& cone) {
    if (!cone) return {0, 0, 0, 1};
    const double edge = std::cos(cone->inner) - std::cos(cone->outer);
    return glm::vec4(Vec4(cone->axis, -std::cos(cone->outer)) / edge);
}

void setLights(const Program& program, const LitView& view) {
    std::array<glm::vec4, kMaxLights> positions{}, cones{};
    std::array<glm::vec3, kMaxLights> colors{};
    for (std::size_t i = 0; i < view.lights.size(); ++i) {
        positions[i] = glm::vec4(glm::vec3(view.lights[i].position), view.lights[i].directional ? 0.0f : 1.0f);
        colors[i] = glm::vec3(view.lights[i].color);
        cones[i] = coneUniform(view.lights[i].cone);
    }
    program.set("nacre_light_count", static_cast<int>(view.lights.size()));
    program.set("nacre_light_position", positions);
    program.set("nacre_light_color", colors);
    program.set("nacre_light_cone", cones);
    program.set("nacre_ambient", glm::vec3(view.ambient));
    bindShadows(program, view.shadows, kShadowUnit);
}

static bool mirrors(const glm::dmat4& toWorld) { return glm::determinant(glm::dmat3(toWorld)) < 0; }

void bindLightLevels(const Program& program, GlName texture) {
    glActiveTexture(GL_TEXTURE0 + kShadowUnit);
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture);
    program.set("nacre_light_levels", kShadowUnit);
}

void setModel(const Program& program, const glm::dmat4& toWorld) {
    const glm::dmat3 m(toWorld);
    for (int i = 0; i < 4; ++i) require(isFinite(Vec3(toWorld[i])), "drawing a mesh: its matrix must be finite");
    // Cofactors: the inverse transpose times the determinant, and defined for matrices that flatten.
    glm::dmat3 normals(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    double largest = 0;
    for (int i = 0; i < 3; ++i) largest = std::max(largest, maxComponent(glm::abs(normals[i])));
    if (largest > 0) normals /= mirrors(toWorld) ? -largest : largest;
    program.set("nacre_mesh_to_world", glm::mat4(toWorld));
    program.set("nacre_mesh_normal_to_world", glm::mat3(normals));
    program.set("nacre_mesh_handedness", mirrors(toWorld) ? -1.0f : 1.0f);
}

void setDrawState(const RenderTarget& target) {
    target.bind();
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
}

void setAddLight(bool weighted) {
    glDepthFunc(GL_EQUAL);
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFuncSeparate(weighted ? GL_DST_ALPHA : GL_ONE, GL_ONE, GL_ZERO, GL_ONE);
}

void drawMesh(const Program& program, const RenderTarget& target, const GpuMesh& mesh, const glm::dmat4& toWorld,
              DrawMode mode, const Buffer* radiance) {
    setDrawState(target);
    if (mode == DrawMode::AddLight) setAddLight();
    drawPlaced(program, mesh, toWorld, false, radiance);
    if (mode == DrawMode::AddLight) setDrawState(target);
}

void drawPlaced(const Program& program, const GpuMesh& mesh, const glm::dmat4& toWorld, bool mirroredView,
                const Buffer* radiance) {
    setModel(program, toWorld);
    glFrontFace(mirrors(toWorld) != mirroredView ? GL_CW : GL_CCW);
    program.use();
    mesh.draw(radiance);
    glFrontFace(GL_CCW);
    checkGl("drawing a mesh");
}

}  // namespace nacre
