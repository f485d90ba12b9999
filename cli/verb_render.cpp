// nacre render: a scene drawn without a window, and the same scene traced beside it.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/numbers.hpp"
#include "cli/output_file.hpp"
#include "cli/pass_list.hpp"
#include "cli/picture_output.hpp"
#include "cli/picture_set.hpp"
#include "cli/render_hybrid.hpp"
#include "cli/render_transfer.hpp"
#include "cli/scene_errors.hpp"
#include "cli/scene_light.hpp"
#include "cli/terminal.hpp"
#include "cli/verb.hpp"
#include "core/error.hpp"
#include "shading/context.hpp"
#include "shading/multipass/quality.hpp"
#include "shading/multipass/specular_face.hpp"
#include "shading/scene_file.hpp"

namespace nacre::cli {
namespace {

using nlohmann::json;

struct Settings {
    std::string scene, output;
    SceneShot shot;
    double white = 0;  ///< 0: of the picture
    int rays = 4;
    std::optional<int> lightPaths;
    SceneSwitches switches;
    int quality = 0;
    bool reference = false, shares = false, asJson = false, passes = false;
    HybridPictures hybrid;      ///< when the scene is drawn in stages
    TransferPictures transfer;  ///< when the scene is a transfer file
    std::string weights;
    std::string volumesFlag;              ///< the first option given that only shadow volumes have
    std::string sceneFlag, transferFlag;  ///< the first option given that only scenes have, only transfer files
};

/// An option of one kind of file alone: notes in `flagGiven` that it was given.
std::function<void(const std::string&)> only(std::string& flagGiven, std::string flag,
                                             std::function<void(const std::string&)> take) {
    return [&flagGiven, flag = std::move(flag), take = std::move(take)](const std::string& text) {
        if (flagGiven.empty()) flagGiven = flag;
        take(text);
    };
}

/// "AZIMUTH,ELEVATION"
Vec2 viewOf(const std::string& text) {
    double v[2];
    if (!parseNumbers(text, v) || !std::isfinite(v[0]) || !(std::abs(v[1]) < 90))
        throw UsageError(
            fmt::format("expected AZIMUTH,ELEVATION in degrees, the latter between -90 and 90, found '{}'", text));
    return {v[0], v[1]};
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

json toJson(const SceneErrors& e) {
    json out = {{"white", e.white}, {"all", differenceJson(e.all)}, {"trace_seconds", e.seconds}, {"notes", e.notes}};
    if (e.occluded) out["surrounding_occluded"] = differenceJson(*e.occluded);
    for (const SceneShare& s : e.shares)
        out["shares"].push_back(
            {{"name", s.name}, {"psnr_off", s.psnrOff}, {"psnr_without", s.psnrWithout}, {"share", s.share}});
    return out;
}

std::string errorText(const SceneErrors& e) {
    std::string out = fmt::format(
        "against the reference, traced in {:.1f} s: PSNR {:.2f} dB, relative RMSE {:.4f}, RMS/mean {:.4f}\n", e.seconds,
        e.all.psnrSrgb, e.all.relative, e.all.rmsOverMean);
    if (e.occluded)
        out += fmt::format("  where meshes block the surrounding's light: PSNR {:.2f} dB, relative RMSE {:.4f}\n",
                           e.occluded->psnrSrgb, e.occluded->relative);
    if (e.shares.empty()) return out;
    out += fmt::format("{:<16} {:>14} {:>20} {:>16}\n", "approximation", "PSNR if off", "PSNR without it",
                       "share of error");
    for (const SceneShare& s : e.shares)
        out += fmt::format("{:<16} {:>11.2f} dB {:>17.2f} dB {:>14.1f} %\n", s.name, s.psnrOff, s.psnrWithout,
                           100 * s.share);
    return out;
}

void runTransferFile(const Context& context, const Settings& s) {
    if (!s.sceneFlag.empty())
        throw UsageError(fmt::format("{}: expected a scene, found the transfer file {}", s.sceneFlag, s.scene));
    TransferPictures p = s.transfer;
    p.file = s.scene, p.output = s.output, p.shot = s.shot, p.reference = s.reference, p.asJson = s.asJson;
    p.light.white = s.white;
    takeWeights(p.light, s.weights);
    renderTransfer(context, p);
}

SceneSwitches switchesFor(const Settings& s, const SceneDescription& scene) {
    SceneSwitches out = s.switches;
    out.specular.lightDepth = s.lightPaths.value_or(usualLightDepth(scene));
    return out;
}

void runHybrid(const Context& context, const Settings& s, SceneDescription scene) {
    HybridPictures p = s.hybrid;
    for (const auto& [given, flag] :
         {std::pair(s.shares, "--shares"), {s.shot.interreflection, "--radiosity"}, {s.quality != 0, "--quality"}})
        if (given)
            throw UsageError(fmt::format(
                "{}: expected none of --indirect, --specular traced, sampled shadows and pipes beside it", flag));
    if (s.lightPaths.value_or(0) != 0)
        throw UsageError(fmt::format(
            "--light-paths: expected 0 beside --indirect, --specular traced, sampled shadows and pipes, found {}",
            *s.lightPaths));
    if (!p.traced && hasSpecular(scene))
        throw UsageError(
            fmt::format("{}: expected --specular traced beside it in a scene with mirrors or panes, found none",
                        p.indirect  ? "--indirect"
                        : p.shadows ? "--shadows"
                                    : "--pipes"));
    p.scene = s.scene, p.output = s.output, p.shot = s.shot, p.white = s.white, p.rays = s.rays;
    p.switches = s.switches;
    p.reference = s.reference, p.asJson = s.asJson;
    renderHybrid(context, std::move(scene), p);
}

/// What draws faces that views can't.
void checkPlanar(const SceneDescription& scene) {
    try {
        checkPlanarFaces(scene);
    } catch (const Error& error) {
        throw Error(fmt::format("{}; --specular traced draws curved meshes", error.what()));
    }
}

void runRender(const Context& context, const Settings& s) {
    if (s.output.empty() && !s.passes) throw UsageError("--output: expected a name, found none");
    if (isTransferFile(s.scene)) return runTransferFile(context, s);
    if (!s.transferFlag.empty())
        throw UsageError(
            fmt::format("{}: expected a file that nacre transfer wrote, found {}", s.transferFlag, s.scene));
    const bool sampled = s.hybrid.shadows && s.volumesFlag == "--light-points";
    if (!s.volumesFlag.empty() && !sampled && s.switches.shadowMethod != ShadowMethod::Volumes)
        throw UsageError(s.volumesFlag + ": expected --shadows volumes beside it, found maps");
    checkHybrid(s.hybrid);
    const std::string ending = s.passes ? "" : pictureEnding(s.output);
    const Progress progress = terminalProgress(context.quiet);
    report(progress, "reading " + s.scene, 0);
    SceneOptions reading;
    reading.note = [](const std::string& line) { tell(line); };
    reading.needAssets = !s.passes;
    SceneDescription scene = readScene(s.scene, reading);
    if (s.passes) {
        if (isHybrid(s.hybrid))
            throw UsageError(
                "--passes: expected none of --indirect, --specular traced, sampled shadows and pipes beside it");
        checkPlanar(scene);
        endProgress();
        return putData(passList(scene, s.shot, atQuality(switchesFor(s, scene), s.quality), s.asJson));
    }
    if (isHybrid(s.hybrid)) return runHybrid(context, s, std::move(scene));
    checkPlanar(scene);
    requireWritable(filesOf(scene), s.output, provisionalName(s.output), "");
    const SceneSwitches switches = switchesFor(s, scene);
    const nacre::Context gl(GlApi::Core33);
    ProgramLoader loader;
    SceneRenderer renderer(loader, std::move(scene));
    renderer.switches = atQuality(switches, s.quality);
    json radiosity;
    if (s.shot.interreflection) radiosity = addRadiosity(renderer, s.shot.time, progress);
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
                 {"quality", qualityName(s.quality)},
                 {"specular_views", renderer.schedule().views.size() - 1},
                 {"passes", renderer.schedule().passes.size()},
                 {"programs", renderer.programs().size()},
                 {"renderer", gl.description()}};
    if (s.shot.interreflection) data["radiosity"] = radiosity;
    const int repeats = s.hybrid.pipes.repeat;
    if (repeats > 0)
        data["repeated"] = {{"frames", repeats}, {"frames_per_second", 1 / fastestFrame(renderer, s.shot, repeats)}};
    data["notes"] = lightNotes(renderer.scene(), false, mapsShadows(switches));
    data["light_paths"] = lightCountsJson(renderer.schedule());
    if (s.switches.shadowMethod == ShadowMethod::Volumes || !renderer.schedule().lights.empty())
        data["shadow_volumes"] = volumesJson(renderer.shadowVolumes());
    double white = s.white > 0 ? s.white : pictureWhite(picture);
    std::string text = fmt::format("{}: {} x {} pixels of {} samples, {} programs\n", s.output, s.shot.width,
                                   s.shot.height, s.shot.samples * s.shot.samples, renderer.programs().size()) +
                       notesText(data["notes"]) + repeatedText(data);
    PictureSet pictures;
    if (s.reference || s.shares) {
        renderer.switches = switches;  // whatever the quality, against all
        const SceneErrors errors = measureScene(renderer, picture, s.shot, s.rays, s.shares, progress);
        if (s.white == 0) white = errors.white;
        pictures.add(errors.reference, besideName(s.output, "reference", ending), white);
        pictures.add(differenceImage(picture, errors.reference, errors.white, 0.2),
                     besideName(s.output, "difference", ".png"), 1);
        data["errors"] = toJson(errors);
        text += errorText(errors);
        endProgress();
        for (const std::string& note : errors.notes) tell(note);
    }
    pictures.add(picture, s.output, white);  // both with one white
    pictures.finish();
    endProgress();
    putData(s.asJson ? data.dump(2) + "\n" : text);
}

constexpr const char* kDetails =
    "Scenes: .json, .gltf, .glb, or a mesh file, which gets a camera and a light. EXR holds linear radiance, PNG "
    "is\n"
    "sRGB of radiance over a white, 1.5 times the 90th percentile (of the reference, when there is one).\n"
    "With --reference the same scene is traced from the unbaked sources: OUT-reference beside OUT, and\n"
    "OUT-difference.png, in which white stands for 0.2 in sRGB. Of the difference of picture and reference, PSNR is\n"
    "of sRGB values clamped to [0, 1], in linear radiance relative RMSE is its root mean square over the reference's,\n"
    "RMS/mean over the reference's mean. Where a surrounding lights something a second figure is against a reference\n"
    "whose meshes also block its light and ambient light, which no pass here does.\n"
    "With --shares each approximation is switched off alone: PSNR of the picture without it against the full\n"
    "reference; PSNR of both without it (BRDF: the reference takes the baked one); and the share of the mean "
    "square\n"
    "error that goes with it.\n"
    "With --indirect virtual-lights or --specular traced a scene is drawn in stages: direct light, light that "
    "surfaces\n"
    "reflected once, mirrors and glass by rays on the processor. --reference then traces one such reflection.\n"
    "With --pipes or --mpi several processes draw them together: lamps' points (with --shadows volumes) and virtual\n"
    "lights; sampled shadows are the first's alone. One that dies or is late is left out: if the last frame lacks\n"
    "its light, the exit code is 1.\n"
    "  mpirun -n 2 nacre render office.json -o o.png --indirect virtual-lights --specular traced --shadows volumes "
    "--mpi\n"
    "A file of nacre transfer holds its mesh: its frames are drawn by their vertices' radiance (albedo 1, back faces\n"
    "black) in the light of --env, turned and blended, with the first frame's white. With --reference the same\n"
    "vertices' transfer comes from rays.\n"
    "Example: a second of the cloth while the light turns a quarter:\n"
    "  nacre transfer cloth -o cloth.tv --frames 0:30\n"
    "  nacre render cloth.tv -o cloth_###.png --env city.hdr --turn 90";

std::vector<Option> sceneOptions(const std::shared_ptr<Settings>& s) {
    return {
        {"--time", "S", "Seconds into a scene's animation (default 0)",
         only(s->sceneFlag, "--time", finiteInto(s->shot.time))},
        {"--depth", "N", "Mirrors and panes along a path from the eye (default 4)",
         only(s->sceneFlag, "--depth",
              integerInto([s](long long v) { s->switches.specular.depth = static_cast<int>(v); }, 0, 1000))},
        {"--quality", "LEVEL",
         "full (default), high, medium, low or least: how deep mirrors and panes go, whether glass reflects, samples "
         "of\n"
         "frosted faces and of lights' areas",
         only(s->sceneFlag, "--quality", [s](const std::string& text) { s->quality = qualityOf(text); })},
        {"--light-paths", "N",
         "Mirrors and panes along a path from a light that has shadows, 0 to 4 (default 2; 0 with voxel volumes,\n"
         "--indirect, --specular traced and sampled shadows)",
         only(s->sceneFlag, "--light-paths",
              integerInto([s](long long v) { s->lightPaths = static_cast<int>(v); }, 0, kMostLightBounces))},
        {"--passes", "", "Print the passes that draw a scene, and draw nothing",
         only(s->sceneFlag, "--passes", into(s->passes))},
        {"--rays", "N", "Of a scene's reference: N x N rays a pixel (default 4)",
         only(s->sceneFlag, "--rays", integerInto([s](long long v) { s->rays = static_cast<int>(v); }, 1, 16))},
        {"--shadows", "METHOD",
         "Of lights that have shadows: maps (default; areas count as their middle) or volumes, exact to the pixel; or "
         "of\n"
         "each pixel before it is lit, smoothed, the light itself from an area's middle: sampled-maps, "
         "sampled-volumes, sampled (the faster one that is right)",
         only(s->sceneFlag, "--shadows",
              [s](const std::string& text) {
                  s->hybrid.shadows = sampledShadowsOf(text);
                  if (!s->hybrid.shadows) s->switches.shadowMethod = shadowMethodOf(text);
                  s->hybrid.counted = !s->hybrid.shadows && s->switches.shadowMethod == ShadowMethod::Volumes;
              })},
        {"--light-points", "N", "Points of a light's area, not with maps: 1 to 63 (default 16)",
         only(s->sceneFlag, "--light-points",
              only(s->volumesFlag, "--light-points",
                   integerInto([s](long long v) { s->switches.lightPoints = static_cast<int>(v); }, 1, 63)))},
        {"--soft", "METHOD",
         "With volumes, of a light's area: regenerated (default), pivot (volumes of its middle swept from each\n"
         "point) or levels (the middle's light dimmed by the count)",
         only(s->sceneFlag, "--soft",
              only(s->volumesFlag, "--soft",
                   [s](const std::string& text) { s->switches.softShadows = softShadowsOf(text); }))},
        {"--radiosity", "", "Add light that bounced between meshes, as colours of their vertices; the reference too",
         only(s->sceneFlag, "--radiosity", into(s->shot.interreflection))},
        {"--shares", "", "Each approximation's share of a scene's error; implies --reference",
         only(s->sceneFlag, "--shares", into(s->shares))}};
}

std::vector<Option> transferOptions(const std::shared_ptr<Settings>& s) {
    TransferPictures& t = s->transfer;
    const auto own = [s](const char* flag, const char* value, const char* summary,
                         std::function<void(const std::string&)> take) {
        return Option{flag, value, summary, only(s->transferFlag, flag, std::move(take))};
    };
    Option environments =
        own("--env", "FILE", "Radiance map that lights; may be repeated, and is blended (default: white)",
            [&t](const std::string& given) { t.light.files.push_back(given); });
    environments.repeats = true;
    return {
        own("--frame", "N", "Frame to draw (default the first)",
            integerInto(
                [&t](long long v) {
                    t.frames = {static_cast<int>(v), static_cast<int>(v) + 1};
                },
                0, 1 << 30)),
        own("--frames", "A:B", "Frames A to B - 1, one picture each: OUT has a row of # for the number",
            [&t](const std::string& given) { t.frames = parseFrames(given); }),
        environments,
        own("--weights", "W,W,...", "Of each --env (default equal, of sum 1)", into(s->weights)),
        own("--turned", "DEGREES", "The light's turn about y, from +z towards +x (default 0)", finiteInto(t.fromDeg)),
        own("--turn", "DEGREES", "And so far more in a second (default 0)", finiteInto(t.light.turnDeg)),
        own("--view", "AZ,EL", "Seen from there, degrees from +z towards +x and up (default 19.3,20.7)",
            [&t](const std::string& given) { t.viewDeg = viewOf(given); }),
        own("--vertex-rays", "N", "Of the reference, a vertex (default 1024)",
            integerInto([&t](long long v) { t.rays = static_cast<std::size_t>(v); }, 1, 1 << 24))};
}

std::vector<Option> options(const std::shared_ptr<Settings>& s) {
    std::vector<Option> out = {
        {"scene", "FILE", "The scene, or a file that nacre transfer wrote", into(s->scene), true},
        {"-o,--output", "OUT", "The picture to write, .exr or .png", into(s->output)},
        {"--size", "WxH", "Pixels (default 512x512)", [s](const std::string& text) { takeSize(s->shot, text); }},
        {"--samples", "N", "N x N shaded samples a pixel (default 2)",
         integerInto([s](long long v) { s->shot.samples = static_cast<int>(v); }, 1, 8)},
        {"--white", "W", "Radiance shown as white in PNG", positiveInto([s](double v) { s->white = v; })},
        {"--reference", "",
         "Trace the same, and print the error and the time that it took: minutes where there are many panes, less "
         "with\n"
         "a smaller --size, fewer --rays and --light-paths 0 or 1",
         into(s->reference)}};
    for (Option& option : sceneOptions(s)) out.push_back(std::move(option));
    for (Option& option : hybridOptions(s->hybrid)) {
        option.take = only(s->sceneFlag, option.flags, std::move(option.take));
        out.push_back(std::move(option));
    }
    for (Option& option : transferOptions(s)) out.push_back(std::move(option));
    out.push_back({"--json", "", "One JSON object on standard output", into(s->asJson)});
    return out;
}

}  // namespace

Verb renderVerb(Context& context) {
    const auto s = std::make_shared<Settings>();
    Verb verb{"render",
              "Draw a scene, or the frames of a transfer file, beside the same by rays, with the error between both",
              kDetails,
              options(s),
              {}};
    verb.run = [s, &context] { runRender(context, *s); };
    return verb;
}

}  // namespace nacre::cli
