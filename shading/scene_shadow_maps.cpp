#include "shading/scene_shadow_maps.hpp"

#include <algorithm>

namespace nacre {
namespace {

bool sameShadow(const SceneShadow& a, const SceneShadow& b) {
    return a.size == b.size && a.bits == b.bits && a.filter == b.filter && a.faces == b.faces && a.bias == b.bias &&
           a.near == b.near && a.far == b.far && a.cascades == b.cascades && a.dualParaboloid == b.dualParaboloid;
}

bool sameCasters(const std::vector<ShadowCaster>& a, const std::vector<ShadowCaster>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const ShadowCaster& x, const ShadowCaster& y) {
        return x.mesh == y.mesh && x.toWorld == y.toWorld;
    });
}

bool sameVolumes(const std::vector<VolumeSurface>& a, const std::vector<VolumeSurface>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const VolumeSurface& x, const VolumeSurface& y) {
        return x.volume == y.volume && x.toWorld == y.toWorld && x.iso == y.iso && x.step == y.step &&
               x.method == y.method;
    });
}

}  // namespace

bool sameLight(const Light& a, const Light& b) {
    const bool cones =
        a.cone.has_value() == b.cone.has_value() &&
        (!a.cone || (a.cone->axis == b.cone->axis && a.cone->inner == b.cone->inner && a.cone->outer == b.cone->outer));
    return a.directional == b.directional && a.position == b.position && a.color == b.color && cones;
}

void SceneShadowMaps::update(ProgramLoader& loader, const std::vector<SceneLight>& sceneLights,
                             const std::vector<Light>& lights, const ShadowScene& drawn) {
    kept_.resize(lights.size());
    if (drawn.bounds.empty()) return;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        Kept& kept = kept_[i];
        const std::optional<SceneShadow>& options = sceneLights[i].shadow;
        if (!options) {
            kept.map.reset();
            continue;
        }
        const bool cascades = lights[i].directional && options->cascades > 1;
        const glm::dmat4 view =
            cascades ? drawn.camera->projection(drawn.aspect) * drawn.camera->view() : glm::dmat4(0);
        if (kept.map && sameShadow(kept.map->options(), *options) && sameLight(kept.light, lights[i]) &&
            kept.bounds.low == drawn.bounds.low && kept.bounds.high == drawn.bounds.high && kept.camera == view &&
            sameCasters(kept.casters, drawn.casters) && sameVolumes(kept.volumes, drawn.volumes))
            continue;
        if (!kept.map || !sameShadow(kept.map->options(), *options)) kept.map.emplace(*options);
        kept.map->update(loader, lights[i], drawn);
        kept.light = lights[i];
        kept.casters = drawn.casters;
        kept.volumes = drawn.volumes;
        kept.bounds = drawn.bounds;
        kept.camera = view;
    }
}

std::vector<const ShadowMap*> SceneShadowMaps::maps() const {
    std::vector<const ShadowMap*> out;
    bool any = false;
    for (const Kept& kept : kept_) {
        out.push_back(kept.map && kept.map->drawn() ? &*kept.map : nullptr);
        any = any || out.back() != nullptr;
    }
    return any ? out : std::vector<const ShadowMap*>();
}

}  // namespace nacre
