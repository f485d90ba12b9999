// nacre render: a scene drawn without a window, and the same scene traced beside it.
#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/numbers.hpp"
#include "cli/output_file.hpp"
#include "cli/scene_errors.hpp"
#include "cli/terminal.hpp"
#include "cli/verb.hpp"
#include "core/error.hpp"
#include "shading/context.hpp"
#include "shading/image_output.hpp"
#include "shading/multipass/pass_schedule.hpp"
#include "shading/scene_bounds.hpp"
#include "shading/scene_file.hpp"

namespace nacre::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Settings {
    std::string scene, output;
    SceneShot shot;
    double white = 0;  ///< 0: of the picture
    int rays = 4;
    SpecularOptions specular;
    bool reference = false, shares = false, asJson = false, passes = false;
};

std::string endingOf(const std::string& output) {
    std::string ending = fs::path(output).extension().string();
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (ending != ".exr" && ending != ".png")
        throw UsageError(fmt::format("-o: expected a name that ends in .exr or .png, found '{}'", output));
    return ending;
}

/// NAME.exr -> NAME-reference.exr
std::string beside(const std::string& output, const char* what, const std::string& ending) {
    const fs::path path(output);
    return (path.parent_path() / (path.stem().string() + "-" + what + ending)).string();
}

void write(const Image& image, const std::string& output, double white) {
    if (endingOf(output) == ".exr")
        writeExr(image, output);
    else
        writePng(image, output, {white});
}

void takeSize(SceneShot& shot, const std::string& text) {
    const auto x = text.find('x');
    const auto number = [&](std::string_view part) {
        int value = 0;
        const auto [end, failure] = std::from_chars(part.data(), part.data() + part.size(), value);
        const bool whole = failure == std::errc{} && end == part.data() + part.size();
        if (x == std::string::npos || !whole || value < 1 || value > 16384)
            throw UsageError(fmt::format("expected WIDTHxHEIGHT of 1 to 16384 pixels, found '{}'", text));
        return value;
    };
    shot.width = number(std::string_view(text).substr(0, x));
    shot.height = number(std::string_view(text).substr(x == std::string::npos ? text.size() : x + 1));
}

json differenceJson(const ImageDifference& d) {
    return {{"psnr", d.psnrSrgb}, {"psnr_linear", d.psnrLinear}, {"relative_rmse", d.relative}, {"max_abs", d.maxAbs}};
}

json toJson(const SceneErrors& e) {
    json out = {{"white", e.white},
                {"all", differenceJson(e.all)},
                {"surrounding_occluded", differenceJson(e.occluded)},
                {"trace_seconds", e.seconds},
                {"notes", e.notes}};
    for (const SceneShare& s : e.shares)
        out["shares"].push_back(
            {{"name", s.name}, {"psnr_off", s.psnrOff}, {"psnr_without", s.psnrWithout}, {"share", s.share}});
    return out;
}

std::string errorText(const SceneErrors& e) {
    std::string out =
        fmt::format("against the reference: PSNR {:.2f} dB, relative RMSE {:.4f}\n", e.all.psnrSrgb, e.all.relative);
    out += fmt::format("  where meshes block the surrounding's light: PSNR {:.2f} dB, relative RMSE {:.4f}\n",
                       e.occluded.psnrSrgb, e.occluded.relative);
    if (e.shares.empty()) return out;
    out += fmt::format("{:<16} {:>14} {:>20} {:>16}\n", "approximation", "PSNR if off", "PSNR without it",
                       "share of error");
    for (const SceneShare& s : e.shares)
        out += fmt::format("{:<16} {:>11.2f} dB {:>17.2f} dB {:>14.1f} %\n", s.name, s.psnrOff, s.psnrWithout,
                           100 * s.share);
    return out;
}

json passesJson(const PassSchedule& schedule) {
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

/// The list alone, which takes no OpenGL.
void printPasses(const SceneDescription& scene, const Settings& s) {
    const SceneBounds box = boundsAt(scene, s.shot.time);
    const int n = s.shot.samples;
    const PassSchedule schedule =
        makeSchedule(specularFaces(scene, nodeTransforms(scene, s.shot.time)),
                     {scene.camera, n * s.shot.width, n * s.shot.height, box.low, box.high}, s.specular);
    std::vector<std::string> names;
    for (const SceneNode& node : scene.nodes) names.push_back(node.name);
    putData(s.asJson ? passesJson(schedule).dump(2) + "\n" : passListText(schedule, names));
}

void runRender(const Context& context, const Settings& s) {
    if (s.output.empty() && !s.passes) throw UsageError("expected --output, or --passes, found neither");
    const std::string ending = s.passes ? "" : endingOf(s.output);
    const Progress progress = terminalProgress(context.quiet);
    report(progress, "reading " + s.scene, 0);
    SceneOptions reading;
    reading.note = [](const std::string& line) { tell(line); };
    reading.needAssets = !s.passes;
    SceneDescription scene = readScene(s.scene, reading);
    if (s.passes) {
        endProgress();
        checkSpecular(scene);
        return printPasses(scene, s);
    }
    const nacre::Context gl(GlApi::Core33);
    ProgramLoader loader;
    SceneRenderer renderer(loader, std::move(scene));
    renderer.switches.specular = s.specular;
    report(progress, "drawing", 0);
    const Stopwatch watch;
    const Image picture = shoot(renderer, s.shot);
    const double seconds = watch.seconds();
    json data = {{"output", s.output},
                 {"width", s.shot.width},
                 {"height", s.shot.height},
                 {"samples", s.shot.samples},
                 {"time", s.shot.time},
                 {"seconds", seconds},
                 {"programs", renderer.programs().size()},
                 {"renderer", gl.description()}};
    double white = s.white > 0 ? s.white : pictureWhite(picture);
    std::string text = fmt::format("{}: {} x {} pixels of {} samples, {} programs\n", s.output, s.shot.width,
                                   s.shot.height, s.shot.samples * s.shot.samples, renderer.programs().size());
    write(picture, s.output, white);  // before the trace: what can't be written fails now
    if (s.reference || s.shares) {
        const SceneErrors errors = measureScene(renderer, picture, s.shot, s.rays, s.shares, progress);
        if (s.white == 0) white = errors.white;
        write(errors.reference, beside(s.output, "reference", ending), white);
        writePng(differenceImage(picture, errors.reference, errors.white, 0.2), beside(s.output, "difference", ".png"));
        data["errors"] = toJson(errors);
        text += errorText(errors);
        endProgress();
        for (const std::string& note : errors.notes) tell(note);
    }
    if (s.reference || s.shares) write(picture, s.output, white);  // both with one white
    endProgress();
    putData(s.asJson ? data.dump(2) + "\n" : text);
}

}  // namespace

Verb renderVerb(Context& context) {
    const auto s = std::make_shared<Settings>();
    Verb verb{"render", "Draw a scene, and the same scene ray-traced, with the error between both", "", {}, {}};
    verb.details =
        "Scenes: .json, .gltf, .glb, or a mesh file, which gets a camera and a light. EXR holds linear radiance, PNG "
        "is\n"
        "sRGB of radiance over a white, 1.5 times the 90th percentile (of the reference, when there is one).\n"
        "With --reference the same scene is traced from the unbaked sources: OUT-reference beside OUT, and\n"
        "OUT-difference.png, in which white stands for 0.2 in sRGB. PSNR is of sRGB values clamped to [0, 1]. A "
        "second\n"
        "figure is against a reference whose meshes also block the surrounding's light, which no pass here does.\n"
        "With --shares each approximation is switched off alone: PSNR of the picture without it against the full\n"
        "reference; PSNR of both without it (BRDF: the reference takes the baked one); and the share of the mean "
        "square\n"
        "error that goes with it.";
    verb.options = {
        {"scene", "FILE", "The scene", into(s->scene), true},
        {"-o,--output", "OUT", "The picture to write, .exr or .png", into(s->output)},
        {"--size", "WxH", "Pixels (default 512x512)", [s](const std::string& text) { takeSize(s->shot, text); }},
        {"--samples", "N", "N x N shaded samples a pixel (default 2)",
         integerInto([s](long long v) { s->shot.samples = static_cast<int>(v); }, 1, 8)},
        {"--time", "S", "Seconds into the animation (default 0)",
         [s](const std::string& text) {
             double v[1];
             if (!parseNumbers(text, v) || !std::isfinite(v[0]))
                 throw UsageError(fmt::format("expected a finite number, found '{}'", text));
             s->shot.time = v[0];
         }},
        {"--depth", "N", "Mirrors and panes along a path (default 4)",
         integerInto([s](long long v) { s->specular.depth = static_cast<int>(v); }, 0, 1000)},
        {"--passes", "", "Print the passes that draw the scene, and draw nothing", into(s->passes)},
        {"--white", "W", "Radiance shown as white in PNG", positiveInto([s](double v) { s->white = v; })},
        {"--reference", "", "Trace the same scene, and print the error", into(s->reference)},
        {"--rays", "N", "Of the reference: N x N rays a pixel (default 4)",
         integerInto([s](long long v) { s->rays = static_cast<int>(v); }, 1, 16)},
        {"--shares", "", "Each approximation's share of the error; implies --reference", into(s->shares)},
        {"--json", "", "One JSON object on standard output", into(s->asJson)}};
    verb.run = [s, &context] { runRender(context, *s); };
    return verb;
}

}  // namespace nacre::cli
