#include "shading/environment_pass.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "core/error.hpp"
#include "shading/context.hpp"
#include "shading/draw.hpp"
#include "shading/pass_state.hpp"

namespace nacre {
namespace {

/// Texture units after a factored BRDF's.
constexpr int kFirstUnit = kMaxFactoredTextures;
constexpr int kReliefUnit = kFirstUnit + 4;  // after three maps and a table

struct Role {
    const char *define, *name;
    const EnvironmentLookup* lookup;
};

std::array<Role, 3> rolesOf(const EnvironmentSurface& s) {
    return {{{"NACRE_ENV_REFLECTION", "reflection", &s.reflection},
             {"NACRE_ENV_TRANSMISSION", "transmission", &s.transmission},
             {"NACRE_ENV_DIFFUSE", "diffuse", &s.diffuse}}};
}

const char* weightName(const EnvironmentSurface& s) {
    if (s.table == nullptr) return "NACRE_ENV_ONE";
    if (s.table->isFresnel()) return "NACRE_ENV_FRESNEL";
    return s.multipleScattering ? "NACRE_ENV_SCALE_BIAS_MULTIPLE" : "NACRE_ENV_SCALE_BIAS";
}

void check(const EnvironmentSurface& s) {
    const GpuEnvironment* first = nullptr;
    for (const Role& role : rolesOf(s)) {
        if (role.lookup->map == nullptr) continue;
        require(std::isfinite(role.lookup->lod),
                fmt::format("environment pass: the lod of {} is not finite", role.name));
        if (first == nullptr) first = role.lookup->map;
        require(role.lookup->map->layout() == first->layout(),
                fmt::format("environment pass: the maps must have one layout, found {} and {}",
                            toString(first->layout()), toString(role.lookup->map->layout())));
    }
    require(std::isfinite(s.ior) && s.ior > 0, "environment pass: ior must be finite, > 0");
}

ShaderDefines definesOf(const EnvironmentSurface& s) {
    ShaderDefines out;
    for (const Role& role : rolesOf(s)) {
        if (role.lookup->map == nullptr) continue;
        if (out.empty()) out = role.lookup->map->defines();
        out.emplace_back(role.define, "1");
    }
    out.emplace_back("NACRE_ENV_WEIGHT", weightName(s));
    out.emplace_back("NACRE_ENV_COMBINE", s.combine == EnvironmentCombine::Add ? "NACRE_ENV_ADD" : "NACRE_ENV_BLEND");
    return out;
}

double clampedLod(const EnvironmentLookup& lookup) {
    return lookup.map == nullptr ? 0 : std::clamp(lookup.lod, 0.0, lookup.map->levels() - 1.0);
}

/// Maps and table have units of their own: samplers of two kinds on one unit fail the draw.
void bindSurface(const Program& program, const EnvironmentSurface& s) {
    int unit = kFirstUnit;
    for (const Role& role : rolesOf(s)) {
        const GpuEnvironment* map = role.lookup->map;
        if (map != nullptr) {
            map->bind(unit);
            program.set(fmt::format("nacre_env_{}_{}", role.name, map->samplerKind()), unit);
        }
        program.set(fmt::format("nacre_env_{}_color", role.name),
                    glm::vec3(role.lookup->color * (map != nullptr ? map->scale() : 1.0)));
        ++unit;
    }
    if (s.table != nullptr) s.table->bind(program, unit);
    program.set("nacre_env_lod",
                glm::vec3(clampedLod(s.reflection), clampedLod(s.transmission), clampedLod(s.diffuse)));
    program.set("nacre_env_ior", static_cast<float>(s.ior));
    program.set("nacre_env_f0", glm::vec3(s.f0));
    program.set("nacre_env_perceptual_roughness", static_cast<float>(s.perceptualRoughness));
    program.set("nacre_env_from_world", glm::mat3(s.fromWorld));
}

template <class Brdf>
void renderLit(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const LitView& view,
               const Brdf& brdf, const EnvironmentSurface& surface, const BumpSurface& relief) {
    check(surface);
    checkLights(view.lights, kMaxLights);
    const ShaderDefines defines =
        joined(joined(withLights(brdf.defines(), view), definesOf(surface)), bumpDefines(relief));
    const Program& program = loader.load("lit.vert.glsl", "lit_environment.frag.glsl", defines);
    brdf.bind(program);
    bindSurface(program, surface);
    bindBump(program, relief, kReliefUnit);
    setView(program, view.camera, target);
    setLights(program, view);
    drawMesh(program, target, mesh, view.toWorld);
}

}  // namespace

void renderEnvironment(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const Camera& camera,
                       const EnvironmentSurface& surface, const BumpSurface& relief, const glm::dmat4& toWorld) {
    check(surface);
    const Program& program =
        loader.load("lit.vert.glsl", "environment.frag.glsl", joined(definesOf(surface), bumpDefines(relief)));
    bindSurface(program, surface);
    bindBump(program, relief, kReliefUnit);
    setView(program, camera, target);
    drawMesh(program, target, mesh, toWorld);
}

void renderFactored(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const LitView& view,
                    const GpuFactoredBrdf& brdf, const EnvironmentSurface& surface, const BumpSurface& relief) {
    renderLit(loader, target, mesh, view, brdf, surface, relief);
}

void renderDirect(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const LitView& view,
                  const GpuDirectBrdf& brdf, const EnvironmentSurface& surface, const BumpSurface& relief) {
    renderLit(loader, target, mesh, view, brdf, surface, relief);
}

void renderSky(ProgramLoader& loader, const RenderTarget& target, const Camera& camera, const EnvironmentLookup& sky,
               const Mat3& fromWorld) {
    require(sky.map != nullptr, "renderSky: no map");
    EnvironmentSurface surface;
    surface.reflection = sky;
    surface.fromWorld = fromWorld;
    check(surface);
    const Program& program = loader.load("sky.vert.glsl", "sky.frag.glsl", definesOf(surface));
    bindSurface(program, surface);
    const double aspect = static_cast<double>(target.width()) / target.height();
    program.set("nacre_clip_to_world", glm::mat4(glm::inverse(camera.projection(aspect) * camera.view())));
    target.bind();
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_FALSE);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    program.use();
    drawFullscreen(VertexArray());
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    checkGl("drawing the surrounding");
}

}  // namespace nacre
