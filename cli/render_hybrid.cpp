#include "cli/render_hybrid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "cli/numbers.hpp"
#include "cli/output_file.hpp"
#include "cli/picture_output.hpp"
#include "cli/scene_light.hpp"
#include "cli/terminal.hpp"
#include "reference/scene_components.hpp"
#include "shading/context.hpp"
#include "shading/image_output.hpp"

namespace nacre::cli {
namespace {

using nlohmann::json;

/// A picture's stages, as drawn and as traced.
struct Stage {
    std::string name;
    Image drawn, traced;
};

json stagesJson(const HybridReport& report) {
    json out = json::object();
    for (const PassTime& stage : report.stages) out[stage.name] = stage.wallSeconds;
    return out;
}

json reportJson(const HybridReport& report, const HybridPictures& p) {
    json out = {{"stage_seconds", stagesJson(report)}};
    if (p.shadows) {
        const SampledShadowChoice& choice = report.shadows;
        out["shadows"] = {{"method", nameOf(choice.taken)}};
        if (*p.shadows == SampledShadowMethod::Fastest)
            out["shadows"].update({{"map_seconds", choice.mapSeconds},
                                   {"volume_seconds", choice.volumeSeconds},
                                   {"map_psnr", std::min(choice.mapPsnr, 999.0)},
                                   {"volume_psnr", std::min(choice.volumePsnr, 999.0)}});
    }
    if (p.indirect)
        out["virtual_lights"] = {{"elements", report.elements},
                                 {"lights", report.lights},
                                 {"left_out_share", report.leftOut},
                                 {"clamped_share", report.clamped}};
    if (p.traced)
        out["traced"] = {
            {"pixels", report.traced.pixels}, {"ends", report.traced.ends}, {"reused_share", report.traced.reused}};
    return out;
}

/// The same frame again, with programs and casters that are there: the fastest, and its stages.
json repeatedJson(const HybridRenderer& renderer, const std::function<HybridPicture()>& draw, int repeats) {
    json out;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < repeats; ++i) {
        const Stopwatch watch;
        draw();
        const double seconds = watch.seconds();
        if (seconds >= least) continue;
        least = seconds;
        out = {
            {"frames", repeats}, {"frames_per_second", 1 / seconds}, {"stage_seconds", stagesJson(renderer.report())}};
    }
    return out;
}

/// Of pixels all of whose rays meet specular surfaces first.
Image wholly(const Image& tagged) {
    Image out = tagged;
    for (float& share : out.data()) share = share == 1 ? 1.0f : 0.0f;
    return out;
}

json compareStages(const SceneDescription& scene, const HybridPictures& p, std::vector<Stage>& stages,
                   const Progress& progress) {
    SceneTraceOptions options{.width = p.shot.width, .height = p.shot.height, .supersample = p.rays};
    options.time = p.shot.time;
    options.specularDepth = p.switches.specular.depth;
    options.lightDepth = 0;                                     // as it is drawn
    options.lightPoints = std::max(4, 64 / (p.rays * p.rays));  // a pixel has 64, and 256 paths
    options.interreflectionPaths = std::max(16, 256 / (p.rays * p.rays));
    options.progress = progress;
    const Stopwatch watch;
    SceneComponents truth = traceComponents(scene, scene.camera, openTruths(scene, 0, progress), options, p.indirect);
    json out = {{"trace_seconds", watch.seconds()}};
    for (Stage& stage : stages) {
        const bool traced = stage.name == "traced";
        stage.traced = std::move(stage.name == "direct"     ? truth.direct
                                 : stage.name == "indirect" ? truth.indirect
                                 : traced                   ? truth.traced
                                                            : truth.blended);
        const Image mask = traced ? wholly(truth.tagged) : Image();
        out[stage.name] = differenceJson(compareImages(stage.drawn, stage.traced, 1, mask));
    }
    return out;
}

std::string textOf(const json& data) {
    std::string out = fmt::format("{}: {} x {} pixels\n", data["output"].get<std::string>(), data["width"].get<int>(),
                                  data["height"].get<int>());
    if (data.contains("virtual_lights")) {
        const json& v = data["virtual_lights"];
        out += fmt::format("{} virtual lights of {} elements, {:.1f} % of the power left out, {:.1f} % clamped\n",
                           v["lights"].get<int>(), v["elements"].get<int>(), 100 * v["left_out_share"].get<double>(),
                           100 * v["clamped_share"].get<double>());
    }
    if (data.contains("traced")) {
        const json& t = data["traced"];
        out += fmt::format("{} pixels traced, {} paths end, {:.1f} % of them in the picture\n", t["pixels"].get<int>(),
                           t["ends"].get<int>(), 100 * t["reused_share"].get<double>());
    }
    if (data.contains("shadows")) {
        const json& s = data["shadows"];
        out += fmt::format("shadows by {}", s["method"].get<std::string>());
        if (s.contains("map_seconds"))
            out += fmt::format(": maps {:.3f} s, {:.1f} dB; volumes {:.3f} s, {:.1f} dB",
                               s["map_seconds"].get<double>(), s["map_psnr"].get<double>(),
                               s["volume_seconds"].get<double>(), s["volume_psnr"].get<double>());
        out += '\n';
    }
    if (data.contains("repeated"))
        out += fmt::format("drawn again: {:.2f} frames/s\n", data["repeated"]["frames_per_second"].get<double>());
    for (const auto& [name, seconds] : data["stage_seconds"].items())
        out += fmt::format("{:<16} {:8.3f} s\n", name, seconds.get<double>());
    if (!data.contains("errors")) return out;
    for (const auto& [name, e] : data["errors"].items())
        if (e.is_object())
            out += fmt::format("{:<10} PSNR {:6.2f} dB, relative RMSE {:.4f}, RMS/mean {:.4f}\n", name,
                               e["psnr"].get<double>(), e["relative_rmse"].get<double>(),
                               e["rms_over_mean"].get<double>());
    return out;
}

}  // namespace

HybridMaterials materialsOf(const SceneDescription& scene) {
    HybridMaterials out;
    for (const MaterialTruth& truth : openTruths(scene).materials)
        out.brdfs.push_back(truth.bakedBrdf ? truth.bakedBrdf : truth.brdf);
    out.albedos = albedosOf(scene);
    return out;
}

bool isHybrid(const HybridPictures& p) { return p.indirect || p.traced || p.shadows; }

std::vector<Option> hybridOptions(HybridPictures& p) {
    return {{"--indirect", "METHOD", "Add light that another surface reflected, by virtual-lights",
             [&p](const std::string& text) {
                 if (text != "virtual-lights")
                     throw UsageError(fmt::format("expected virtual-lights, found '{}'", text));
                 p.indirect = true;
             }},
            {"--virtual-lights", "N", "At most so many (default 64)",
             integerInto([&p](long long v) { p.lights.count = static_cast<int>(v); }, 1, 65536)},
            {"--virtual-shadows", "", "Surfaces block virtual lights' light", into(p.lights.shadows)},
            {"--virtual-choice", "CHOICE",
             "grouped (default): lights stand for groups of elements; strongest: for those that reflect most, and the\n"
             "rest is left out",
             [&p](const std::string& text) {
                 if (text != "grouped" && text != "strongest")
                     throw UsageError(fmt::format("expected grouped or strongest, found '{}'", text));
                 p.lights.choice = text == "grouped" ? VirtualLightChoice::Grouped : VirtualLightChoice::Strongest;
             }},
            {"--virtual-near", "SHAPE",
             "Near by they are a rectangle (default), a disk or a point, which has a singularity",
             [&p](const std::string& text) {
                 if (text != "rectangle" && text != "disk" && text != "point")
                     throw UsageError(fmt::format("expected rectangle, disk or point, found '{}'", text));
                 p.lights.near = text == "point"  ? NearLight::Point
                                 : text == "disk" ? NearLight::Disk
                                                  : NearLight::Rectangle;
             }},
            {"--elements", "N", "That surfaces are cut into, at least (default 32768)",
             integerInto([&p](long long v) { p.lights.elements.least = static_cast<int>(v); }, 1, 1 << 24)},
            {"--specular", "METHOD",
             "Mirrors and panes by views (default; planar ones), or traced: rays on the CPU, curved ones too",
             [&p](const std::string& text) {
                 if (text != "views" && text != "traced")
                     throw UsageError(fmt::format("expected views or traced, found '{}'", text));
                 p.traced = text == "traced";
             }},
            {"--repeat", "N", "Draw a staged frame so many times again, and print frames/s of the fastest",
             integerInto([&p](long long v) { p.repeats = static_cast<int>(v); }, 1, 1000)},
            {"--stages", "", "Write each stage beside the output, and with --reference its truth", into(p.stages)}};
}

void renderHybrid(const Context& context, SceneDescription scene, const HybridPictures& p) {
    const Progress progress = terminalProgress(context.quiet);
    const nacre::Context gl(GlApi::Core33);
    ProgramLoader loader;
    HybridRenderer renderer(loader, scene, materialsOf(scene));
    renderer.direct().switches = p.switches;
    report(progress, "drawing", 0);
    const Stopwatch watch;
    const int n = p.shot.samples;
    HybridOptions options;
    if (p.indirect) options.virtualLights = p.lights;
    options.traced = p.traced;
    if (p.shadows) options.shadows = {*p.shadows, p.switches.lightPoints};
    const auto draw = [&] { return renderer.draw(n * p.shot.width, n * p.shot.height, options, p.shot.time); };
    const HybridPicture drawn = draw();
    json data = {{"output", p.output},
                 {"width", p.shot.width},
                 {"height", p.shot.height},
                 {"samples", n},
                 {"time", p.shot.time},
                 {"seconds", watch.seconds()},
                 {"cpu_seconds", watch.cpuSeconds()},
                 {"renderer", gl.description()}};
    data.update(reportJson(renderer.report(), p));
    if (p.repeats > 0) data["repeated"] = repeatedJson(renderer, draw, p.repeats);
    std::vector<Stage> stages{{"direct", shrunk(drawn.direct, n), {}}};
    if (p.indirect) stages.push_back({"indirect", shrunk(drawn.indirect, n), {}});
    if (renderer.report().traced.pixels > 0) stages.push_back({"traced", shrunk(drawn.traced, n), {}});
    stages.push_back({"blended", shrunk(drawn.blended, n), {}});
    const Stage& whole = stages.back();
    const std::string ending = pictureEnding(p.output);
    double white = p.white > 0 ? p.white : pictureWhite(whole.drawn);
    writePicture(whole.drawn, p.output, white);  // before the trace: what can't be written fails now
    if (p.reference) {
        data["errors"] = compareStages(scene, p, stages, progress);
        if (p.white <= 0) white = pictureWhite(whole.traced);
        writePicture(whole.drawn, p.output, white);  // both with one white
    }
    endProgress();
    for (const Stage& stage : stages) {
        const bool last = &stage == &whole;
        if (p.stages && !last) writePicture(stage.drawn, besideName(p.output, stage.name.c_str(), ending), white);
        if (!p.reference || (!p.stages && !last)) continue;
        const std::string prefix = last ? "" : stage.name + "-";
        writePicture(stage.traced, besideName(p.output, (prefix + "reference").c_str(), ending), white);
        writePng(differenceImage(stage.drawn, stage.traced, white, 0.2),
                 besideName(p.output, (prefix + "difference").c_str(), ".png"));
    }
    putData(p.asJson ? data.dump(2) + "\n" : textOf(data));
}

}  // namespace nacre::cli
