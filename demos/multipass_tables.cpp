// What settings cost and give up: our figures beside MPR's tables 1 to 3.
#include <fmt/format.h>

#include <chrono>

#include "demos/exhibit_task.hpp"
#include "reference/image_compare.hpp"
#include "reference/scene_trace.hpp"
#include "shading/scene_file.hpp"
#include "shading/scene_renderer.hpp"

namespace nacre {
namespace {

struct Setting {
    const char* label;
    bool door;  ///< without it: nothing in its place
    int depth, lightDepth;
    std::vector<std::string> paper;  ///< nearest row: name, scene and shadow iterations, seconds, times Radiance
};

const std::vector<Setting>& settings() {
    static const std::vector<Setting> all = {
        {"mirror and door", true, 4, 2, {"3(a): n 3, d 2", "321 / 760", "63.5", "6"}},
        {"paths of three", true, 3, 2, {"3(b): n 3, d 1", "129 / 304", "28.0", "8"}},
        {"light past one face", true, 3, 1, {"2(e): light d 1", "13 / 20", "2.6", "-"}},
        {"no light by faces", true, 3, 0, {"2(c): no specular shadows", "17 / 16", "2.1", "-"}},
        {"mirror alone", false, 1, 1, {"3(e): n 1, d 1", "17 / 24", "3.4", "53"}}};
    return all;
}

/// Its overhead lamp alone; what mirrors and refracts sends light on.
SceneDescription bathroom(const Task& task, bool door) {
    SceneDescription scene = readScene(task.options.sceneFolder / "bathroom.json");
    scene.lights.erase(std::remove_if(scene.lights.begin(), scene.lights.end(),
                                      [](const SceneLight& light) { return light.name != "overhead"; }),
                       scene.lights.end());
    for (SceneNode& node : scene.nodes) {
        if (node.material < 0) continue;
        const std::optional<SceneSpecular>& specular =
            scene.materials[static_cast<std::size_t>(node.material)].specular;
        if (!specular) continue;
        node.castsShadow = true;
        if (specular->ior && !door) node.mesh = node.material = -1;
    }
    return scene;
}

/// What is counted in the stencil buffer for all lights of all views: a light volume a face, a shadow stage each.
std::size_t countedStages(const PassSchedule& schedule) {
    std::size_t out = 0;
    for (const Pass& pass : schedule.passes) {
        if (pass.kind != PassKind::Light) continue;
        const auto& image = schedule.lights[static_cast<std::size_t>(pass.light)].image;
        out += image ? image->bounces.size() + image->stages.size() : 1;
    }
    return out;
}

std::size_t drawn(const PassSchedule& schedule, PassKind kind) {
    return static_cast<std::size_t>(std::count_if(schedule.passes.begin(), schedule.passes.end(),
                                                  [kind](const Pass& pass) { return pass.kind == kind; }));
}

double secondsOf(const std::vector<PassTime>& passes, const std::string& name) {
    for (const PassTime& pass : passes)
        if (pass.name == name) return pass.wallSeconds;
    return 0;
}

class Tables {
public:
    explicit Tables(const Task& task)
        : task_(task), builder(task.loader, task.id, task.builder()), size_(task.size(320)) {
        table.head = {"setting",       "depth",      "light depth",       "surfaces / lights / stages counted", "s",
                      "times rays",    "RMS / mean", "MPR's nearest row", "scene / shadow iterations",          "s ",
                      "times Radiance"};
    }

    void add(const Setting& s) {
        renderers_.push_back(std::make_unique<SceneRenderer>(task_.loader, bathroom(task_, s.door)));
        SceneRenderer& renderer = *renderers_.back();
        SceneSwitches on;
        on.shadowMethod = ShadowMethod::Volumes;
        on.specular.depth = s.depth;
        on.specular.lightDepth = s.lightDepth;
        renderer.switches = on;
        const RenderTarget target({.width = kSupersample * size_, .height = kSupersample * size_});
        renderer.setTiming(true);
        renderer.render(target);  // compiles, and makes the volumes
        made_.push_back(renderer.shadowVolumes().made);
        making_.push_back(secondsOf(renderer.passes(), "shadow volumes"));
        renderer.render(target);
        surfaces_.push_back(secondsOf(renderer.passes(), "surfaces"));
        lights_.push_back(secondsOf(renderer.passes(), "light"));
        renderer.setTiming(false);
        const double seconds = time([&] { renderer.render(target), target.read(); });
        Image own;
        const double rays = time([&] { own = traced(renderer.scene(), s.depth, s.lightDepth); });
        const SceneDescription& scene = renderer.scene();
        const Image full = s.depth == 4 ? own : traced(scene, 4, 2);
        Image whole(size_, size_, 1);
        for (float& v : whole.data()) v = 1;
        builder.panel(s.label, [&renderer](const RenderTarget& t) { renderer.render(t); }, {full, whole});
        if (s.door && (s.depth < 4 || s.lightDepth < 2)) builder.forComparison();  // the truth has all faces' light
        const PassSchedule& schedule = renderer.schedule();
        table.rows.push_back({s.label, std::to_string(s.depth), std::to_string(s.lightDepth),
                              fmt::format("{} / {} / {}", drawn(schedule, PassKind::Surfaces),
                                          drawn(schedule, PassKind::Light), countedStages(schedule)),
                              fmt::format("{:.2f}", seconds), fmt::format("{:.1f}", rays / seconds),
                              error(target, full)});
        table.rows.back().insert(table.rows.back().end(), s.paper.begin(), s.paper.end());
    }

    /// Of the first setting, beside table 1.
    std::string frameText() const {
        return fmt::format(
            "Of the first setting's frame surfaces take {:.2f} s, lights with all that is counted for "
            "them {:.2f} s; making its {} shadow and light volumes, once, {:.2f} s",
            surfaces_[0], lights_[0], made_[0], making_[0]);
    }

    ExhibitTable table;

private:
    const Task& task_;

public:
    ExhibitBuilder builder;

private:
    template <class Work>
    static double time(const Work& work) {
        const auto begin = std::chrono::steady_clock::now();
        work();
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    }
    Image traced(const SceneDescription& scene, int depth, int lightDepth) const {
        report(task_.options.progress, task_.id + ": reference", 0);
        SceneTraceOptions options{.width = size_, .height = size_, .supersample = kSupersample};
        options.specularDepth = depth;
        options.lightDepth = lightDepth;
        return traceScene(scene, scene.camera, openTruths(scene), {{}}, options).front();
    }
    std::string error(const RenderTarget& target, const Image& truth) const {
        const Image fine = target.read();
        Image out(size_, size_, 3);
        for (int y = 0; y < size_; ++y)
            for (int x = 0; x < size_; ++x) {
                Rgb sum(0);
                for (int k = 0; k < kSupersample * kSupersample; ++k)
                    sum += fine.rgb(kSupersample * x + k % kSupersample, kSupersample * y + k / kSupersample);
                out.setRgb(x, y, sum / double(kSupersample * kSupersample));
            }
        return fmt::format("{:.1f} %", 100 * compareImages(out, truth, pictureWhite(truth)).rmsOverMean);
    }

    std::vector<std::unique_ptr<SceneRenderer>> renderers_;
    std::vector<int> made_;
    std::vector<double> making_, surfaces_, lights_;
    int size_;
};

}  // namespace

Exhibit multipassTables(const Task& task) {
    Tables tables(task);
    tables.builder.row("One lamp; each against rays over all faces (depth 4, light past two)");
    for (const Setting& s : settings()) tables.add(s);
    Exhibit e;
    e.section = "Light by way of mirrors and glass (MPR section 4)";
    e.title = "What settings cost (MPR tables 1 to 3)";
    e.caption =
        tables.frameText() +
        " (the paper: objects 6.34 s, shadow volumes 6.89 s of 16.61 s; 6.95 s more where volumes aren't stored). The "
        "table counts draws of a view's surfaces, of one light in one view, and of what is counted in the stencil "
        "buffer for these, beside the paper's scene and shadow iterations of its own bathroom on its own machine. Our "
        "door has two faces, the paper's one; times rays: our reference at the same samples and depths, where the "
        "paper has Radiance.";
    e.scene = "demos/scenes/bathroom.json with its overhead lamp alone; mirror and door send light on.";
    e.table = tables.table;
    tables.builder.finish(e);
    return e;
}

}  // namespace nacre
