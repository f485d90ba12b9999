// Shadow volumes by s-count and g-count beside depth-fail, and soft shadows from binary images (HYBRID sections 2
// and 4.1, figures 3 to 7).
#include <fmt/format.h>

#include "core/light_area.hpp"
#include "core/parallel.hpp"
#include "demos/exhibit_task.hpp"
#include "demos/picture.hpp"
#include "reference/scene_rays.hpp"
#include "reference/scene_trace.hpp"
#include "shading/hybrid/counted_shadows.hpp"
#include "shading/multipass/shadow_stencil.hpp"
#include "shading/scene_file.hpp"
#include "shading/scene_renderer.hpp"
#include "shading/timing.hpp"

namespace nacre {
namespace {

/// A scene's view, ready for shadows of its first light.
struct View {
    View(ProgramLoader& programs, SceneDescription description, int width, int height)
        : loader(programs),
          scene(std::move(description)),
          nodes(nodeTransforms(scene, 0)),
          geometry(width, height),
          shadows(programs, scene, nodes),
          renderer(programs, scene),
          target({.width = width, .height = height}) {
        std::map<int, GpuMesh> meshes;
        geometry.draw(loader, scene, nodes, std::vector<Rgb>(scene.materials.size(), Rgb(0)), meshes);
    }

    Image drawn(bool shadow, bool lamps = true, bool ambient = true) {
        SceneSwitches& on = renderer.switches;
        on.shadows = shadow, on.lamps = lamps, on.ambient = ambient;
        on.shadowMethod = ShadowMethod::Volumes;
        renderer.render(target);
        return target.read();
    }

    /// Light without shadows times what the counts leave (HYBRID 4.1), and the ambient light.
    Image counted(VolumeCapping capping) {
        const Image lamps = drawn(false, true, false);
        Image out = drawn(false, false);
        shadows.begin(geometry, scene.camera);
        shadows.add(light(), 1, {capping});
        const Image level = shadows.read();
        for (int y = 0; y < out.height(); ++y)
            for (int x = 0; x < out.width(); ++x)
                out.setRgb(x, y, out.rgb(x, y) + (1.0 - level.at(x, y, 0)) * lamps.rgb(x, y));
        return out;
    }

    Vec4 light() const { return homogeneous(lightsInWorld(scene, nodes).front()); }

    /// All of a frame's work on shadows but the picture, volumes made anew.
    void depthFail() {
        std::vector<std::unique_ptr<GpuShadowPoints>> points;
        std::vector<std::unique_ptr<GpuShadowVolume>> volumes;
        std::vector<PlacedShadowVolume> placed;
        for (const SceneNode& node : scene.nodes) {
            const auto index = static_cast<std::size_t>(&node - scene.nodes.data());
            const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)].mesh;
            auto [at, made] = shapes.try_emplace(index);
            if (made) at->second = makeShadowMesh(mesh);
            const ShadowVolume volume = makeShadowVolume(at->second, nodes[index], light());
            if (volume.empty()) continue;
            points.push_back(std::make_unique<GpuShadowPoints>(at->second));
            volumes.push_back(std::make_unique<GpuShadowVolume>(*points.back(), volume));
            placed.push_back({volumes.back().get(), nodes[index], boundsOf(mesh, nodes[index]), volume.mostLayers()});
        }
        ShadowStencil stencil(loader);
        stencil.begin(target);
        stencil.count(target, placed, light(), ShadowSight::of(scene.camera, double(target.width()) / target.height()),
                      ShadowCounting::ZFail);
        stencil.end(target);
    }

    ProgramLoader& loader;
    SceneDescription scene;
    std::vector<glm::dmat4> nodes;
    GeometryBuffer geometry;
    CountedShadows shadows;
    SceneRenderer renderer;
    RenderTarget target;
    std::map<std::size_t, ShadowMesh> shapes;
};

}  // namespace

Exhibit countedShadowsExhibit(const Task& task) {
    struct Figure {
        const char *file, *title;
    };
    static constexpr Figure kFigures[] = {
        {"3-overlapping", "Figure 3: overlapping volumes; the ring isn't convex"},
        {"4-straddling", "Figure 4: a volume straddles the view plane"},
        {"5a-light-before", "Figure 5a: the light is before the eye"},
        {"5b-light-behind", "Figure 5b: the light is behind the eye"},
        {"6-eye-between", "Figure 6: the eye is between light and occluder"},
        {"7-under-a-table", "Figure 7: under a table"},
        {"small-before-the-view",
         "A small ball whose shadow is in a part of the view plane: one ray misses it, 16 do not"},
    };
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    const int size = task.size(240), fine = kSupersample * size;
    Exhibit e;
    e.table.head = {"figure", "open ends", "both ends", "ends by rays", "depth-fail"};
    for (const Figure& f : kFigures) {
        View view(task.loader, readScene(task.options.sceneFolder / "figures" / (std::string(f.file) + ".json")), fine,
                  fine);
        const Image truth = traceScene(view.scene, view.scene.camera, openTruths(view.scene), {{}},
                                       {.width = size, .height = size, .supersample = kSupersample})
                                .front();
        builder.row(f.title);
        builder.compared("both ends", halved(view.counted(VolumeCapping::Exact)), truth);
        builder.compared("ends of what 16 rays meet", halved(view.counted(VolumeCapping::Approximate)), truth);
        builder.compared("depth-fail", halved(view.drawn(true)), truth);
        builder.row("", false);
        builder.compared("open ends", halved(view.counted(VolumeCapping::None)), truth);
        std::vector<std::function<void()>> frames;
        for (const VolumeCapping capping : {VolumeCapping::None, VolumeCapping::Exact, VolumeCapping::Approximate})
            frames.emplace_back([&view, capping] { view.shadows.add(view.light(), 1, {capping}); });
        frames.emplace_back([&view] { view.depthFail(); });
        TimingOptions timing;
        timing.repeats = task.options.timingRepeats;
        std::vector<std::string> row{f.file};
        for (const double seconds : medianFrameSeconds(frames, timing))
            row.push_back(fmt::format("{:.2f} ms", 1000 * seconds));
        e.table.rows.push_back(std::move(row));
    }
    e.section = "Hybrid rendering";
    e.title = "Shadow volumes by s-count and g-count";
    e.caption =
        "HYBRID section 2: sides before a point are counted in a float image, all sides along its ray at once in the "
        "stencil, so that each is drawn once; ends of volumes go into the stencil alone. Without ends, rays that pass "
        "through one are counted wrongly. The table has the time of a light's shadows, volumes made anew.";
    e.scene = "demos/scenes/figures; light without shadows times what the counts leave.";
    builder.finish(e);
    return e;
}

namespace {

/// Of each pixel, from its place: the share of the lamp's points that something hides.
Image tracedLevels(const View& view, const std::vector<Light>& points) {
    const std::vector<SeenPoint> seen = view.geometry.read();
    const SceneRays rays(view.scene, view.nodes);
    const int width = view.geometry.width(), height = view.geometry.height();
    Image out(width, height, 1);
    parallelFor(seen.size(), 0, [&](std::size_t i) {
        if (seen[i].place.w == 0) return;
        const Vec3 place(seen[i].place);
        int hidden = 0;
        for (const Light& p : points) {
            const Vec3 to = p.position - place;
            hidden += rays.shadowed(place, glm::normalize(to), glm::length(to));
        }
        out.at(static_cast<int>(i) % width, height - 1 - static_cast<int>(i) / width, 0) =
            static_cast<float>(hidden) / static_cast<float>(points.size());
    });
    return out;
}

/// As grey; black where the surface faces away from the lamp, which has no shadow there to speak of.
Image grey(const View& view, const Image& level, const Vec3& lamp) {
    const std::vector<SeenPoint> seen = view.geometry.read();
    Image out(level.width(), level.height(), 3);
    for (int y = 0; y < level.height(); ++y)
        for (int x = 0; x < level.width(); ++x) {
            const SeenPoint& p = seen[static_cast<std::size_t>((level.height() - 1 - y) * level.width() + x)];
            const bool faces = p.place.w != 0 && glm::dot(Vec3(p.normal), lamp - Vec3(p.place)) > 0;
            out.setRgb(x, y, Rgb(faces ? 1 - level.at(x, y, 0) : 0));
        }
    return out;
}

}  // namespace

ShadowStage shadowStage(ProgramLoader& loader, const SceneDescription& scene, int width, int height) {
    View view(loader, scene, width, height);
    const Light lamp = lightsInWorld(view.scene, view.nodes).front();
    const LightArea area = areasInWorld(view.scene, view.nodes).front().value();
    view.shadows.begin(view.geometry, view.scene.camera);
    for (const Light& p : pointsOfArea(lamp, area, 16)) view.shadows.add(homogeneous(p), 1.0 / 16);
    return {grey(view, view.shadows.read(ShadowFilter::EdgeStopping), lamp.position),
            grey(view, tracedLevels(view, pointsOfArea(lamp, area, 1024)), lamp.position)};
}

Exhibit softCountedExhibit(const Task& task) {
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    View view(task.loader, readScene(task.options.sceneFolder / "soft.json"), task.size(400), task.size(300));
    const Light lamp = lightsInWorld(view.scene, view.nodes).front();
    const LightArea area = areasInWorld(view.scene, view.nodes).front().value();
    report(task.options.progress, task.id + ": reference", 0);
    const Image truth = grey(view, tracedLevels(view, pointsOfArea(lamp, area, 1024)), lamp.position);
    for (const int count : {4, 9, 16, 25}) {
        view.shadows.begin(view.geometry, view.scene.camera);
        for (const Light& p : pointsOfArea(lamp, area, count)) view.shadows.add(homogeneous(p), 1.0 / count);
        builder.row(fmt::format("{} points of the lamp", count), count >= 16);
        const auto add = [&](const char* label, ShadowFilter filter) {
            builder.compared(label, grey(view, view.shadows.read(filter), lamp.position), truth);
            if (filter != ShadowFilter::EdgeStopping) builder.forComparison();
        };
        add("levels as they are", ShadowFilter::None);
        add("7 × 7 average", ShadowFilter::Box);
        add("edge-stopping average", ShadowFilter::EdgeStopping);
    }
    Exhibit e;
    e.section = "Hybrid rendering";
    e.title = "Soft shadows: a binary image a point of the lamp, accumulated and smoothed";
    e.caption =
        "HYBRID section 4.1, figure 10b. The paper's average takes steps between levels away, and edges of shadows and "
        "objects with them; ours stops at other objects, other planes and levels more than a step apart.";
    e.scene = "demos/scenes/soft.json, share of the lamp that is seen; truth: 1024 points a pixel.";
    builder.finish(e, 1);
    return e;
}

}  // namespace nacre
