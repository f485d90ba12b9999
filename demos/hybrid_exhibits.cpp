// Hybrid rendering: the stages of a picture and virtual lights by number (HYBRID sections 3 and 4.3, figures 8 and 10).
#include <fmt/format.h>

#include "demos/exhibit_task.hpp"
#include "demos/hybrid_parts.hpp"
#include "demos/picture.hpp"
#include "reference/albedo.hpp"
#include "reference/scene_components.hpp"
#include "shading/scene_file.hpp"

namespace nacre {

HybridMaterials materialsOf(const SceneTruths& truths) {
    HybridMaterials out;
    for (const MaterialTruth& m : truths.materials) {
        out.brdfs.push_back(m.brdf);
        out.albedos.push_back(m.brdf ? directionalAlbedo(m.brdf, {std::sqrt(0.5), 0, std::sqrt(0.5)}) : Rgb(0));
    }
    return out;
}

namespace {

/// A scene drawn in stages beside its traced stages.
class Study {
public:
    Study(const Task& task, const char* file, int size)
        : scene_(readScene(task.options.sceneFolder / file)),
          truths_(openTruths(scene_)),
          renderer_(task.loader, scene_, materialsOf(truths_)),
          size_(size) {
        renderer_.direct().switches.shadowMethod = ShadowMethod::Volumes;
    }

    SceneComponents truth(int lightPoints, int paths, const Progress& progress) const {
        SceneTraceOptions options{.width = size_, .height = size_, .supersample = kSupersample};
        options.lightPoints = lightPoints;
        options.lightDepth = 0;  // as it is drawn
        options.interreflectionPaths = paths;
        options.progress = progress;
        return traceComponents(scene_, scene_.camera, truths_, options);
    }

    HybridPicture draw(const HybridOptions& options) {
        HybridPicture out = renderer_.draw(kSupersample * size_, kSupersample * size_, options);
        for (Image* image : {&out.direct, &out.indirect, &out.traced, &out.blended}) *image = halved(*image);
        return out;
    }
    const HybridReport& report() const { return renderer_.report(); }

private:
    SceneDescription scene_;
    SceneTruths truths_;
    HybridRenderer renderer_;
    int size_;
};

VirtualLightOptions lights(int count, bool shadows, VirtualLightChoice choice = VirtualLightChoice::Grouped) {
    VirtualLightOptions out;
    out.count = count;
    out.shadows = shadows;
    out.choice = choice;
    if (choice == VirtualLightChoice::Strongest) out.elements.least = 512;  // large enough to matter one by one
    return out;
}

double seconds(const HybridReport& report) {
    double all = 0;
    for (const PassTime& stage : report.stages) all += stage.wallSeconds;
    return all;
}

Exhibit stages(const Task& task) {
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    Study study(task, "glass-sphere.json", task.size(320));
    HybridOptions options;
    options.virtualLights = lights(256, true);
    options.traced = true;
    study.draw(options);  // compiles
    HybridPicture drawn = study.draw(options);
    const HybridReport report = study.report();
    SceneComponents truth = study.truth(8, 32, task.options.progress);
    Exhibit e;
    builder.row("Stages, each beside the same stage by rays");
    builder.compared("direct light, shadows by volumes", std::move(drawn.direct), std::move(truth.direct));
    ShadowStage shadow =
        shadowStage(task.loader, withoutSpecular(readScene(task.options.sceneFolder / "glass-sphere.json")),
                    task.size(320), task.size(320));
    builder.compared("shadow: share of the lamp that is seen", std::move(shadow.drawn), std::move(shadow.truth));
    builder.compared("indirect light by 256 virtual lights", std::move(drawn.indirect), std::move(truth.indirect));
    builder.compared("traced: mirror and glass", std::move(drawn.traced), std::move(truth.traced));
    builder.row("Their sum");
    builder.compared("blended", std::move(drawn.blended), std::move(truth.blended), 1000 * seconds(report));
    e.table.head = {"stage", "seconds"};
    for (const PassTime& stage : report.stages)
        e.table.rows.push_back({stage.name, fmt::format("{:.3f}", stage.wallSeconds)});
    e.section = "Hybrid rendering";
    e.title = "A picture in stages: pipeline and processor side by side";
    e.caption = fmt::format(
        "HYBRID figure 10. An item buffer from the eye tags {} pixels of mirror and glass, whose rays the processor "
        "follows while the pipeline draws the rest; {:.0f} % of their ends take light that the picture has already. "
        "Light that surfaces reflect once comes from {} virtual lights with shadow maps. All panels have one exposure, "
        "so a lamp seen in full, 1, is grey. Pixels on "
        "the very edge where two walls meet tie with the sides of the walls' own shadow volumes: the dashes there are "
        "wrong.",
        report.traced.pixels, 100 * report.traced.reused, report.lights);
    e.scene = "demos/scenes/glass-sphere.json; square lamp of 16 points.";
    e.commands = {
        "nacre render demos/scenes/glass-sphere.json -o box.png --shadows volumes --indirect virtual-lights "
        "--virtual-lights 256 --virtual-shadows --specular traced --stages --reference"};
    builder.finish(e);
    return e;
}

Exhibit virtualLights(const Task& task) {
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    Study study(task, "cornell-box.json", task.size(240));
    const Image truth = study.truth(2, 64, task.options.progress).indirect;
    Exhibit e;
    e.table.head = {"lights", "choice", "shadow maps", "power left out", "clamped", "time"};
    const auto add = [&](const VirtualLightOptions& options) {
        const bool strongest = options.choice == VirtualLightChoice::Strongest;
        HybridOptions hybrid;
        hybrid.virtualLights = options;
        Image drawn = study.draw(hybrid).indirect;
        const HybridReport& r = study.report();
        builder.compared(fmt::format("{} lights, {}", options.count, options.shadows ? "shadow maps" : "no visibility"),
                         std::move(drawn), truth, 1000 * seconds(r));
        if (options.count < VirtualLightOptions().count) builder.forComparison();
        e.table.rows.push_back({std::to_string(r.lights), strongest ? "strongest" : "groups",
                                options.shadows ? "yes" : "no", fmt::format("{:.1f} %", 100 * r.leftOut),
                                fmt::format("{:.1f} %", 100 * r.clamped), fmt::format("{:.2f} s", seconds(r))});
    };
    builder.row("Groups of elements, with shadow maps");
    for (const int count : {16, 64, 256}) add(lights(count, true));
    builder.row("The same without visibility: light leaks under the block and the ball (HYBRID figure 8)", false);
    for (const int count : {16, 64, 256}) add(lights(count, false));
    builder.row("The paper's choice: the strongest elements alone", false);
    for (const int count : {16, 64, 256}) add(lights(count, false, VirtualLightChoice::Strongest));
    e.section = "Hybrid rendering";
    e.title = "One bounce of light by virtual lights";
    e.caption =
        "Item buffers from the lamp give each surface element the power it reflects (HYBRID section 3). The paper "
        "makes the strongest elements point lights and leaves the rest out; here groups of elements keep all power. "
        "Near by a light is the rectangle it stands for, without singularity; the table's \"clamped\" is what that "
        "takes of a point's light.";
    e.scene = "demos/scenes/cornell-box.json, indirect light alone.";
    e.commands = {
        "nacre render demos/scenes/cornell-box.json -o box.png --indirect virtual-lights --virtual-lights 256 "
        "--virtual-shadows --stages --reference"};
    builder.finish(e);
    return e;
}

}  // namespace

const std::vector<NamedExhibit>& hybridExhibits() {
    static const std::vector<NamedExhibit> kExhibits = {{"hybrid-stages", stages},
                                                        {"virtual-lights", virtualLights},
                                                        {"counted-shadows", countedShadowsExhibit},
                                                        {"counted-soft-shadows", softCountedExhibit},
                                                        {"rooms", roomsExhibit},
                                                        {"pipes", pipesExhibit}};
    return kExhibits;
}

}  // namespace nacre
