// nacre envmap: read, prefilter or convert, write, measure what was written.
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>

#include "cli/envmap_lobes.hpp"
#include "cli/output_file.hpp"
#include "cli/terminal.hpp"
#include "cli/verb.hpp"
#include "core/asset.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/temporary_files.hpp"
#include "envmaps/convert.hpp"
#include "envmaps/env_asset.hpp"
#include "envmaps/export_dds.hpp"
#include "envmaps/export_ktx2.hpp"
#include "envmaps/source.hpp"

namespace nacre::cli {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

struct Settings {
    std::string source, output, sourceLayout = "auto", negative = "clamp", layout, format = "float", scale = "1",
                                exporting;
    SourceOptions in;
    LobeSettings lobes;
    int size = 0;  ///< 0 = as fine as the source
    double yawDeg = 0;
    bool convert = false, asJson = false;
};

}  // namespace

static json rgbJson(const Rgb& c) { return json::array({c.r, c.g, c.b}); }

/// What had to be done to the source's texels goes to standard error, also when --quiet.
static void tellReport(const SourceReport& r) {
    const TexelReport& t = r.texels;
    if (t.negative > 0)
        tell(fmt::format("{}: {} of {} texels negative: {}", r.path, t.negative, t.texels,
                         r.negative == NegativePolicy::Keep
                             ? std::string("kept")
                             : fmt::format("clamped to 0, {:.3g} % of the energy removed", t.energyRemovedPercent)));
    if (t.nonFinite > 0)
        tell(fmt::format("{}: {} of {} texels not finite: replaced by the mean of their finite neighbours", r.path,
                         t.nonFinite, t.texels));
    if (t.overflowed > 0)
        tell(fmt::format("{}: {} of {} texels at 65504 or above, the end of half floats: the source may be clipped",
                         r.path, t.overflowed, t.texels));
    if (r.srgbDecoded) tell(fmt::format("{}: {} values taken as sRGB: no high dynamic range", r.path, r.sampleType));
}

/// The levels that are asked for, and how prefiltered ones were made.
static LobeBake makeLevels(const Context& context, const Settings& s, const EnvMap& source) {
    if (s.convert == !s.lobes.lobe.empty()) throw UsageError("expected what to make: --convert, or --lobe NAME");
    if (const std::string option = anyLobeOption(s.lobes); s.convert && !option.empty())
        throw UsageError(fmt::format("{}: --convert doesn't take it", option));
    const EnvLayout layout = s.layout.empty() ? source.layout : envLayoutFromString(s.layout);
    const int size = s.size ? s.size : matchingSize(source, layout);
    if (s.convert) return {EnvChain(convertEnv(source, layout, size, s.in.threads)), {}, nullptr};
    PrefilterOptions options;
    options.threads = s.in.threads;
    options.progress = terminalProgress(context.quiet);
    LobeBake out = bakeLobes(s.lobes, source, layout, size, texelFormatFromString(s.format), options);
    endProgress();
    return out;
}

static double scaleOf(const Settings& s, const EnvChain& chain) {
    if (s.scale == "auto") return scaleForHalf(chain);
    double scale = 0;
    const auto [end, failure] = std::from_chars(s.scale.data(), s.scale.data() + s.scale.size(), scale);
    if (failure != std::errc{} || end != s.scale.data() + s.scale.size() || !std::isfinite(scale) || scale <= 0)
        throw UsageError(fmt::format("--scale: expected auto or a finite number > 0, found '{}'", s.scale));
    return scale;
}

/// A single level gets the mip maps that engines expect, each averaged from the finest.
static std::vector<EnvMap> mipMaps(const EnvChain& chain, unsigned threads) {
    std::vector<EnvMap> levels = chain.levels;
    if (levels.size() > 1) return levels;
    for (int size = levels[0].size() / 2; size >= 1; size /= 2)
        levels.push_back(convertEnv(levels[0], EnvLayout::Cube, size, threads));
    return levels;
}

/// OUT.exr's name with the export's ending.
static fs::path exportPath(const Settings& s) { return fs::path(s.output).replace_extension(s.exporting); }

static json writeExport(const Settings& s, const EnvChain& chain, double scale) {
    const std::vector<EnvMap> levels = mipMaps(chain, s.in.threads);
    const std::string bytes = s.exporting == "dds" ? ddsBytes(levels, {scale}) : ktx2Bytes(levels, {scale});
    writeFile(exportPath(s), bytes);
    return {{"path", exportPath(s).string()}, {"format", s.exporting}, {"levels", levels.size()},
            {"bytes", bytes.size()},          {"scale", scale},        {"faces", "gl"}};
}

static void describe(json& meta, const Context& context, const Settings& s, const SourceReport& report) {
    meta["source"] = s.source;
    meta["source_hash"] = report.hash;
    meta["flip"] = report.flip;
    meta["yaw_deg"] = s.yawDeg;
    meta["input"] = toJson(report);
    meta["format"] = s.format;
    meta["command_line"] = context.commandLine;
}

/// One line a level.
static std::string lobesText(const json& meta) {
    std::string text;
    for (std::size_t m = 0; m < meta["lobes"].size(); ++m) {
        const json& level = meta["lobes"][m];
        text += fmt::format("  {:>4}  {}", level["size"].get<int>(), level["lobe"].get<std::string>());
        for (const char* key : {"exponent", "alpha", "alpha_y", "ior"})
            if (level.contains(key)) text += fmt::format("  {} {:.5g}", key, level[key].get<double>());
        if (level.contains("harmonics_cut")) text += "  (sharp edge: beyond the tolerance)";
        if (meta["error"].contains("levels") && meta["error"]["levels"][m].is_object()) {
            const json& e = meta["error"]["levels"][m];
            text += fmt::format("  rmse {:.2g}  p95 {:.2g}  max {:.2g}  filtered {:.2g}", e["rmse"].get<double>(),
                                e["p95"].get<double>(), e["max"].get<double>(), e["filtered_rmse"].get<double>());
        }
        text += "\n";
    }
    if (meta["error"].is_null()) return text + "  (--verify measures their error)\n";
    if (!meta["error"].contains("levels"))
        text +=
            fmt::format("  filtered {:.2g}, the worst of all levels\n", meta["error"]["filtered_rmse"].get<double>());
    return text;
}

static std::string summaryText(const Settings& s, const json& meta) {
    const json& e = meta["energy"];
    std::string text =
        fmt::format("{}: {} {}, levels: {}, {}, {:.2f} s ({:.2f} CPU)\n", s.output, meta["layout"].get<std::string>(),
                    meta["size"].get<int>(), meta["levels"].get<int>(), humanBytes(meta["bytes"].get<std::size_t>()),
                    meta["seconds"].get<double>(), meta["cpu_seconds"].get<double>());
    if (meta.contains("lobes"))
        text += lobesText(meta);
    else
        text += fmt::format("energy in {:.6g}  out {:.6g}  error {:.2g}\n", mean({e["in"][0], e["in"][1], e["in"][2]}),
                            mean({e["out"][0], e["out"][1], e["out"][2]}),
                            e["error"].is_number() ? e["error"].get<double>() : NAN);
    if (meta.contains("export"))
        text +=
            fmt::format("{}: {} levels, {}\n", meta["export"]["path"].get<std::string>(),
                        meta["export"]["levels"].get<int>(), humanBytes(meta["export"]["bytes"].get<std::size_t>()));
    return text;
}

/// Σ L dω before and after, as the file holds it. \return the largest component's difference over the largest energy
static json energyJson(const EnvMap& source, const EnvMap& written, unsigned threads) {
    const Rgb in = envEnergy(source, threads), out = envEnergy(written, threads);
    const double all = maxComponent(glm::abs(in));
    return {
        {"in", rgbJson(in)}, {"out", rgbJson(out)}, {"error", all > 0 ? maxComponent(glm::abs(out - in)) / all : 0}};
}

/// A scale that pushes radiance below the smallest half floats loses it.
static void requireScaleFits(const Settings& s, const EnvChain& chain, const EnvChain& written) {
    constexpr double kRounding = 1e-3;
    const Rgb before = envEnergy(chain.levels[0], s.in.threads), after = envEnergy(written.levels[0], s.in.threads);
    if (maxComponent(glm::abs(after - before)) > kRounding * maxComponent(glm::abs(before)))
        throw Error(fmt::format(
            "{}: expected a --scale that half floats can follow, found {}, by which {:.3g} % of the "
            "energy is lost",
            s.output, s.scale, 100 * maxComponent(glm::abs(after - before)) / maxComponent(glm::abs(before))));
}

static void runEnvmap(const Context& context, Settings& s) {
    const fs::path provisional = provisionalName(s.output);
    const TemporaryFile removeLater(provisional);
    requireWritable({s.source}, s.output, provisional);
    s.in.layout = sourceLayoutFromString(s.sourceLayout);
    s.in.negative = negativePolicyFromString(s.negative);
    s.in.yaw = s.yawDeg * kPi / 180;

    const Stopwatch reading;
    const Environment environment = readEnvironment(s.source, s.in);
    tellReport(environment.report);
    const double readSeconds = reading.seconds();
    const Stopwatch baking;
    const LobeBake bake = makeLevels(context, s, environment.map);
    const EnvChain& chain = bake.chain;
    const double seconds = baking.seconds(), cpuSeconds = baking.cpuSeconds();
    if (!s.exporting.empty() && chain.levels[0].layout != EnvLayout::Cube)
        throw UsageError(fmt::format("--export: expected --layout cube, found {}", toString(chain.levels[0].layout)));

    const double scale = scaleOf(s, chain);
    Asset asset = toAsset(chain, {texelFormatFromString(s.format), scale});
    describe(asset.meta, context, s, environment.report);
    asset.meta["scale"] = scale;
    asset.meta["read_seconds"] = readSeconds;
    asset.meta["seconds"] = seconds;
    asset.meta["cpu_seconds"] = cpuSeconds;
    // What is measured is what a reader gets.
    writeAsset(asset, provisional);
    const EnvChain written = envFromAsset(readAsset(provisional), s.output);
    asset.meta["energy"] = energyJson(environment.map, written.levels[0], s.in.threads);
    requireScaleFits(s, chain, written);
    if (!s.lobes.lobe.empty()) {
        asset.meta["lobe"] = s.lobes.lobe;
        asset.meta["lobes"] = bake.levels;
        asset.meta["error"] = s.lobes.verify ? verifyLobes(s.lobes, environment.map, written, s.in.threads,
                                                           terminalProgress(context.quiet))
                                             : bake.error;
        endProgress();
    }
    if (!s.exporting.empty()) asset.meta["export"] = writeExport(s, chain, scale);
    writeAsset(asset, s.output);
    const json meta = readAsset(s.output).meta;
    putData(s.asJson ? meta.dump(2) + "\n" : summaryText(s, meta));
}

static std::function<void(const std::string&)> degreesInto(double& target) {
    return [&target](const std::string& text) {
        const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), target);
        if (failure != std::errc{} || end != text.data() + text.size() || !std::isfinite(target))
            throw UsageError(fmt::format("expected a finite number of degrees, found '{}'", text));
    };
}

static constexpr const char* kDetails =
    "SOURCE is an OpenEXR, Radiance or any other picture, a nacre asset, a name with %s for six faces (px nx py ny pz "
    "nz),\n"
    "or a folder with such files. Layouts of files: 2:1 latlong, 1:6 and 6:1 cube_strip and cube_row, 4:3 and 3:4\n"
    "cube_hcross and cube_vcross, found by proportions or OpenEXR's envmap attribute; angular, mirror_ball, octahedral "
    "and\n"
    "dual_paraboloid have to be named. Faces lie as in OpenEXR or, mirrored, as in OpenGL; --faces auto takes the "
    "attribute's\n"
    "word or the reading whose seams fit. The world is right-handed, y up, -z ahead (the left and right edge of "
    "latlong).\n"
    "Conversion averages by solid angle: energy = the sum of radiance x solid angle, of the source and of the file "
    "written.\n"
    "A prefiltered map holds at r the average of the radiance weighted by the lobe about r, so that white gives 1: "
    "look\n"
    "it up with the mirrored viewer (phong, ggx, beckmann), the normal (diffuse: irradiance/pi) or the refracted "
    "viewer.\n"
    "A chain's usual values: exponents 2^(10(1-t)+1), alphas p^2 with p(2-p) = t, t = 0 to 1.\n"
    "--verify prints rmse, p95 and max of the error at texel centres, and filtered: the rmse between them, through "
    "the\n"
    "bilinear filter, all relative to the mean. Mirror levels aren't measured.\n"
    "Half floats end at 65504: brighter texels are an error in --format half and in exports, unless --scale is given.";

Verb envmapVerb(Context& context) {
    const auto s = std::make_shared<Settings>();
    const std::vector<std::string> layouts = {"latlong", "cube", "dual_paraboloid", "octahedral"};
    Verb verb{"envmap", "Prefilter a radiance map with a lobe, or convert its layout and size", kDetails, {}, {}};
    verb.options = {
        {"source", "SOURCE", "Picture, six pictures, or asset", into(s->source), true},
        {"-o,--output", "OUT.exr", "The asset to write", into(s->output), true},
        {"--convert", "", "Change layout and size, average by solid angle", into(s->convert)},
        {"--layout", "NAME", "Of the result (default: the source's)", into(s->layout), false, layouts},
        {"--size", "N", "latlong 2N x N, cube faces N x N, others N x N (default: as fine as the source)",
         integerInto([s](long long v) { s->size = static_cast<int>(v); }, 1, 4096)},
        {"--source-layout", "NAME", "Of the source (default auto)", into(s->sourceLayout), false, sourceLayoutNames()},
        {"--faces",
         "NAME",
         "How a source's cube faces lie (default auto)",
         into(s->in.faces),
         false,
         {"auto", "openexr", "gl"}},
        {"--flip", "AXIS", "x: left and right exchanged; y: upside down", into(s->in.flip), false, {"none", "x", "y"}},
        {"--yaw", "DEGREES", "Turn the surrounding about y, from +z towards +x, after --flip", degreesInto(s->yawDeg)},
        {"--negative",
         "RULE",
         "For negative texels (default clamp); error: for non-finite ones too",
         into(s->negative),
         false,
         {"keep", "clamp", "error"}},
        {"--format",
         "NAME",
         "Storage (default float; half rounds each texel by up to 1/2048)",
         into(s->format),
         false,
         {"half", "float"}},
        {"--scale", "S", "The file holds radiance / S; auto: a power of two that fits half floats", into(s->scale)},
        {"--export",
         "NAME",
         "Also write OUT.ktx2 or OUT.dds: a half-float cube with mip maps, for engines",
         into(s->exporting),
         false,
         {"ktx2", "dds"}},
        {"--threads", "N", "0 = all cores; the same bits for any",
         integerInto([s](long long v) { s->in.threads = static_cast<unsigned>(v); }, 0, 1024)},
        {"--json", "", "One JSON object on standard output", into(s->asJson)}};
    const std::vector<Option> lobes = lobeOptions(s->lobes);
    verb.options.insert(verb.options.begin() + 2, lobes.begin(), lobes.end());
    verb.run = [s, &context] { runEnvmap(context, *s); };
    return verb;
}

}  // namespace nacre::cli
