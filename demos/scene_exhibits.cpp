// Whole scenes and volumes: everything at once beside its reference, each approximation switched off by itself, and a
// surface in a volume (HSE figure 7).
#include <fmt/format.h>

#include "core/error.hpp"
#include "demos/exhibit_task.hpp"
#include "factorize/models/models.hpp"
#include "reference/scene_trace.hpp"
#include "reference/volume_trace.hpp"
#include "shading/scene_file.hpp"
#include "shading/scene_renderer.hpp"
#include "shading/volume_file.hpp"
#include "shading/volume_pass.hpp"

namespace nacre {
namespace {

/// Stands in where the scene's meshes, height field or surrounding couldn't be fetched and baked.
constexpr const char* kPlainScene = R"({
  "nacre_scene": 1,
  "meshes": {"torus": {"torus": {"ring": 0.7, "tube": 0.3}}, "floor": {"quad": {"size": 8}}},
  "materials": {"metal": {"model": "ggx:alphax=0.2,alphay=0.2,f=conductor", "ambient": 0.05},
                "matt": {"model": "lambert:kd=0.6", "ambient": 0.05}},
  "nodes": {"torus": {"mesh": "torus", "material": "metal", "translation": [0, 0.8, 0], "axis": [1, 0, 0], "angleDeg": 60},
            "floor": {"mesh": "floor", "material": "matt", "axis": [1, 0, 0], "angleDeg": -90}},
  "lights": {"lamp": {"type": "spot", "position": [3, 6, 4], "target": [0, 0.5, 0], "intensity": 220, "outerDeg": 28,
                      "shadow": true}},
  "camera": {"eye": [0.5, 2.2, 4.6], "target": [0, 0.9, 0], "fovYDeg": 40, "near": 0.5, "far": 40}
})";

/// That of the folder, or a plain one where a file of it is missing.
SceneDescription openScene(const Task& task, const char* name, SceneDescription (*plain)()) {
    try {
        return readScene(task.options.sceneFolder / name);
    } catch (const Error& error) {
        task.notes.push_back(fmt::format("{}: a plain scene stands in for {} ({})", task.id, name, error.what()));
        return plain();
    }
}

/// A mask of every pixel.
Image wholePicture(int width, int height) {
    Image out(width, height, 1);
    for (float& v : out.data()) v = 1;
    return out;
}

/// An approximation switched off in the picture, and the same light left out of the reference.
struct Part {
    const char* label;
    SceneSwitches off;
    SceneParts without;
};

std::vector<Part> partsOf(const SceneDescription& scene) {
    std::vector<Part> out(1, {"everything", {}, {}});
    const auto add = [&out](const char* label) -> Part& { return out.emplace_back(Part{label, {}, {}}); };
    Part& shadows = add("without shadow maps");
    shadows.off.shadows = shadows.without.shadows = false;
    if (scene.assets.empty()) return out;
    Part& relief = add("without shadows of the relief");
    relief.off.reliefShadow = BumpShadow::None;
    relief.without.reliefShadow = false;
    Part& indirect = add("without light bounced in the relief");
    indirect.off.indirect = indirect.without.indirect = false;
    Part& surrounding = add("without the surrounding's light");
    surrounding.off.surrounding = surrounding.without.surrounding = false;
    return out;
}

Exhibit composed(const Task& task) {
    const int width = task.size(480), height = task.size(360);
    SceneRenderer renderer(task.loader,
                           openScene(task, "composed.json", [] { return parseScene(kPlainScene, "plain.json"); }));
    const SceneDescription& scene = renderer.scene();
    const std::vector<Part> parts = partsOf(scene);
    std::vector<SceneParts> traced;
    for (const Part& part : parts) traced.push_back(part.without);
    traced.emplace_back().occlusion = true;
    report(task.options.progress, task.id + ": reference", 0);
    const std::vector<Image> truths = traceScene(scene, scene.camera, openTruths(scene), traced,
                                                 {.width = width, .height = height, .supersample = kSupersample});
    const Image everywhere = wholePicture(width, height);
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    const auto panel = [&](const std::string& label, const SceneSwitches& switches, const Image& truth) {
        const auto draw = [&renderer, switches](const RenderTarget& target) {
            renderer.switches = switches;
            renderer.render(target);
        };
        builder.panel(label, draw, {truth, everywhere});
    };
    builder.row("Everything, against the true picture of the same light, and against all light");
    panel("everything", {}, truths[0]);
    panel("the same; in this truth meshes block the surrounding's light too, as no pass here does", {}, truths.back());
    builder.row("One part switched off, in the picture alone: what it is good for", false);
    for (std::size_t i = 1; i < parts.size(); ++i) panel(parts[i].label, parts[i].off, truths[0]);
    builder.row("The same part left out of the truth as well: what the others do wrong", false);
    for (std::size_t i = 1; i < parts.size(); ++i) panel(parts[i].label, parts[i].off, truths[i]);
    Exhibit e;
    e.section = "Whole scenes";
    e.title = "A scanned statue on a bumpy floor, under a lamp and a city's sky";
    e.caption =
        "A factored measured material with prefiltered reflections and exact Fresnel weights, a relief that shadows "
        "and "
        "lights itself, a prefiltered surrounding and a shadow-mapped spot light in one pass a node. The reference "
        "traces the same scene: the unfactored BRDF, shadow rays, exact horizons, paths in the relief, integrals over "
        "the surrounding as it came.";
    e.scene = fmt::format(
        "{} triangles, {} materials, {} lights.",
        [&] {
            std::size_t count = 0;
            for (const SceneMesh& mesh : scene.meshes) count += mesh.mesh.triangles.size();
            return count;
        }(),
        scene.materials.size(), scene.lights.size());
    if (!scene.assets.empty())
        e.commands = {"nacre bake demos/scenes/composed.json",
                      "nacre render demos/scenes/composed.json -o composed.png --shares",
                      "nacre view demos/scenes/composed.json"};
    builder.finish(e);
    return e;
}

/// A ball of waves where no scan could be fetched.
Volume wavyBall() {
    Volume out;
    out.size = glm::ivec3(64);
    for (int z = 0; z < 64; ++z)
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                const Vec3 p = (Vec3(x, y, z) - 31.5) / 32.0;
                const double waves = std::sin(9 * p.x) * std::sin(9 * p.y) * std::sin(9 * p.z);
                out.values.push_back(static_cast<float>(0.7 - glm::length(p) + 0.12 * waves));
            }
    return out;
}

struct Scan {
    Volume volume;
    double iso;
    Camera camera;
    std::string words;
};

Scan openScan(const Task& task) {
    Scan out;
    out.camera.fovY = 0.62;
    out.camera.near = 0.5;
    out.camera.far = 10;
    out.camera.up = {0, 0, 1};
    out.camera.eye = {-1.2, -3.0, 0.9};
    const std::filesystem::path file = task.options.volumeFolder / "skull_2.9.inr";
    std::error_code ignored;
    if (std::filesystem::is_regular_file(file, ignored)) {
        out.volume = readVolume(file);
        out.iso = 2.9;
        out.words = "Scan of a skull, 64 x 64 x 64 samples, surface at 2.9";
        return out;
    }
    task.notes.push_back(task.id + ": a made-up volume stands in for skull_2.9.inr");
    out.volume = wavyBall();
    out.iso = 0;
    out.words = "A made-up ball of waves, 64 x 64 x 64 samples";
    return out;
}

Exhibit volume(const Task& task) {
    const Scan scan = openScan(task);
    const GpuVolume gpu(scan.volume);
    const Reflectance bone = makeModel("blinn-phong:n=30,kd=0.6,ks=0.2");
    const GpuDirectBrdf brdf = *directBrdf(bone);
    const LitView view{scan.camera, {{true, glm::normalize(Vec3(-1, -1.2, 1.6)), Rgb(kPi)}}, Rgb(0)};
    const int size = task.size(320);
    report(task.options.progress, task.id + ": reference", 0);
    const RaytracedPicture truth = traceVolume({scan.volume, scan.iso}, view.camera, view.lights, bone.f,
                                               {.width = size, .height = size, .supersample = kSupersample});
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    for (const VolumeMethod method : {VolumeMethod::Slices, VolumeMethod::March}) {
        const bool slices = method == VolumeMethod::Slices;
        builder.row(slices ? "Slices and an alpha test, as in the paper" : "Marched along each line of sight", !slices);
        for (const double step : {2.0, 1.0, 0.5}) {
            builder.panel(
                fmt::format("{:g} texels a step", step),
                [&task, &gpu, &scan, &view, &brdf, method, step](const RenderTarget& target) {
                    renderVolume(task.loader, target, {.volume = &gpu, .iso = scan.iso, .method = method, .step = step},
                                 view, brdf);
                },
                truth);
            if (step > 0.5) builder.forComparison();  // the default
        }
    }
    Exhibit e;
    e.section = "Volumes (HSE figure 7)";
    e.title = "The surface in a scan, by slices of a 3D texture";
    e.caption =
        "A 3D texture holds the scan's values and gradients. The paper's way draws polygons across it, nearest first; "
        "an "
        "alpha test keeps what lies inside, the depth test its first layer, and the gradient is the normal. A march "
        "along each line of sight finds the crossing between two steps and needs fewer of them. The reference follows "
        "rays through the same trilinear field in steps of an eighth of a texel, and bisects.";
    e.scene = scan.words + "; one directional light; Blinn-Phong.";
    builder.finish(e);
    return e;
}

/// Stands in for the scans.
SceneDescription plainScans() {
    SceneDescription scene = parseScene(kPlainScene, "plain.json");
    SceneVolume ball;
    ball.name = "ball";
    ball.volume = std::make_shared<Volume>(wavyBall());
    scene.volumes.push_back(std::move(ball));
    SceneNode node;
    node.name = "ball";
    node.volume = 0;
    node.material = scene.nodes.front().material;
    node.translation = {0.5, 1, -1};
    scene.nodes.push_back(std::move(node));
    return scene;
}

void setMethod(SceneDescription& scene, VolumeMethod method) {
    for (SceneVolume& volume : scene.volumes) volume.method = method;
}

Exhibit shadowedVolumes(const Task& task) {
    const int width = task.size(480), height = task.size(320);
    SceneDescription scene = openScene(task, "scans.json", plainScans);
    report(task.options.progress, task.id + ": reference", 0);
    SceneParts open;
    open.shadows = false;
    const std::vector<Image> truths = traceScene(scene, scene.camera, openTruths(scene), {{}, open},
                                                 {.width = width, .height = height, .supersample = kSupersample});
    const Image everywhere = wholePicture(width, height);
    setMethod(scene, VolumeMethod::March);
    SceneRenderer march(task.loader, scene);
    setMethod(scene, VolumeMethod::Slices);
    SceneRenderer slices(task.loader, scene);
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    const auto panel = [&](const std::string& label, SceneRenderer& renderer, bool shadows, bool again) {
        const auto draw = [&renderer, shadows, again, brighter = false](const RenderTarget& target) mutable {
            renderer.switches.shadows = shadows;
            if (again) {  // a light that changes has its map drawn again; nobody sees this change
                brighter = !brighter;
                SceneLight light = renderer.scene().lights.front();
                light.light.color *= brighter ? 1 + 1e-6 : 1 / (1 + 1e-6);
                renderer.setLight(0, light);
            }
            renderer.render(target);
        };
        builder.panel(label, draw, {truths[shadows ? 0 : 1], everywhere});
    };
    builder.row("Shadow maps hold the volumes' surfaces: on the floor, on each other, on themselves");
    panel("marched, in the picture and in the map", march, true, false);
    panel("the same, the map drawn again for each frame", march, true, true);
    builder.row("Slices and an alpha test, in the picture and in the map", false);
    panel("slices, as in the paper", slices, true, false);
    panel("the same, the map drawn again for each frame", slices, true, true);
    builder.row("Without shadows, against the truth without: what a shadowed frame costs more", false);
    panel("marched", march, false, false);
    panel("slices", slices, false, false);
    Exhibit e;
    e.section = "Volumes (HSE figure 7)";
    e.title = "Scans on a floor, shadowed by the map of a spot light";
    e.caption =
        "The light's depth map is drawn with the meshes and with the volumes, by slices that face the light and the "
        "alpha test, or by a march along each texel's ray. A volume's point is looked up with the normal of the "
        "field's "
        "gradient; a slice, which may lie a step inside, half a step further out. The maps are kept while nothing "
        "moves. "
        "The "
        "reference follows rays to the light past triangles and through the same trilinear fields.";
    e.scene = fmt::format("{} volumes, {} meshes, a spot light.", scene.volumes.size(), scene.meshes.size());
    if (!scene.file.empty() && scene.file.filename() == "scans.json")
        e.commands = {"nacre render demos/scenes/scans.json -o scans.png --shares",
                      "nacre info demos/scenes/scans.json"};
    builder.finish(e);
    return e;
}

}  // namespace

const std::vector<NamedExhibit>& sceneExhibits() {
    static const std::vector<NamedExhibit> all = {{"shadow-study", shadowStudyExhibit},
                                                  {"scene-composed", composed},
                                                  {"volume-surface", volume},
                                                  {"volume-shadows", shadowedVolumes}};
    return all;
}

}  // namespace nacre
