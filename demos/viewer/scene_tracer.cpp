#include <memory>

#include "core/error.hpp"
#include "demos/viewer/reference_job.hpp"
#include "reference/scene_trace.hpp"

namespace nacre {
namespace {

struct Kept {
    int materials = -1;
    SceneTruths truths;
};

SceneParts partsOf(const SceneSwitches& on) {
    SceneParts out;
    out.lamps = on.lamps;
    out.ambient = on.ambient;
    out.shadows = on.shadows;
    out.relief = on.relief;
    out.reliefShadow = on.reliefShadow != BumpShadow::None;
    out.indirect = on.indirect;
    out.surrounding = on.surrounding;
    out.sky = on.sky;
    return out;
}

}  // namespace

ReferenceTracer sceneTracer(unsigned threads) {
    const auto kept = std::make_shared<Kept>();
    return [=](const ReferenceView& view, int pass, const std::function<bool()>& stopped) {
        const Progress progress = [&](const std::string&, double) {
            if (stopped()) throw Error("stopped");
        };
        if (kept->materials != view.materials) {
            kept->materials = -1;
            kept->truths = openTruths(view.scene, threads, progress);
            kept->materials = view.materials;
        }
        SceneTraceOptions options;
        options.width = view.width;
        options.height = view.height;
        options.supersample = view.rays;
        options.time = view.time;
        options.specularDepth = view.switches.specular.depth;
        options.lightDepth = view.switches.specular.lightDepth;
        options.seed = static_cast<std::uint64_t>(pass) + 1;
        options.threads = threads;
        options.progress = progress;
        return traceScene(view.scene, view.camera, kept->truths, {partsOf(view.switches)}, options).at(0);
    };
}

}  // namespace nacre
