// Rooms with soft shadows by whichever way is right and faster (HYBRID sections 4.1 and 5).
#include <fmt/format.h>

#include "core/error.hpp"
#include "demos/exhibit_task.hpp"
#include "demos/hybrid_parts.hpp"
#include "demos/picture.hpp"
#include "reference/scene_components.hpp"
#include "shading/scene_file.hpp"

namespace nacre {
namespace {

constexpr int kPoints = 18;  // of each lamp, the paper's

/// A scan that isn't there is noted.
std::optional<SceneDescription> openRoom(const Task& task, const std::string& file) {
    try {
        return readScene(task.options.sceneFolder / file);
    } catch (const Error& error) {
        task.notes.emplace_back(error.what());
        return std::nullopt;
    }
}

std::size_t trianglesOf(const SceneDescription& scene) {
    std::size_t out = 0;
    for (const SceneNode& node : scene.nodes)
        if (node.mesh >= 0) out += scene.meshes[static_cast<std::size_t>(node.mesh)].mesh.triangles.size();
    return out;
}

double secondsOf(const HybridReport& report) {
    double out = 0;
    for (const PassTime& stage : report.stages) out += stage.wallSeconds;
    return out;
}

}  // namespace

Exhibit roomsExhibit(const Task& task) {
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    const int size = task.size(320);
    Exhibit e;
    e.table.head = {"room", "triangles", "a map a point", "volumes", "taken", "frame at 512 x 512"};
    for (const auto& [file, title] :
         {std::pair<std::string, std::string>{"office.json", "Office: a scan, a glass ball and a mirrored block"},
          {"living-room.json", "Living room: a scan"},
          {"classroom.json", "Classroom: nearly every edge is a silhouette"}}) {
        const std::optional<SceneDescription> scene = openRoom(task, file);
        if (!scene) continue;
        const SceneTruths truths = openTruths(*scene);
        HybridRenderer renderer(task.loader, *scene, materialsOf(truths));
        HybridOptions options;
        options.traced = hasSpecular(*scene);
        options.shadows = SampledShadowOptions{SampledShadowMethod::Fastest, kPoints};
        renderer.draw(512, 512, options);  // chooses
        const SampledShadowChoice choice = renderer.report().shadows;
        renderer.draw(512, 512, options);
        const double seconds = secondsOf(renderer.report());
        options.shadows->method = choice.taken;
        Image drawn = halved(renderer.draw(kSupersample * size, kSupersample * size, options).blended);
        const double milliseconds = 1000 * secondsOf(renderer.report());
        SceneTraceOptions tracing{.width = size, .height = size, .supersample = kSupersample};
        tracing.lightPoints = 16;
        tracing.progress = task.options.progress;
        builder.row(title);
        builder.compared(fmt::format("shadows by {}", nameOf(choice.taken)), std::move(drawn),
                         traceComponents(*scene, scene->camera, truths, tracing, false).blended, milliseconds);
        const auto figure = [](double time, double psnr) { return fmt::format("{:.3f} s, {:.1f} dB", time, psnr); };
        e.table.rows.push_back({file, std::to_string(trianglesOf(*scene)), figure(choice.mapSeconds, choice.mapPsnr),
                                figure(choice.volumeSeconds, choice.volumePsnr), nameOf(choice.taken),
                                fmt::format("{:.3f} s", seconds)});
    }
    e.section = "Hybrid rendering";
    e.title = "Rooms: soft shadows by volumes or maps, whichever is right and faster";
    e.caption = fmt::format(
        "Each lamp has {} points. Their shadows are found for every pixel before it is lit, by counted volumes or by a "
        "shadow map a point, and the steps between levels are smoothed where no edge is (HYBRID section 4.1). Both are "
        "timed once and compared with rays to 256 points of the lamp from 4096 pixels; of those within 35 dB the "
        "faster is taken. That is of shadows alone: the light of a lamp with an area comes from its middle here, which "
        "is the bright ring in the classroom's difference, on the ceiling about its large lamps. The paper drew its "
        "office, 4083 polygons, 4 times a second on eight graphics pipes; the scanned "
        "office has about as many.",
        kPoints);
    e.scene = "demos/scenes/office.json, living-room.json (scans that demos/fetch.sh brings), classroom.json.";
    e.commands = {
        "nacre render demos/scenes/office.json -o office.png --shadows sampled --specular traced --light-points 18 "
        "--samples 1 --repeat 8 --reference"};
    builder.finish(e);
    return e;
}

}  // namespace nacre
