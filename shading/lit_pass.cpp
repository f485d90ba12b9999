#include "shading/lit_pass.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <array>

#include "core/error.hpp"
#include "shading/context.hpp"
#include "shading/texture_matrix.hpp"

namespace nacre {
namespace {

struct Stages {
    const char *vertex, *fragment;
};

Stages stages(Addressing addressing) {
    switch (addressing) {
        case Addressing::PerPixel:
            return {"lit.vert.glsl", "lit.frag.glsl"};
        case Addressing::PerVertex:
            return {"lit_vertex.vert.glsl", "lit_vertex.frag.glsl"};
        case Addressing::TextureMatrix:
            return {"lit_matrix.vert.glsl", "lit_matrix.frag.glsl"};
    }
    throw std::invalid_argument("unknown addressing");
}

void checkLights(const LitView& view, Addressing addressing) {
    const int most = addressing == Addressing::PerPixel    ? kMaxLights
                     : addressing == Addressing::PerVertex ? kMaxVertexLights
                                                           : 1;
    const auto count = static_cast<int>(view.lights.size());
    require(count <= most, fmt::format("lit pass: at most {} lights, found {}", most, count));
    for (const Light& light : view.lights)
        require(!light.directional || std::abs(glm::length(light.position) - 1) < 1e-6,
                "lit pass: the direction to a directional light must have unit length");
}

/// One program for each number of lights: see bind/lights.glsl.
ShaderDefines withLights(ShaderDefines defines, const LitView& view) {
    defines.emplace_back("NACRE_LIGHTS", std::to_string(view.lights.size()));
    return defines;
}

Vec3 orthographicDirection(const Camera& camera) { return glm::normalize(camera.eye - camera.target); }

void setView(const Program& program, const LitView& view, const RenderTarget& target) {
    const double aspect = static_cast<double>(target.width()) / target.height();
    program.set("nacre_world_to_clip", glm::mat4(view.camera.projection(aspect) * view.camera.view()));
    const Vec4 eye = view.camera.orthographic ? Vec4(orthographicDirection(view.camera), 0) : Vec4(view.camera.eye, 1);
    program.set("nacre_eye", glm::vec4(eye));
}

void setLights(const Program& program, const LitView& view) {
    std::array<glm::vec4, kMaxLights> positions{};
    std::array<glm::vec3, kMaxLights> colors{};
    for (std::size_t i = 0; i < view.lights.size(); ++i) {
        positions[i] = glm::vec4(glm::vec3(view.lights[i].position), view.lights[i].directional ? 0.0f : 1.0f);
        colors[i] = glm::vec3(view.lights[i].color);
    }
    program.set("nacre_light_count", static_cast<int>(view.lights.size()));
    program.set("nacre_light_position", positions);
    program.set("nacre_light_color", colors);
    program.set("nacre_ambient", glm::vec3(view.ambient));
}

void setMatrices(const Program& program, const LitView& view) {
    const Vec3 l = view.lights[0].position, v = orthographicDirection(view.camera);
    program.set("nacre_matrix_half", glm::mat4(textureMatrixHalf(l, v)));
    program.set("nacre_matrix_light_view", glm::mat4(textureMatrixLightView(l, v)));
}

void draw(const Program& program, const RenderTarget& target, const GpuMesh& mesh) {
    target.bind();
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    program.use();
    mesh.draw();
    checkGl("lit pass");
}

bool hasForm(const GpuFactoredBrdf& brdf, const char* form) {
    return brdf.defines().front().second == std::string("NACRE_FORM_") + form;
}

}  // namespace

void renderFactored(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const LitView& view,
                    const GpuFactoredBrdf& brdf, Addressing addressing) {
    checkLights(view, addressing);
    const bool matrices = addressing == Addressing::TextureMatrix;
    ShaderDefines defines = withLights(brdf.defines(), view);
    if (matrices) {
        require(hasForm(brdf, "COSINE") || hasForm(brdf, "TANGENT"),
                "texture matrices address the forms cosine and tangent only");
        require(view.camera.orthographic && view.lights.size() == 1 && view.lights[0].directional,
                "texture matrices need an orthographic camera and one directional light");
        defines.emplace_back("NACRE_TEXTURE_MATRIX", "1");
    }
    const Stages files = stages(addressing);
    const Program& program = loader.load(files.vertex, files.fragment, defines);
    brdf.bind(program);
    setView(program, view, target);
    setLights(program, view);
    if (matrices) setMatrices(program, view);
    draw(program, target, mesh);
}

void renderDirect(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const LitView& view,
                  const GpuDirectBrdf& brdf, Addressing addressing) {
    require(addressing != Addressing::TextureMatrix, "texture matrices address textures, not formulas");
    checkLights(view, addressing);
    const Stages files = stages(addressing);
    const Program& program = loader.load(files.vertex, files.fragment, withLights(brdf.defines(), view));
    brdf.bind(program);
    setView(program, view, target);
    setLights(program, view);
    draw(program, target, mesh);
}

}  // namespace nacre
