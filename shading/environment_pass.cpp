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
constexpr int kReliefUnit = kFirstUnit + kEnvironmentUnits;

struct Role {
    const char* name;
    const EnvironmentLookup* lookup;
};

std::array<Role, 3> rolesOf(const EnvironmentSurface& s) {
    return {{{"reflection", &s.reflection}, {"transmission", &s.transmission}, {"diffuse", &s.diffuse}}};
}

EnvironmentWeight weightOf(const EnvironmentSurface& s) {
    if (s.table == nullptr) return EnvironmentWeight::One;
    if (s.table->isFresnel()) return EnvironmentWeight::Fresnel;
    return s.multipleScattering ? EnvironmentWeight::ScaleBiasMultiple : EnvironmentWeight::ScaleBias;
}

const char* weightName(EnvironmentWeight weight) {
    static constexpr const char* kNames[] = {"NACRE_ENV_ONE", "NACRE_ENV_FRESNEL", "NACRE_ENV_SCALE_BIAS",
                                             "NACRE_ENV_SCALE_BIAS_MULTIPLE"};
    return kNames[static_cast<int>(weight)];
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

double clampedLod(const EnvironmentLookup& lookup) {
    return lookup.map == nullptr ? 0 : std::clamp(lookup.lod, 0.0, lookup.map->levels() - 1.0);
}

}  // namespace

ShaderDefines environmentDefines(const EnvironmentChoices& c) {
    ShaderDefines out;
    const std::pair<bool, const char*> roles[] = {{c.reflection, "NACRE_ENV_REFLECTION"},
                                                  {c.transmission, "NACRE_ENV_TRANSMISSION"},
                                                  {c.diffuse, "NACRE_ENV_DIFFUSE"}};
    for (const auto& [used, define] : roles) {
        if (!used) continue;
        if (out.empty()) out = layoutDefines(c.layout);
        out.emplace_back(define, "1");
    }
    out.emplace_back("NACRE_ENV_WEIGHT", weightName(c.weight));
    out.emplace_back("NACRE_ENV_COMBINE", c.combine == EnvironmentCombine::Add ? "NACRE_ENV_ADD" : "NACRE_ENV_BLEND");
    return out;
}

ShaderDefines environmentDefines(const EnvironmentSurface& s) {
    check(s);
    EnvironmentChoices choices{EnvLayout::Cube,
                               s.reflection.map != nullptr,
                               s.transmission.map != nullptr,
                               s.diffuse.map != nullptr,
                               weightOf(s),
                               s.combine};
    for (const Role& role : rolesOf(s))
        if (role.lookup->map != nullptr) choices.layout = role.lookup->map->layout();
    return environmentDefines(choices);
}

/// Maps and table have units of their own: samplers of two kinds on one unit fail the draw.
void bindEnvironment(const Program& program, const EnvironmentSurface& s, int firstUnit) {
    int unit = firstUnit;
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
static void renderLit(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const LitView& view,
                      const Brdf& brdf, const EnvironmentSurface& surface, const BumpSurface& relief) {
    checkLights(view.lights, kMaxLights);
    const ShaderDefines defines =
        joined(joined(withLights(brdf.defines(), view), environmentDefines(surface)), bumpDefines(relief));
    const Program& program = loader.load("lit.vert.glsl", "lit_environment.frag.glsl", defines);
    brdf.bind(program);
    bindEnvironment(program, surface, kFirstUnit);
    bindBump(program, relief, kReliefUnit);
    setView(program, view.camera, target);
    setLights(program, view);
    drawMesh(program, target, mesh, view.toWorld);
}

void renderEnvironment(ProgramLoader& loader, const RenderTarget& target, const GpuMesh& mesh, const Camera& camera,
                       const EnvironmentSurface& surface, const BumpSurface& relief, const glm::dmat4& toWorld) {
    const Program& program =
        loader.load("lit.vert.glsl", "environment.frag.glsl", joined(environmentDefines(surface), bumpDefines(relief)));
    bindEnvironment(program, surface, kFirstUnit);
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

void drawSky(ProgramLoader& loader, const SpecularView& view, const EnvironmentLookup& sky, const Mat3& fromWorld,
             const ViewLight& light, const ShaderDefines& defines) {
    require(sky.map != nullptr, "renderSky: no map");
    EnvironmentSurface surface;
    surface.reflection = sky;
    surface.fromWorld = fromWorld;
    const Program& program =
        loader.load("sky.vert.glsl", "sky.frag.glsl", joined(environmentDefines(surface), defines));
    bindEnvironment(program, surface, kFirstUnit);
    setView(program, view, light);
    program.set("nacre_clip_to_world", glm::mat4(glm::inverse(view.toClip)));
    program.use();
    drawFullscreen(VertexArray());
}

void renderSky(ProgramLoader& loader, const RenderTarget& target, const Camera& camera, const EnvironmentLookup& sky,
               const Mat3& fromWorld) {
    target.bind();
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_FALSE);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    drawSky(loader, viewOf(camera, static_cast<double>(target.width()) / target.height()), sky, fromWorld);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    checkGl("drawing the surrounding");
}

}  // namespace nacre
