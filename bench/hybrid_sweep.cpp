#include "bench/hybrid_sweep.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "core/error.hpp"

namespace nacre::bench {
namespace {

using nlohmann::json;

constexpr const char* kScenes = NACRE_SOURCE_DIR "/demos/scenes/";
constexpr const char* kScannedOffice = NACRE_SOURCE_DIR "/build/data/rooms/office_small.json";  ///< fetched
constexpr double kTracerSeconds = 90;  ///< CPU, an established ray tracer: one bounce, 256² of 2 × 2 samples

/// What the command prints as JSON. \param variables  NAME=value before it, may be empty
json rendered(const std::string& scene, const std::string& options, const std::string& variables = "") {
    const std::filesystem::path picture =
        std::filesystem::temp_directory_path() / fmt::format("nacre-bench-{}.exr", ::getpid());
    const std::string line = fmt::format("{} '{}' render '{}{}' -o '{}' --json --quiet {}", variables, NACRE_COMMAND,
                                         kScenes, scene, picture.string(), options);
    std::FILE* pipe = ::popen(line.c_str(), "r");
    if (pipe == nullptr) throw Error("hybrid: can't start " NACRE_COMMAND);
    std::string text;
    char block[4096];
    while (const std::size_t size = std::fread(block, 1, sizeof block, pipe)) text.append(block, size);
    const int status = ::pclose(pipe);
    std::error_code ignored;
    for (const char* what : {"", "-reference", "-difference"}) {
        std::filesystem::path made = picture;
        made.replace_filename(picture.stem().string() + what + (std::string(what) == "-difference" ? ".png" : ".exr"));
        std::filesystem::remove(made, ignored);
    }
    if (status != 0)
        throw Error(fmt::format("hybrid: expected nacre render to end well, found status {}: {}", status, line));
    return json::parse(text);
}

/// A scene of shadow volumes above all: 25 rings under a lamp of 32 points, with a few virtual lights.
PipeMeasurement pipesOnRings(int pipes, const std::string& compositing, const std::string& variables, int frames) {
    const json data = rendered("rings.json",
                               fmt::format("--shadows volumes --light-points 32 --samples 1 --indirect virtual-lights "
                                           "--virtual-lights 8 --elements 1024 --specular traced --pipes {} "
                                           "--compositing {} --repeat {}",
                                           pipes, compositing, frames),
                               variables)["pipes"];
    PipeMeasurement out{pipes, compositing, data["rasterizer_threads"], data["frame_seconds"], {}};
    for (std::size_t i = 0; i < kHybridPasses.size(); ++i) out.shares[i] = data["shares"][kHybridPasses[i]];
    return out;
}

/// Of a stage: drawn with 512 × 512 samples or fewer, compared as means of them.
HybridMeasurement stageError(const std::string& scene, const std::string& stage, const std::string& knob, int value,
                             const std::string& more, bool quick) {
    const std::string all = fmt::format("--shadows volumes --{} {} {}", knob, value, more);
    HybridMeasurement out{scene, stage, knob, value, 0, 0};
    out.error = rendered(scene, fmt::format("{} --size 64x64 --samples {} --rays {} --reference", all, quick ? 2 : 8,
                                            quick ? 4 : 16))["errors"][stage]["relative_rmse"];
    out.seconds = rendered(scene, fmt::format("{} --size {} --samples 1 --pipes 1 --repeat {}", all,
                                              quick ? "128x128" : "512x512", quick ? 2 : 5))["pipes"]["frame_seconds"];
    return out;
}

/// The medians' ratio, runs taking turns.
double gain(const std::string& one, const std::string& two, int runs, int frames) {
    std::vector<double> before, after;
    for (int i = 0; i < runs; ++i) {
        before.push_back(pipesOnRings(1, "binary-swap", one, frames).seconds);
        after.push_back(pipesOnRings(2, "binary-swap", two, frames).seconds);
    }
    return median(before) / median(after);
}

Bar measured(Bar bar, double value, std::string words) {
    bar.value = value;
    bar.worst = std::move(words);
    bar.measured = true;
    return bar;
}

std::vector<Bar> stageBars(bool quick) {
    const std::string what = "one bounce, Cornell box, 512 x 512, 256 virtual lights";
    Bar error{what, "RMS/mean against rays", 0.05}, speed{what, "times less CPU than a ray tracer", 30, 0, true};
    Bar traced{"traced pixels, mirror and glass box, lamp of 63 points", "relative RMSE on tagged pixels", 0.01};
    const json box = rendered("cornell-box.json",
                              fmt::format("--indirect virtual-lights --virtual-lights 256 --virtual-shadows --shadows "
                                          "volumes --size 64x64 --samples 8 --rays {} --reference",
                                          quick ? 8 : 16));
    const double cpu = box["cpu_seconds"];
    const json glass = rendered("glass-sphere.json",
                                "--specular traced --shadows volumes --light-points 63 --size 96x96 --samples 8 --rays "
                                "16 --reference");
    std::vector<Bar> out{
        measured(error, box["errors"]["indirect"]["rms_over_mean"], "means of 8 x 8 pixels"),
        measured(speed, kTracerSeconds / cpu, fmt::format("{:.2f} CPU-s with start; the tracer's 90 as noted", cpu)),
        measured(traced, glass["errors"]["traced"]["relative_rmse"], "edges of shadows in glass")};
    Bar office{"office, 18 points, 512 x 512", "frames/s", 4, 0, true};
    if (std::filesystem::exists(kScannedOffice)) {
        const json drawn = rendered("office.json",
                                    "--shadows sampled --specular traced --light-points 18 --samples 1 "
                                    "--size 512x512 --repeat 8");
        const std::string method = drawn["shadows"]["method"];
        office = measured(office, drawn["repeated"]["frames_per_second"],
                          fmt::format("by {}, {:.1f} dB", method,
                                      drawn["shadows"][method == "maps" ? "map_psnr" : "volume_psnr"].get<double>()));
    }
    out.push_back(std::move(office));
    return out;
}

}  // namespace

HybridSweep sweepHybrid(const HybridSweepOptions& options) {
    HybridSweep out;
    if (options.loader == nullptr) return out;
    const auto say = [&](const std::string& what) { report(options.progress, "hybrid: " + what, 0); };
    for (const int count : options.quick ? std::vector{16, 64} : std::vector{4, 16, 64, 256}) {
        say(fmt::format("{} virtual lights", count));
        out.errors.push_back(stageError("cornell-box.json", "indirect", "virtual-lights", count,
                                        "--virtual-shadows --indirect virtual-lights", options.quick));
    }
    for (const int count : options.quick ? std::vector{4, 16} : std::vector{1, 4, 16, 63}) {
        say(fmt::format("{} points of the lamp", count));
        out.errors.push_back(
            stageError("soft.json", "direct", "light-points", count, "--specular traced", options.quick));
    }
    for (const int pipes : {1, 2, 4, 8})
        for (const char* compositing : {"binary-swap", "software"}) {
            say(fmt::format("{} pipes, {}", pipes, compositing));
            out.pipes.push_back(pipesOnRings(pipes, compositing, "", options.quick ? 2 : 6));
        }
    return out;
}

std::vector<Bar> measureHybridBars(const HybridSweepOptions& options) {
    const std::string rings = "two pipes against one, 25 rings by volumes";
    Bar counts{"s- and g-counts, exact ends, HYBRID figures 3 to 7", "wrong pixels", 0};
    Bar soft{"soft shadow, 16 points, edge-stopping filter", "PSNR against 1024 rays [dB]", 35, 0, true};
    Bar core{rings + ", a core each", "times faster", 1.6, 0, true};
    Bar free{rings + ", one as it comes", "times faster", 1.6, 0, true};
    std::vector<Bar> out;
    if (options.loader == nullptr) return {counts, soft, core, free};
    report(options.progress, "hybrid: counts of volumes", 0);
    const CountedVerdict v = judgeFigures(*options.loader);
    out.push_back(measured(counts, v.wrong,
                           fmt::format("of {}; with ends that 16 rays find {:.3f} %", v.compared,
                                       100.0 * v.wrongApproximate / v.compared)));
    out.push_back(measured(soft, softShadowPsnr(*options.loader), "ball under a square lamp"));
    report(options.progress, "hybrid: stages against rays", 0);
    for (Bar& bar : stageBars(options.quick)) out.push_back(std::move(bar));
    report(options.progress, "hybrid: two pipes against one", 0);
    const int runs = options.quick ? 1 : 3, frames = options.quick ? 4 : 8;
    out.push_back(
        measured(core, gain("LP_NUM_THREADS=0", "LP_NUM_THREADS=0", runs, frames), "rasterizer in the pipe's thread"));
    out.push_back(measured(free, gain("", "", runs, frames), "whose rasterizer threads have all cores"));
    return out;
}

}  // namespace nacre::bench
