#include "shading/multipass/light_passes.hpp"

#include "core/light_area.hpp"

namespace nacre {
namespace {

void addPoints(const LitTarget& to, ShadowStencil& stencil, const SceneShadowVolumes& volumes,
               const ShadowedLamp& lamp) {
    for (std::size_t k = 0; k < lamp.points.size(); ++k) {
        const Light& point = lamp.points[k];
        stencil.begin(to.target);
        stencil.lit();
        to.draw(lamp.light, point, false);
        stencil.count(to.target, volumes.of(lamp.volumes + (lamp.stored ? k : 0)), homogeneous(point), to.sight);
        stencil.lit();
        to.draw(lamp.light, point, true);
        stencil.end(to.target);
    }
}

void addLevels(const LitTarget& to, ShadowStencil& stencil, const SceneShadowVolumes& volumes, const ShadowedLamp& lamp,
               const Light& middle) {
    stencil.begin(to.target);
    stencil.lit();
    to.draw(lamp.light, middle, false);
    for (std::size_t k = 0; k < lamp.points.size(); ++k)
        stencil.count(to.target, volumes.of(lamp.volumes + k), homogeneous(lamp.points[k]), to.sight,
                      ShadowCounting::Auto, true);
    const std::size_t count = lamp.points.size();
    for (std::size_t level = 0; level < count; ++level) {
        Light dimmed = middle;
        dimmed.color *= static_cast<double>(count - level) / static_cast<double>(count);
        stencil.lit(static_cast<unsigned>(level));
        to.draw(lamp.light, dimmed, true);
    }
    stencil.end(to.target);
}

}  // namespace

std::vector<ShadowedLamp> shadowedLamps(const SceneDescription& scene, const SceneSwitches& on,
                                        const std::vector<glm::dmat4>& nodes, const std::vector<Light>& lights,
                                        std::vector<Vec4>& sources) {
    const std::vector<std::optional<LightArea>> areas = areasInWorld(scene, nodes);
    std::vector<ShadowedLamp> out;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (!scene.lights[i].shadow) continue;
        ShadowedLamp lamp{i, {lights[i]}, sources.size(), on.softShadows != SoftShadows::Pivot};
        if (areas[i]) lamp.points = pointsOfArea(lights[i], *areas[i], on.lightPoints);
        for (const Light& point : lamp.points)
            if (lamp.stored || sources.size() == lamp.volumes) sources.push_back(homogeneous(point));
        out.push_back(std::move(lamp));
    }
    return out;
}

void addLamp(const LitTarget& to, ShadowStencil& stencil, const SceneShadowVolumes& volumes, const ShadowedLamp& lamp,
             const Light& middle, SoftShadows how) {
    if (how == SoftShadows::Levels && lamp.points.size() > 1)
        addLevels(to, stencil, volumes, lamp, middle);
    else
        addPoints(to, stencil, volumes, lamp);
}

}  // namespace nacre
