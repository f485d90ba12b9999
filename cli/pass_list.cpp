#include "cli/pass_list.hpp"

#include <nlohmann/json.hpp>

#include "shading/multipass/pass_schedule.hpp"
#include "shading/scene_bounds.hpp"

namespace nacre::cli {

using nlohmann::json;

static json passesJson(const PassSchedule& schedule) {
    json out = {{"views", schedule.views.size()},
                {"levels", schedule.deepest},
                {"views_left_out", schedule.unseen},
                {"passes", json::array()}};
    for (const Pass& p : schedule.passes)
        out["passes"].push_back({{"kind", toString(p.kind)},
                                 {"view", p.view},
                                 {"face", p.face},
                                 {"stencil", p.stencil},
                                 {"scissor", {p.scissor.x, p.scissor.y, p.scissor.width, p.scissor.height}}});
    return out;
}

std::string passList(const SceneDescription& scene, const SceneShot& shot, const SpecularOptions& options,
                     bool asJson) {
    checkSpecular(scene);
    const SceneBounds box = boundsAt(scene, shot.time);
    const int n = shot.samples;
    const PassSchedule schedule =
        makeSchedule(specularFaces(scene, nodeTransforms(scene, shot.time)),
                     {scene.camera, n * shot.width, n * shot.height, box.low, box.high}, options);
    if (asJson) return passesJson(schedule).dump(2) + "\n";
    std::vector<std::string> names;
    for (const SceneNode& node : scene.nodes) names.push_back(node.name);
    return passListText(schedule, names);
}

}  // namespace nacre::cli
