// Light that mirrors and panes send on, beside rays (MPR sections 4.2 and 4.3, PR94 figure 2).
#include <fmt/format.h>

#include "demos/exhibit_task.hpp"
#include "reference/scene_trace.hpp"
#include "shading/scene_file.hpp"
#include "shading/scene_renderer.hpp"

namespace nacre {
namespace {

SceneSwitches lightDepth(int depth, ShadowMethod method = ShadowMethod::Volumes) {
    SceneSwitches out;
    out.shadowMethod = method;
    out.specular.lightDepth = depth;
    return out;
}

/// One scene's renderer, drawn as panels against rays over as many faces as `truthDepth` says.
class LitPanels {
public:
    LitPanels(const Task& task, const char* file, int size)
        : task_(task),
          builder(task.loader, task.id, task.builder()),
          renderer_(task.loader, readScene(task.options.sceneFolder / file)),
          size_(size) {}

    Image truth(int depth) const {
        report(task_.options.progress, task_.id + ": reference", 0);
        SceneTraceOptions options{.width = size_, .height = size_, .supersample = kSupersample};
        options.lightDepth = depth;
        const SceneDescription& scene = renderer_.scene();
        return traceScene(scene, scene.camera, openTruths(scene), {{}}, options).front();
    }
    void panel(const std::string& label, const SceneSwitches& on, const Image& truth) {
        Image whole(size_, size_, 1);
        for (float& v : whole.data()) v = 1;
        builder.panel(label,
                      [this, on](const RenderTarget& target) {
                          renderer_.switches = on;
                          renderer_.render(target);
                      },
                      {truth, whole});
    }
    /// "2 lights in 5 views, 31 volumes of 12 kB"
    std::string counts() const {
        const ShadowVolumeCounts volumes = renderer_.shadowVolumes();
        return fmt::format("{} lights in {} views, {} stored volumes of {:.0f} kB", renderer_.schedule().lights.size(),
                           renderer_.schedule().views.size(), volumes.made + volumes.kept,
                           static_cast<double>(volumes.bytes) / 1e3);
    }

private:
    const Task& task_;

public:
    ExhibitBuilder builder;

private:
    SceneRenderer renderer_;
    int size_;
};

Exhibit byMirror(const Task& task) {
    LitPanels panels(task, "lit-by-mirror.json", task.size(400));
    const Image full = panels.truth(1);
    panels.builder.row("Against rays from the lamp, directly and by way of the mirror");
    panels.panel("no light by the mirror", lightDepth(0), full);
    panels.builder.forComparison();
    panels.panel("light volumes, shadow maps", lightDepth(1, ShadowMethod::Maps), full);
    panels.panel("light volumes, shadow volumes", lightDepth(1), full);
    Exhibit e;
    e.section = "Light by way of mirrors and glass (MPR section 4)";
    e.title = "A mirror lights the shadow of a board";
    e.caption =
        "The mirror's image of the lamp is a light of its own, added where the mirror's light volume is counted in the "
        "stencil buffer and no shadow volume is: of what stands before the mirror, reflected, and of what stands after "
        "it. Objects that the mirror's plane goes through are cut by it. The same passes are drawn in the mirror's "
        "view. The reference finds the same paths by rays. " +
        panels.counts() + " with shadow volumes.";
    e.scene = "Lambert walls, a board, a ring and a ball; a mirror of 93 %; a spot light, which shines at it.";
    e.commands = {
        "nacre render demos/scenes/lit-by-mirror.json -o lit.png --shadows volumes --light-paths 1 --reference",
        "nacre render demos/scenes/lit-by-mirror.json --shadows volumes --light-paths 1 --passes"};
    panels.builder.finish(e);
    return e;
}

Exhibit regions(const Task& task) {
    LitPanels panels(task, "light-regions.json", task.size(400));
    const Image full = panels.truth(1);
    panels.builder.row("Against rays from the sun, directly and through the pane");
    panels.panel("no light through the pane", lightDepth(0), full);
    panels.builder.forComparison();
    panels.panel("with its light volume", lightDepth(1), full);
    Exhibit e;
    e.section = "Light by way of mirrors and glass (MPR section 4)";
    e.title = "The eight regions of a refracting surface's light";
    e.caption =
        "A floor seen from above, under a pane of index 2 (a change of medium, as in PR94), a cube above the pane and "
        "a "
        "ball below it, in a sun from the left at 45 degrees. From left to right: primary light; primary and refracted "
        "light; refracted light alone, in the pane's shadow; the pane's shadow. The cube's refracted shadow leaves "
        "primary light and nothing, and meets the ball's. PR94's eight: 1 primary light; 2 primary and refracted; 3 "
        "the cube's refracted shadow in primary light; 4 the same "
        "without; 5 where it meets the ball's shadow; 6 the ball's alone; 7 refracted light; 8 the pane's shadow. The "
        "camera is below pane, cube and ball, which aren't seen. Each region's light is known in closed form, and "
        "tested to "
        "1 %.";
    e.scene = "A matt floor of 80 %; the pane transmits by Fresnel, flux is kept.";
    e.commands = {
        "nacre render demos/scenes/light-regions.json -o regions.png --shadows volumes --light-paths 1 "
        "--reference"};
    panels.builder.finish(e);
    return e;
}

Exhibit bevelledGlass(const Task& task) {
    LitPanels panels(task, "bevelled-glass.json", task.size(400));
    const Image truth = panels.truth(2);
    panels.builder.row("Two bevelled panes in a door");
    panels.panel("no light through the panes", lightDepth(0), truth);
    panels.builder.forComparison();
    panels.panel("over two faces", lightDepth(2), truth);
    Exhibit e;
    e.section = "Light by way of mirrors and glass (MPR section 4)";
    e.title = "A bevelled glass door in the sun (MPR figure 10)";
    e.caption =
        "The paper projects a picture of a bevelled door; here the bevels are faces of their own, each with its own "
        "angle: the sun comes in by the back of a pane and leaves by its middle or by one of four bevels, five virtual "
        "suns a pane, whose beams overlap and part in the shadow of frame and handle. Exact for parallel light. " +
        panels.counts() + ".";
    e.scene = "Two panes of six faces, index 1.5, nothing reflected before the critical angle; walls, a door, a ring.";
    e.commands = {
        "nacre render demos/scenes/bevelled-glass.json -o bevelled.png --shadows volumes --light-paths 2 --reference"};
    panels.builder.finish(e);
    return e;
}

Exhibit stainedGlass(const Task& task) {
    LitPanels stained(task, "stained-glass.json", task.size(400));
    const Image coloured = stained.truth(1);
    stained.builder.row("Stained glass: the light volume times the picture");
    stained.panel("no light through the glass", lightDepth(0), coloured);
    stained.builder.forComparison();
    stained.panel("projected", lightDepth(1), coloured);
    Exhibit e;
    e.section = "Light by way of mirrors and glass (MPR section 4)";
    e.title = "Stained glass (MPR section 4.5, figures 8 and 9)";
    e.caption =
        "Light that the glass sends on is coloured by the texel through which it came: each place's point of the "
        "glass, from the lamp, by the map of quadrilateral to rectangle, so that neither glass nor wall need to be "
        "aligned with an axis. What is seen through the glass is coloured by the same map from the eye. " +
        stained.counts() + ".";
    e.scene =
        "A leaning screen of leaded glass, a picture of 40 x 56 letters in the scene's file; a spot light behind.";
    e.commands = {
        "nacre render demos/scenes/stained-glass.json -o stained.png --shadows volumes --light-paths 1 --reference"};
    stained.builder.finish(e);
    return e;
}

}  // namespace

const std::vector<NamedExhibit>& lightPathExhibits() {
    static const std::vector<NamedExhibit> all = {{"light-by-mirror", byMirror},
                                                  {"light-regions", regions},
                                                  {"stained-glass", stainedGlass},
                                                  {"bevelled-glass", bevelledGlass},
                                                  {"multipass-tables", multipassTables}};
    return all;
}

}  // namespace nacre
