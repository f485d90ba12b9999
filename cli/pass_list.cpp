#include "cli/pass_list.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "shading/multipass/light_schedule.hpp"
#include "shading/multipass/pass_text.hpp"
#include "shading/scene_bounds.hpp"

namespace nacre::cli {

using nlohmann::json;

static json passesJson(const PassSchedule& schedule, const std::vector<std::string>& names,
                       const std::vector<std::string>& lights) {
    json out = {{"views", schedule.views.size()},
                {"levels", schedule.deepest},
                {"views_left_out", schedule.unseen},
                {"lights", json::array()},
                {"passes", json::array()}};
    for (std::size_t i = 0; i < schedule.lights.size(); ++i)
        out["lights"].push_back(lightText(schedule, static_cast<int>(i), names, lights));
    for (const Pass& p : schedule.passes)
        out["passes"].push_back({{"kind", toString(p.kind)},
                                 {"view", p.view},
                                 {"face", p.face},
                                 {"light", p.light},
                                 {"stencil", p.stencil},
                                 {"scissor", {p.scissor.x, p.scissor.y, p.scissor.width, p.scissor.height}}});
    return out;
}

json lightCountsJson(const PassSchedule& schedule) {
    const auto isImage = [](const ScheduledLight& light) { return light.image.has_value(); };
    const auto adds = [](const Pass& pass) { return pass.kind == PassKind::Light; };
    return {{"images", std::count_if(schedule.lights.begin(), schedule.lights.end(), isImage)},
            {"passes", std::count_if(schedule.passes.begin(), schedule.passes.end(), adds)}};
}

std::string passList(const SceneDescription& scene, const SceneShot& shot, const SceneSwitches& on, bool asJson) {
    checkSpecular(scene);
    const SceneBounds box = boundsAt(scene, shot.time);
    const int n = shot.samples;
    const std::vector<glm::dmat4> nodes = nodeTransforms(scene, shot.time);
    std::vector<SpecularFace> faces = specularFaces(scene, nodes);
    ScheduleInput input{scene.camera, n * shot.width, n * shot.height, box.low, box.high, {}};
    input.lights = scheduledLights(scene, on, shadowedLamps(scene, on, nodes, lightsInWorld(scene, nodes)), faces);
    const PassSchedule schedule = makeSchedule(std::move(faces), input, on.specular);
    std::vector<std::string> names, lights;
    for (const SceneNode& node : scene.nodes) names.push_back(node.name);
    for (const SceneLight& light : scene.lights) lights.push_back(light.name);
    if (asJson) return passesJson(schedule, names, lights).dump(2) + "\n";
    return passListText(schedule, names, lights);
}

}  // namespace nacre::cli
