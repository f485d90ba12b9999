// nacre_bench: bakes every material and every surrounding with every method, measures error and cost, and writes the
// report.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <thread>

#include "bench/environment_bars.hpp"
#include "bench/environment_gpu.hpp"
#include "bench/report.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/version.hpp"
#include "shading/context.hpp"

namespace nacre::bench {
namespace {

namespace fs = std::filesystem;

struct Arguments {
    std::string out = "build/bench", shared;
    std::vector<int> sourceSizes;
    std::vector<std::string> materials,
        techniques = {"factored", "environment", "bump", "shadow", "transfer", "specular", "hybrid"};
    std::string scenes = NACRE_SCENE_FOLDER;
    bool quick = false, barsOnly = false, noBars = false, noGpu = false, quiet = false, list = false;
};

/// $NACRE_SHARED, else ../shared beside the working folder.
std::string defaultShared() {
    const char* shared = std::getenv("NACRE_SHARED");
    return shared != nullptr ? shared : "../shared";
}

std::string machineWords() {
    std::ifstream cpu("/proc/cpuinfo");
    for (std::string line; std::getline(cpu, line);)
        if (line.rfind("model name", 0) == 0)
            return fmt::format("{}, {} cores", line.substr(std::min(line.find(": "), line.size() - 2) + 2),
                               std::thread::hardware_concurrency());
    return fmt::format("{} cores", std::thread::hardware_concurrency());
}

Progress progressOn(bool quiet) {
    if (quiet) return {};
    return [terminal = isatty(2) != 0](const std::string& what, double) {
        fmt::print(stderr, "{}bench: {}{}", terminal ? "\r\033[K" : "", what, terminal ? "" : "\n");
        std::fflush(stderr);
    };
}

/// What needs OpenGL, or nothing and a note.
template <class Gpu, class... Options>
std::optional<Gpu> openGpu(const Arguments& arguments, std::vector<std::string>& notes, Options... options) {
    if (arguments.noGpu) return std::nullopt;
    try {
        return std::optional<Gpu>(std::in_place, options...);
    } catch (const Error& error) {
        notes.push_back(std::string("No OpenGL, so nothing of it is measured: ") + error.what());
        return std::nullopt;
    }
}

struct HeadlessGpu {
    Context context;
    ProgramLoader loader;
};

bool isMeasured(const std::vector<Measurement>& list, const Material& material, const Setting& setting) {
    return std::any_of(list.begin(), list.end(), [&](const Measurement& m) {
        return m.material.name == material.name && text(m.setting) == text(setting);
    });
}

/// By the promised figures, at more texels.
bool isMeasured(const std::vector<EnvironmentMeasurement>& list, const EnvironmentMeasurement& m) {
    return std::any_of(list.begin(), list.end(), [&](const EnvironmentMeasurement& o) {
        return o.surrounding == m.surrounding && o.chain == m.chain && o.sourceSize == m.sourceSize &&
               o.method == m.method && o.setting == m.setting;
    });
}

/// Every setting of one material that isn't measured yet. A setting that gives what an earlier one of the method gave
/// is dropped.
void sweep(const Material& material, bool quick, GpuLab* lab, const Progress& progress, std::vector<Measurement>& out) {
    const OpenMaterial opened = open(material);
    const std::size_t first = out.size();
    for (const Setting& setting : sweepSettings(quick, opened.reflectance.isotropic)) {
        if (isMeasured(out, material, setting)) continue;
        report(progress, material.name + ": " + text(setting), 0);
        std::optional<Baked> baked;
        try {
            baked = bake(material, opened, setting, quick ? 50000 : 200000);
        } catch (const Error& error) {
            report(progress, std::string("no bake: ") + error.what(), 0);
        }
        if (!baked) continue;
        const Measurement& m = baked->measurement;
        const bool seen =
            std::any_of(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(), [&](const Measurement& o) {
                return o.setting.method == m.setting.method && o.bytes == m.bytes && o.fetches == m.fetches &&
                       o.error.l2Rel == m.error.l2Rel;
            });
        if (seen) continue;
        out.push_back(m);
        if (lab) out.back().cost = lab->cost(baked->brdf, opened.reflectance);
    }
}

void writeReport(const Report& report, const fs::path& folder) {
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed) throw Error(folder.string() + ": expected a folder to write to, found: " + failed.message());
    writeFile(folder / "report.json", reportJson(report).dump(1) + "\n");
    writeFile(folder / "index.html", reportPage(report));
}

bool wants(const Arguments& arguments, const std::string& technique) {
    const std::vector<std::string>& list = arguments.techniques;
    return std::find(list.begin(), list.end(), technique) != list.end();
}

void runFactored(const Arguments& arguments, const MaterialList& list, const Progress& progress, Report& report) {
    report.notes.insert(report.notes.end(), list.notes.begin(), list.notes.end());
    std::optional<GpuLab> lab = openGpu<GpuLab>(arguments, report.notes, arguments.quick ? 5 : 11);
    GpuLab* const gpu = lab ? &*lab : nullptr;
    if (lab) report.renderer = lab->description();
    if (!arguments.noBars) report.bars = measureBars(list.materials, gpu, {.progress = progress}, &report.measurements);
    if (arguments.barsOnly) return;
    for (const Material& m : list.materials) sweep(m, arguments.quick, gpu, progress, report.measurements);
}

/// A quick run's bars: the 256 source alone, fewer samples.
void runEnvironment(const Arguments& arguments, const Progress& progress, Report& report) {
    const SurroundingList list = benchSurroundings();
    report.notes.insert(report.notes.end(), list.notes.begin(), list.notes.end());
    if (!arguments.noBars) {
        EnvironmentBarOptions options;
        options.progress = progress;
        if (arguments.quick) options.samples = 40, options.large = false;
        const std::vector<Bar> bars = measureEnvironmentBars(list.surroundings, options, &report.environments);
        report.bars.insert(report.bars.end(), bars.begin(), bars.end());
    }
    if (arguments.barsOnly) return;
    std::optional<EnvironmentGpu> gpu = openGpu<EnvironmentGpu>(arguments, report.notes);
    if (gpu && report.renderer.empty()) report.renderer = gpu->description();
    for (EnvironmentMeasurement& m : sweepEnvironments(
             list.surroundings, {arguments.quick, arguments.sourceSizes, gpu ? &*gpu : nullptr, progress}))
        if (!isMeasured(report.environments, m)) report.environments.push_back(std::move(m));
}

void runBump(const Arguments& arguments, const Progress& progress, Report& report) {
    const ReliefList list = benchReliefs();
    report.notes.insert(report.notes.end(), list.notes.begin(), list.notes.end());
    if (!arguments.noBars) {
        std::optional<HeadlessGpu> gpu = openGpu<HeadlessGpu>(arguments, report.notes);
        const std::vector<Bar> bars =
            measureBumpBars(list.reliefs, {!arguments.quick, gpu ? &gpu->loader : nullptr, progress});
        report.bars.insert(report.bars.end(), bars.begin(), bars.end());
    }
    if (!arguments.barsOnly) report.bumps = sweepReliefs(list.reliefs, {arguments.quick, progress});
}

void runShadow(const Arguments& arguments, const Progress& progress, Report& report) {
    const ShadowSceneList list = shadowScenes();
    report.notes.insert(report.notes.end(), list.notes.begin(), list.notes.end());
    std::optional<HeadlessGpu> gpu = openGpu<HeadlessGpu>(arguments, report.notes);
    const ShadowSweepOptions options{arguments.quick, gpu ? &gpu->loader : nullptr, progress};
    if (!arguments.noBars) {
        const std::vector<Bar> bars = measureShadowBars(list.scenes, options);
        report.bars.insert(report.bars.end(), bars.begin(), bars.end());
    }
    if (!arguments.barsOnly) report.shadows = sweepShadows(list.scenes, options);
}

/// A quick run: two meshes, few settings, fewer rays of the truth.
void runTransfer(const Arguments& arguments, const Progress& progress, Report& report) {
    const TransferMeshList list = transferMeshes(animatedFolder(), arguments.quick);
    report.notes.insert(report.notes.end(), list.notes.begin(), list.notes.end());
    TransferSweepOptions options;
    options.progress = progress;
    if (arguments.quick) options.quick = true, options.repeats = 3, options.sampled = 60, options.rays = 8192;
    if (!arguments.noBars) {
        const std::vector<Bar> bars = measureTransferBars(list.meshes, options);
        report.bars.insert(report.bars.end(), bars.begin(), bars.end());
    }
    if (!arguments.barsOnly) report.transfers = sweepTransfer(list.meshes, options);
}

void runSpecular(const Arguments& arguments, const Progress& progress, Report& report) {
    std::optional<HeadlessGpu> gpu = openGpu<HeadlessGpu>(arguments, report.notes);
    if (gpu && report.renderer.empty()) report.renderer = gpu->context.description();
    const SpecularSweepOptions options{arguments.quick, gpu ? &gpu->loader : nullptr, arguments.scenes, progress};
    if (!arguments.noBars) {
        const std::vector<Bar> bars = measureSpecularBars(options);
        report.bars.insert(report.bars.end(), bars.begin(), bars.end());
    }
    if (!arguments.barsOnly) report.speculars = sweepSpecular(options);
}

void runHybrid(const Arguments& arguments, const Progress& progress, Report& report) {
    std::optional<HeadlessGpu> gpu = openGpu<HeadlessGpu>(arguments, report.notes);
    const HybridSweepOptions options{arguments.quick, gpu ? &gpu->loader : nullptr, progress};
    if (!arguments.noBars) {
        const std::vector<Bar> bars = measureHybridBars(options);
        report.bars.insert(report.bars.end(), bars.begin(), bars.end());
    }
    if (!arguments.barsOnly) report.hybrid = sweepHybrid(options);
}

int run(const Arguments& arguments) {
    const auto start = std::chrono::steady_clock::now();
    const Progress progress = progressOn(arguments.quiet);
    Report report;
    report.version = nacreVersion();
    report.machine = machineWords();
    report.quick = arguments.quick;
    if (arguments.list || wants(arguments, "factored")) {
        const MaterialList list = benchMaterials({.shared = arguments.shared,
                                                  .cache = fs::path(arguments.out) / "merl",
                                                  .quick = arguments.quick,
                                                  .only = arguments.materials,
                                                  .progress = progress});
        if (arguments.list) {
            for (const Material& m : list.materials) fmt::print("{}\t{}\n", m.name, m.source);
            return 0;
        }
        runFactored(arguments, list, progress, report);
    }
    if (wants(arguments, "environment")) runEnvironment(arguments, progress, report);
    if (wants(arguments, "bump")) runBump(arguments, progress, report);
    if (wants(arguments, "shadow")) runShadow(arguments, progress, report);
    if (wants(arguments, "transfer")) runTransfer(arguments, progress, report);
    if (wants(arguments, "specular")) runSpecular(arguments, progress, report);
    if (wants(arguments, "hybrid")) runHybrid(arguments, progress, report);
    report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!arguments.quiet && isatty(2) != 0) fmt::print(stderr, "\r\033[K");
    fmt::print("{}", barTable(report.bars));
    if (arguments.barsOnly) return 0;
    writeReport(report, arguments.out);
    if (!arguments.quiet)
        fmt::print(stderr, "bench: {} bakes in {:.0f} s: {}\n",
                   report.measurements.size() + report.environments.size() + report.bumps.size() +
                       report.shadows.size() + report.transfers.size() + report.speculars.size(),
                   report.seconds, (fs::path(arguments.out) / "index.html").string());
    return 0;
}

}  // namespace
}  // namespace nacre::bench

int main(int argc, char** argv) {
    nacre::bench::Arguments arguments;
    arguments.shared = nacre::bench::defaultShared();
    CLI::App app(
        "Measures error and cost of every factorization, of prefiltered environments, of reliefs, of "
        "shadows, of transfer, of specular views and of hybrid rendering; writes "
        "report.json and index.html.");
    app.add_option("--out", arguments.out, "folder to write")->capture_default_str();
    app.add_option("--shared", arguments.shared, "folder with data/brdf and tools, for measured materials")
        ->capture_default_str();
    app.add_option("--techniques", arguments.techniques,
                   "only these: factored, environment, bump, shadow, transfer, specular, hybrid")
        ->check(CLI::IsMember({"factored", "environment", "bump", "shadow", "transfer", "specular", "hybrid"}));
    app.add_option("--scenes", arguments.scenes, "folder with demos/scenes' files, for specular views")
        ->capture_default_str();
    app.add_option("--source-sizes", arguments.sourceSizes, "of the environments' curves: edges of the source cube")
        ->check(CLI::IsMember({32, 64, 128, 256, 512, 1024, 2048}));
    app.add_option("--materials", arguments.materials, "only these (names as --list prints them)");
    app.add_flag("--quick", arguments.quick, "few materials and settings: a minute or two");
    app.add_flag("--bars", arguments.barsOnly, "print the promised figures as PASS or MISS, and nothing else");
    app.add_flag("--no-bars", arguments.noBars, "leave the promised figures out");
    app.add_flag("--no-gpu", arguments.noGpu, "no frame times");
    app.add_flag("--list", arguments.list, "print the materials");
    app.add_flag("--quiet", arguments.quiet, "no progress");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        return nacre::bench::run(arguments);
    } catch (const std::invalid_argument& error) {
        fmt::print(stderr, "nacre_bench: {}\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        fmt::print(stderr, "nacre_bench: {}\n", error.what());
        return 1;
    }
}
