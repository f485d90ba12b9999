// Mirrors and glass from virtual viewpoints beside rays (MPR section 3, PR94 "Reflections" and "Refractions").
#include <fmt/format.h>

#include "demos/exhibit_task.hpp"
#include "reference/scene_trace.hpp"
#include "shading/multipass/quality.hpp"
#include "shading/scene_bounds.hpp"
#include "shading/scene_file.hpp"
#include "shading/scene_renderer.hpp"

namespace nacre {
namespace {

constexpr int kQualityDepth = 8;

Image traced(const Task& task, const SceneDescription& scene, int width, int height, int depth) {
    report(task.options.progress, task.id + ": reference", 0);
    SceneTraceOptions options{.width = width, .height = height, .supersample = kSupersample};
    options.specularDepth = depth;
    options.spreadRays = 64;
    options.lightDepth = 0;  // views alone: light_path_exhibits.cpp has the rest
    return traceScene(scene, scene.camera, openTruths(scene), {{}}, options).front();
}

Image wholePicture(const Image& like) {
    Image out(like.width(), like.height(), 1);
    for (float& v : out.data()) v = 1;
    return out;
}

/// Draws panels of one scene under different options.
class Panels {
public:
    Panels(const Task& task, SceneDescription scene)
        : renderer_(task.loader, std::move(scene)), builder(task.loader, task.id, task.builder()) {}

    void panel(const std::string& label, const SpecularOptions& options, const Image& truth) {
        const auto draw = [this, options](const RenderTarget& target) {
            renderer_.switches.specular = options;
            renderer_.switches.specular.lightDepth = 0;
            renderer_.render(target);
        };
        builder.panel(label, draw, {truth, wholePicture(truth)});
    }
    std::string size() const {
        return fmt::format("{} passes, {} views", renderer_.schedule().passes.size(),
                           renderer_.schedule().views.size());
    }

private:
    SceneRenderer renderer_;

public:
    ExhibitBuilder builder;
};

SpecularOptions deep(int depth) {
    SpecularOptions out;
    out.depth = depth;
    return out;
}

Exhibit room(const Task& task) {
    const int size = task.size(400);
    const SceneDescription scene = readScene(task.options.sceneFolder / "mirrors.json");
    constexpr int kFull = 8;
    const Image truth = traced(task, scene, size, size, kFull);
    Panels panels(task, scene);
    panels.builder.row(fmt::format("Against rays over up to {} mirrors and panes", kFull));
    for (const int depth : {4, 2, 1}) {
        panels.panel(fmt::format("depth {}", depth), deep(depth), truth);
        if (depth < SpecularOptions().depth) panels.builder.forComparison();
    }
    panels.builder.row("Against rays over as many: what virtual viewpoints do wrong", false);
    for (const int depth : {4, 2, 1})
        panels.panel(fmt::format("depth {}", depth), deep(depth), traced(task, scene, size, size, depth));
    Exhibit e;
    e.section = "Specular views (MPR section 3)";
    e.title = "A box with a mirror and a pane of glass";
    e.caption =
        "Each mirror and each way through a pane is drawn again from a virtual viewpoint, where the stencil buffer "
        "counts "
        "the faces on the way; clip distances keep what is behind a face out, and the Fresnel weights of a path "
        "multiply in "
        "destination alpha. The mirror is exact; each refracting face is seen from one eye, made for the incident "
        "angle in "
        "the middle of what is seen of it. The pane is two faces, in and out. The reference follows each ray by "
        "Snell's "
        "law. Where a path ends in a face, that is black: with depth 1 the pane is, since a way through it takes two. "
        "Half of the mirror is black too: there it shows the open side of the box, towards the eye. In "
        "neither: light that the mirror and the glass send on.";
    e.scene = "A box of lambert walls, a ball, a ring, a mirror of 92 %, glass of index 1.5; a spot light.";
    e.commands = {"nacre render demos/scenes/mirrors.json -o mirrors.png --reference",
                  "nacre render demos/scenes/mirrors.json --passes"};
    panels.builder.finish(e);
    return e;
}

/// Pixels of a picture of 512² and 40° between where refraction truly shows a point and where a virtual viewpoint shows
/// it: the worst of points 1 behind the face, seen from 3 away at `off` from the ray of the stated angle.
double misprojection(double stated, double off, double eta, RefractedEye how, bool axial) {
    Camera camera;
    const Plane plane(0, 0, 1, 0);
    camera.eye = 3.0 * Vec3(std::sin(stated), 0, std::cos(stated));
    camera.target = Vec3(0);
    camera.fovY = 40 * kPi / 180;
    const SpecularView first = viewOf(camera, 1);
    const Vec3 eye = camera.eye, met = axial ? Vec3(eye.x, eye.y, 0) : Vec3(0);
    const SpecularView view = refracted(first, plane, *refractedEye(first, plane, met, eta, how));
    const auto seen = [](const SpecularView& v, const Vec3& p) {
        const Vec4 clip = v.toClip * Vec4(p, 1);
        return Vec2(clip) / clip.w;
    };
    double worst = 0;
    for (int i = 0; i < 16; ++i) {
        const double phi = i * kPi / 8, radius = std::tan(off) / std::tan(camera.fovY / 2);
        const auto p = planePointAt(first, plane, radius * Vec2(std::cos(phi), std::sin(phi)));
        if (!p) continue;
        const Vec3 along = glm::normalize(*p - eye);
        const double sine2 = (1 - along.z * along.z) / (eta * eta);
        const Vec3 beyond = Vec3(along.x, along.y, 0) / eta - Vec3(0, 0, std::sqrt(1 - sine2));
        worst = std::max(worst, 256 * glm::length(seen(view, *p - beyond / beyond.z) - seen(first, *p)));
    }
    return worst;
}

ExhibitTable anglesTable() {
    ExhibitTable out;
    out.head = {"stated incident angle", "rays off by", "eye on the normal", "turned eye (PR94)", "paraxial"};
    for (const double stated : {0.0, 30.0, 60.0})
        for (const double off : {0.0, 2.0, 5.0, 10.0}) {
            const auto pixels = [&](RefractedEye how, bool axial) {
                return fmt::format("{:.2f} px", misprojection(stated * kPi / 180, off * kPi / 180, 1.5, how, axial));
            };
            out.rows.push_back({fmt::format("{:g}°", stated), fmt::format("{:g}°", off),
                                pixels(RefractedEye::OnNormal, false), pixels(RefractedEye::Turned, false),
                                pixels(RefractedEye::OnNormal, true)});
        }
    return out;
}

Exhibit plates(const Task& task) {
    const int size = task.size(400);
    const SceneDescription scene = readScene(task.options.sceneFolder / "plates.json");
    const Image truth = traced(task, scene, size, size, 4);
    SpecularOptions viewAxis, turned, flat;
    viewAxis.angle = turned.angle = flat.angle = RefractionAngle::ViewAxis;
    turned.eye = flat.eye = RefractedEye::Turned;
    flat.keepDepth = false;
    Panels panels(task, scene);
    panels.builder.row("With depth");
    panels.panel("eye on the normal, incident angle of the face's middle", {}, truth);
    panels.builder.row("The paper's choices", false);
    panels.panel("incident angle of the view vector", viewAxis, truth);
    panels.panel("the eye turned about the incident point as well", turned, truth);
    panels.panel("and PR94's map onto the face, which clears depths", flat, truth);
    Exhibit e;
    e.section = "Specular views (MPR section 3)";
    e.title = "Behind a refracting plate";
    e.caption =
        "A change of medium, as in PR94's plates: one face of index 1.33. The refracted picture must be mapped onto "
        "the face "
        "(PR94 equations 1 to 5); where the map is part of the clip matrix and its row of depths is chosen, depths "
        "stay and "
        "hidden surfaces are removed, and fog and recursion work behind the face. Cleared, as in equation A5, what is "
        "drawn "
        "last covers. One virtual eye is right for one incident angle: on the normal through the eye for all azimuths "
        "of it, "
        "turned about the incident point for one ray alone. Here the "
        "view vector meets the plate near its middle, so that the paper's angle does as well as ours. The table has "
        "what is left, against Snell's law: the worst "
        "pixel, "
        "of 512 over 40 degrees, for points behind the face by a third of the eye's distance; index 1.5.";
    e.scene = "A floor with stripes, bars, a ball and a ring behind a face of 1.5 x 1.2.";
    e.commands = {"nacre render demos/scenes/plates.json -o plates.png --reference"};
    e.table = anglesTable();
    panels.builder.finish(e);
    return e;
}

SceneDescription frostedScene(const std::filesystem::path& folder, double spread, double fogDistance) {
    SceneDescription scene = readScene(folder / "plates.json");
    for (SceneMaterial& m : scene.materials)
        if (m.specular) {
            m.specular->ior = 1;
            m.specular->spread = spread;
            m.specular->fogDistance = fogDistance;
            m.specular->fog = Rgb(0.5, 0.55, 0.6);
        }
    return scene;
}

Exhibit frosted(const Task& task) {
    const int size = task.size(320);
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    std::vector<std::unique_ptr<SceneRenderer>> renderers;
    const auto panel = [&](const std::string& label, const SceneDescription& scene, const SpecularOptions& options) {
        renderers.push_back(std::make_unique<SceneRenderer>(task.loader, scene));
        renderers.back()->switches.specular = options;
        const Image truth = traced(task, scene, size, size, 4);
        builder.panel(label, [&r = *renderers.back()](const RenderTarget& target) { r.render(target); },
                      {truth, wholePicture(truth)});
    };
    builder.row("Spread m of the slopes and distance of the fog, as in the paper's figure 3");
    for (const auto& [spread, fog] : {std::pair{0.05, 0.0}, {0.12, 0.0}, {0.05, 2.0}, {0.0, 1.5}})
        panel(fmt::format("m = {:g}, {}", spread, fog > 0 ? fmt::format("fog to {:g}", fog) : "no fog"),
              frostedScene(task.options.sceneFolder, spread, fog), {});
    builder.row("Samples: fewer, and the paper's random ones", false);
    for (const auto& [count, sampling] :
         {std::pair{8, ShearSampling::LowDiscrepancy}, {8, ShearSampling::Random}, {32, ShearSampling::Random}}) {
        SpecularOptions options;
        options.shears = count;
        options.sampling = sampling;
        panel(
            fmt::format("m = 0.12, {} {}", count, sampling == ShearSampling::Random ? "random" : "of low discrepancy"),
            frostedScene(task.options.sceneFolder, 0.12, 0), options);
    }
    builder.row("Microfacets: each view turned as one facet turns the incident ray, against facets for each ray");
    for (const double roughness : {0.1, 0.25}) {
        SceneDescription scene = readScene(task.options.sceneFolder / "plates.json");
        for (SceneMaterial& m : scene.materials)
            if (m.specular) m.specular->roughness = roughness;
        panel(fmt::format("index 1.33, Beckmann's alpha = {:g}", roughness), scene, {});
    }
    Exhibit e;
    e.section = "Specular views (MPR section 3)";
    e.title = "Frosted and foggy glass (MPR figure 3)";
    e.caption =
        "Frosted glass is drawn many times, each time sheared about the face's normal, and summed in floating point: "
        "what "
        "touches the glass is sharp, what is far blurs. Fog starts at the face. The references trace 256 rays a pixel "
        "through "
        "the same distribution of slopes. Rough glass has facets of Beckmann's distribution: what each does to the ray "
        "in the middle of the face is done to the whole view, weighted by how much the facet is seen; in the reference "
        "each ray has its own angle, Fresnel weight and shadowing (Walter et al. 2007).";
    e.scene = "The plate's scene without refraction; 32 samples of low discrepancy unless the label says otherwise.";
    builder.finish(e);
    return e;
}

ExhibitTable qualityTable(const SceneDescription& scene, int size) {
    ExhibitTable out;
    out.head = {"level", "depth", "partial reflections", "passes", "views"};
    const std::vector<glm::dmat4> nodes = nodeTransforms(scene, 0);
    const SceneBounds box = boundsAt(scene, 0);
    SceneSwitches best;
    best.specular.depth = kQualityDepth;
    for (int level = 0; level < kQualityLevels; ++level) {
        const SpecularOptions options = atQuality(best, level).specular;
        const PassSchedule schedule =
            makeSchedule(specularFaces(scene, nodes), {scene.camera, size, size, box.low, box.high}, options);
        out.rows.push_back({qualityName(level), fmt::format("{}", options.depth), options.partial ? "yes" : "no",
                            fmt::format("{}", schedule.passes.size()), fmt::format("{}", schedule.views.size() - 1)});
    }
    return out;
}

Exhibit quality(const Task& task) {
    const int size = task.size(400);
    const SceneDescription scene = readScene(task.options.sceneFolder / "mirrors.json");
    const Image truth = traced(task, scene, size, size, kQualityDepth);
    Panels panels(task, scene);
    panels.builder.row("Levels of quality against all that rays see");
    SceneSwitches best;
    best.specular.depth = kQualityDepth;
    for (int level = 0; level < kQualityLevels - 1; ++level)  // the last differs where something is frosted
        panels.panel(qualityName(level), atQuality(best, level).specular, truth);
    Exhibit e;
    e.section = "Specular views (MPR section 3)";
    e.title = "Quality for time (MPR tables 2 and 3)";
    e.caption =
        "Passes are what a picture costs. Each level gives up what is seen least: first deep paths, then what glass "
        "reflects, then a pane in the mirror. Least gives up samples of frost and lamps and light by faces, which "
        "aren't here: it is low. While the picture moves, the viewer takes the best level whose frames "
        "keep a time; at rest it refines, one level a picture. The paper's own bathroom went from 1081 passes (63.5 s, "
        "three specular surfaces at depth 2) to 41 (3.4 s, one at depth 1).";
    e.scene = "The box with a mirror and a pane; depth 8 at most.";
    e.commands = {
        "nacre render demos/scenes/mirrors.json -o low.png --depth 8 --quality low --light-paths 0 --reference",
        "nacre render demos/scenes/mirrors.json --depth 8 --quality low --light-paths 0 --size 400x400 --passes",
        "nacre view demos/scenes/mirrors.json --target-ms 50"};
    e.table = qualityTable(scene, kSupersample * size);
    panels.builder.finish(e);
    return e;
}

}  // namespace

const std::vector<NamedExhibit>& specularExhibits() {
    static const std::vector<NamedExhibit> all = {{"specular-room", room},
                                                  {"specular-plates", plates},
                                                  {"specular-frosted", frosted},
                                                  {"specular-quality", quality}};
    return all;
}

}  // namespace nacre
