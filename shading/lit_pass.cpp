#include "shading/lit_pass.hpp"

#include "core/error.hpp"
#include "shading/pass_state.hpp"
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

int mostLights(Addressing addressing) {
    return addressing == Addressing::PerPixel ? kMaxLights : addressing == Addressing::PerVertex ? kMaxVertexLights : 1;
}

void checkShadows(const LitView& view, Addressing addressing) {
    require(view.shadows.empty() || addressing == Addressing::PerPixel, "shadow maps need Addressing::PerPixel");
}

void setMatrices(const Program& program, const LitView& view) {
    const Vec3 l = view.lights[0].position, v = orthographicDirection(view.camera);
    program.set("nacre_matrix_half", glm::mat4(textureMatrixHalf(l, v)));
    program.set("nacre_matrix_light_view", glm::mat4(textureMatrixLightView(l, v)));
}

bool hasForm(const GpuFactoredBrdf& brdf, const char* form) {
    return brdf.defines().front().second == std::string("NACRE_FORM_") + form;
}

template <class Brdf>
void renderRelief(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const LitView& view,
                  const Brdf& brdf, const BumpSurface& relief) {
    checkLights(view.lights, kMaxLights);
    const Stages files = stages(Addressing::PerPixel);
    const Program& program =
        loader.load(files.vertex, files.fragment, joined(withLights(brdf.defines(), view), bumpDefines(relief)));
    brdf.bind(program);
    bindBump(program, relief, kMaxFactoredTextures);
    setView(program, view.camera, target);
    setLights(program, view);
    drawMesh(program, target, mesh, view.toWorld);
}

}  // namespace

void renderFactored(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const LitView& view,
                    const GpuFactoredBrdf& brdf, Addressing addressing) {
    checkLights(view.lights, mostLights(addressing));
    checkShadows(view, addressing);
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
    setView(program, view.camera, target);
    setLights(program, view);
    if (matrices) setMatrices(program, view);
    drawMesh(program, target, mesh, view.toWorld);
}

void renderDirect(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const LitView& view,
                  const GpuDirectBrdf& brdf, Addressing addressing) {
    require(addressing != Addressing::TextureMatrix, "texture matrices address textures, not formulas");
    checkLights(view.lights, mostLights(addressing));
    checkShadows(view, addressing);
    const Stages files = stages(addressing);
    const Program& program = loader.load(files.vertex, files.fragment, withLights(brdf.defines(), view));
    brdf.bind(program);
    setView(program, view.camera, target);
    setLights(program, view);
    drawMesh(program, target, mesh, view.toWorld);
}

void renderFactored(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const LitView& view,
                    const GpuFactoredBrdf& brdf, const BumpSurface& relief) {
    renderRelief(loader, target, mesh, view, brdf, relief);
}

void renderDirect(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const LitView& view,
                  const GpuDirectBrdf& brdf, const BumpSurface& relief) {
    renderRelief(loader, target, mesh, view, brdf, relief);
}

}  // namespace nacre
