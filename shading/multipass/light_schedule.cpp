#include "shading/multipass/light_schedule.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "core/light_area.hpp"
#include "shading/multipass/shadow_volume.hpp"

namespace nacre {
namespace {

/// Whether some of the way is what a refracting face reflects by Fresnel.
bool isWeak(const VirtualLight& image, const std::vector<SpecularFace>& faces) {
    return std::any_of(image.bounces.begin(), image.bounces.end(), [&](const LightBounce& b) {
        const SceneSpecular& s = faces[static_cast<std::size_t>(b.face)].specular;
        return b.how == Bounce::Reflected && s.ior && s.partial;
    });
}

bool castsByPasses(const SceneSwitches& on) {
    return on.shadows && on.lamps && on.reflectance != SceneReflectance::FastPhong;
}

}  // namespace

bool countsShadows(const SceneSwitches& on) { return castsByPasses(on) && on.shadowMethod == ShadowMethod::Volumes; }

std::vector<ShadowedLamp> shadowedLamps(const SceneDescription& scene, const SceneSwitches& on,
                                        const std::vector<glm::dmat4>& nodes, const std::vector<Light>& lights) {
    if (!castsByPasses(on) || (!countsShadows(on) && on.specular.lightDepth == 0)) return {};
    require(on.lightPoints >= 1 && on.lightPoints <= 63, "scene: expected 1 to 63 points of a light's area");
    const std::vector<std::optional<LightArea>> areas = areasInWorld(scene, nodes);
    std::vector<ShadowedLamp> out;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (!scene.lights[i].shadow) continue;
        ShadowedLamp lamp{i, lights[i], {lights[i]}};
        if (areas[i] && countsShadows(on)) lamp.points = pointsOfArea(lights[i], *areas[i], on.lightPoints);
        out.push_back(std::move(lamp));
    }
    return out;
}

void keepShare(std::vector<ShadowedLamp>& lamps, const SceneSwitches& on) {
    const bool whole = on.softShadows == SoftShadows::Levels;
    std::size_t index = 0;
    for (ShadowedLamp& lamp : lamps) {
        std::vector<Light> kept;
        if (whole && on.share.takes(index++)) kept = lamp.points;
        for (std::size_t k = 0; !whole && k < lamp.points.size(); ++k)
            if (on.share.takes(index++)) kept.push_back(lamp.points[k]);
        lamp.points = std::move(kept);
    }
    std::erase_if(lamps, [](const ShadowedLamp& lamp) { return lamp.points.empty(); });
}

std::vector<ScheduledLight> scheduledLights(const SceneDescription& scene, const SceneSwitches& on,
                                            const std::vector<ShadowedLamp>& lamps,
                                            const std::vector<SpecularFace>& faces) {
    std::vector<ScheduledLight> out;
    const std::vector<bool> sending = sendingFaces(scene, faces);
    for (const ShadowedLamp& lamp : lamps) {
        if (countsShadows(on)) out.push_back({lamp.light, {}, lamp.points.size()});
        for (std::size_t k = 0; k < lamp.points.size(); ++k)
            for (VirtualLight& image : virtualLights(faces, sending, lamp.points[k], on.specular)) {
                if (!on.specular.partial && isWeak(image, faces)) continue;
                image.light = lamp.light;
                image.point = k;
                out.push_back({lamp.light, std::move(image), lamp.points.size()});
                if (out.size() > on.specular.most)
                    throw Error(fmt::format("light paths: expected at most {}, found more", on.specular.most));
            }
    }
    if (out.empty() && !countsShadows(on)) return out;
    for (const SceneNode& node : scene.nodes)
        if (node.volume >= 0)
            throw Error(fmt::format("shadow volumes: expected meshes alone, found a volume at node '{}'", node.name));
    return out;
}

ShadowSource sourceOf(const ShadowedLamp& lamp, std::size_t point) {
    return {homogeneous(lamp.points[point]), {static_cast<int>(lamp.light), static_cast<int>(point)}};
}

ShadowSource sourceOf(const VirtualLight& image, std::size_t stage, const std::vector<SpecularFace>& faces) {
    const LightStage& at = image.stages.at(stage);
    ShadowSource out{at.source, {static_cast<int>(image.light), static_cast<int>(image.point)}, at.toLast, at.within};
    for (std::size_t i = 0; i < stage; ++i)
        out.name.insert(out.name.end(), {image.bounces[i].face, static_cast<int>(image.bounces[i].how), image.shear});
    for (const int face : at.planeFaces) out.faces.push_back(faces[static_cast<std::size_t>(face)].node);
    return out;
}

}  // namespace nacre
