// nacre bump: read a height field, bake what is asked for, measure it as stored, write both.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>

#include "bump/read_height.hpp"
#include "cli/bump_bake.hpp"
#include "cli/numbers.hpp"
#include "cli/output_file.hpp"
#include "cli/terminal.hpp"
#include "cli/verb.hpp"
#include "core/asset.hpp"
#include "core/error.hpp"
#include "core/temporary_files.hpp"

namespace nacre::cli {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

struct Settings {
    std::string source, output, wrap = "repeat", format = "half", fit;
    std::optional<int> directions;
    std::optional<double> scale, texelSize;
    HeightOptions in;
    BumpRequest wanted;
    std::string light, albedo, lightFlag;  ///< lightFlag: the first option given that only --indirect takes
    bool asJson = false;
};

/// What was found in the source that its owner may not expect goes to standard error, also when --quiet.
void tellReport(const HeightReport& r, const Settings& s, const HeightMap& map) {
    if (r.holes > 0)
        tell(fmt::format("{}: {} of {} texels are holes (no data)", r.path, r.holes, map.heights.texelCount()));
    if (r.unit == 1 && r.sampleType.find("int") != std::string::npos && !s.texelSize && !s.scale)
        tell(fmt::format("{}: numbers taken as heights in texels; --texel-size says how long a texel's edge is",
                         r.path));
    if (r.unit != 1 && !s.scale && !s.texelSize) {
        const HeightRange range = heightRange(map);
        tell(
            fmt::format("{}: {} codes taken as 0 to 1, so the relief is {:.3g} texels high; --scale says how high 1 is",
                        r.path, r.sampleType, range.high - range.low));
    }
}

/// "x,y,z" or, of colours, one number for all three.
Vec3 threeNumbers(const std::string& flag, const std::string& text, bool one) {
    double v[3];
    if (parseNumbers(text, v)) return {v[0], v[1], v[2]};
    double single[1];
    if (!one || !parseNumbers(text, single))
        throw UsageError(fmt::format("{}: expected {}three numbers separated by commas, found '{}'", flag,
                                     one ? "one number or " : "", text));
    return Vec3(single[0]);
}

ScatteredLightOptions lightOf(const Settings& s) {
    ScatteredLightOptions out = s.wanted.light;
    out.light = s.light.empty() ? Vec3(0.6, 0, 0.8) : threeNumbers("--light", s.light, false);
    if (!isFinite(out.light) || !(out.light.z > 0))
        throw UsageError(fmt::format("--light: expected a direction above the plane (z > 0), found '{}'", s.light));
    out.light = glm::normalize(out.light);
    if (!s.albedo.empty()) out.albedo = threeNumbers("--albedo", s.albedo, true);
    if (!isFinite(out.albedo) || glm::any(glm::lessThan(out.albedo, Rgb(0))) ||
        glm::any(glm::greaterThan(out.albedo, Rgb(1))))
        throw UsageError(fmt::format("--albedo: expected numbers from 0 to 1, found '{}'", s.albedo));
    return out;
}

/// The request with its defaults. \throws UsageError for options without what they belong to
BumpRequest requestOf(const Settings& s) {
    BumpRequest out = s.wanted;
    out.normals = out.normals || out.roughness;
    if (!out.normals && !out.ellipses && out.horizon == 0 && out.scatter == 0 && !out.indirect)
        out.normals = out.ellipses = true;
    if (out.maxError && out.ellipses && out.horizon > 0)
        throw UsageError("--max-error: chooses the shadows, so expected --ellipses or --horizon, found both");
    if (out.maxError && !out.ellipses && out.horizon == 0)
        throw UsageError("--max-error: expected --ellipses or --horizon, whose shadows it is about, found neither");
    for (const auto& [flag, given] : {std::pair{"--directions", s.directions.has_value()}, {"--fit", !s.fit.empty()}})
        if (given && !out.ellipses) throw UsageError(fmt::format("{}: only --ellipses takes it", flag));
    if (!s.lightFlag.empty() && !out.indirect)
        throw UsageError(fmt::format("{}: only --indirect takes it", s.lightFlag));
    if (out.indirect) out.light = lightOf(s);
    out.light.threads = out.threads;
    out.format = texelFormatFromString(s.format);
    if (out.scatter > 0 && out.format == TexelFormat::Unorm8)
        throw UsageError("--format: --scatter takes half or float, found unorm8");
    out.fit.fit = s.fit == "radii" ? EllipseFit::Radii : EllipseFit::Full;
    out.fit.directions = s.directions.value_or(out.fit.directions);
    out.fit.threads = out.threads;
    return out;
}

void describe(json& meta, const Context& context, const Settings& s, const BumpRequest& request,
              const HeightField& field, const BumpBake& bake) {
    const HeightReport& r = field.report;
    const HeightRange range = heightRange(field.map);
    meta["source"] = s.source;
    meta["source_hash"] = r.hash;
    meta["input"] = toJson(r);
    meta["scale"] = r.scale;
    meta["texel_size"] = r.texelSize;
    const double first = r.file.low * r.unit * r.scale, last = r.file.high * r.unit * r.scale;
    meta["height_range"] = {std::min(first, last), std::max(first, last)};
    meta["height_range_texels"] = {range.low, range.high};
    meta["holes"] = r.holes;
    meta["format"] = s.format;
    meta["command_line"] = context.commandLine;
    if (bake.maps.ellipses)
        meta["ellipse_fit"] = {{"fit", bake.fit.fit == EllipseFit::Radii ? "radii" : "full"},
                               {"directions", bake.fit.directions}};
    if (bake.maps.indirect) {
        const ScatteredLightOptions& l = request.light;
        meta["light"] = {{"direction", {l.light.x, l.light.y, l.light.z}},
                         {"albedo", {l.albedo.x, l.albedo.y, l.albedo.z}},
                         {"bounces", l.bounces},
                         {"paths", l.paths}};
    }
    meta["times"] = bake.times;
    meta["seconds"] = bake.seconds;
    meta["cpu_seconds"] = bake.cpuSeconds;
    if (s.wanted.maxError) meta["search_seconds"] = bake.searchSeconds;
}

std::string rateText(const json& meta, const char* technique, const char* rate, const char* what) {
    const json& times = meta["times"][technique];
    return fmt::format("  {:.3g} M {}/s  {:.2f} s\n", times[rate].get<double>() / 1e6, what,
                       times["seconds"].get<double>());
}

std::string summaryText(const Settings& s, const json& meta) {
    std::string text = fmt::format(
        "{}: {} x {} texels, heights {:.6g} to {:.6g} ({:.4g} texels high), {}, {:.2f} s ({:.2f} CPU)\n", s.output,
        meta["size"][0].get<int>(), meta["size"][1].get<int>(), meta["height_range"][0].get<double>(),
        meta["height_range"][1].get<double>(),
        meta["height_range_texels"][1].get<double>() - meta["height_range_texels"][0].get<double>(),
        humanBytes(meta["bytes"].get<std::size_t>()), meta["seconds"].get<double>(), meta["cpu_seconds"].get<double>());
    if (meta.contains("normal_levels"))
        text += fmt::format("  normals   {} levels{}\n", meta["normal_levels"].get<int>(),
                            meta.contains("roughness") ? ", roughness" : "");
    const json& error = meta["error"];
    const auto number = [](const json& e, const char* key) { return e[key].get<double>(); };
    if (error.contains("ellipses")) {
        const json& e = error["ellipses"];
        text += fmt::format("  ellipses  {} directions  misjudged {:.4g} (radii only {:.4g}, all lit {:.4g})",
                            meta["ellipse_fit"]["directions"].get<int>(), number(e, "misjudged"),
                            number(e, "misjudged_radii_only"), number(e, "dark"));
        text += rateText(meta, "ellipses", "texels_per_second", "texels");
    }
    if (error.contains("horizon")) {
        const json& e = error["horizon"];
        text += fmt::format(
            "  horizon   {} azimuths  rmse {:.3g} deg  max {:.3g} rad  within 1e-3 {:.4g}  misjudged {:.4g}",
            meta["azimuths"].get<int>(), number(e, "rmse_deg"), number(e, "max_rad"), number(e, "share_within_1e-3"),
            number(e, "misjudged"));
        text += rateText(meta, "horizon", "horizons_per_second", "horizons");
    }
    if (error.contains("scatter")) {
        const json& e = error["scatter"];
        text += fmt::format("  scatter   {} directions  hit mismatch {:.3g}  beyond a texel {:.3g}",
                            meta["directions"].size(), number(e, "hit_mismatch"), number(e, "beyond_one_texel"));
        text += rateText(meta, "scatter", "rays_per_second", "rays");
    }
    if (error.contains("indirect")) {
        const json& e = error["indirect"];
        text += fmt::format(
            "  indirect  {} bounces, {} paths  relative rmse {:.3g}, with direct light {:.3g}  {:.2f} s\n",
            meta["light"]["bounces"].get<int>(), meta["light"]["paths"].get<int>(), number(e, "relative_rmse"),
            number(e, "relative_rmse_total"), meta["times"]["indirect"]["seconds"].get<double>());
    }
    return text;
}

void runBump(const Context& context, const Settings& s) {
    const BumpRequest request = requestOf(s);
    HeightOptions in = s.in;
    in.wrap = wrapFromString(s.wrap);
    in.scale = s.scale.value_or(1);
    in.texelSize = s.texelSize.value_or(1);
    const fs::path provisional = provisionalName(s.output);
    const TemporaryFile removeLater(provisional);
    requireWritable({s.source}, s.output, provisional);

    const Progress progress = terminalProgress(context.quiet);
    const Stopwatch reading;
    const HeightField field = readHeight(s.source, in);
    tellReport(field.report, s, field.map);
    const double readSeconds = reading.seconds();
    BumpBake bake = bakeBump(field.map, request, s.output, progress);
    if (request.ellipses && !bake.maps.ellipses)
        tell(fmt::format("{}: no ellipses are within --max-error {:g}: a horizon map of {} azimuths is", s.output,
                         *request.maxError, bake.maps.horizons->azimuths()));
    Asset asset = toAsset(bake.maps, request.format);
    describe(asset.meta, context, s, request, field, bake);
    asset.meta["read_seconds"] = readSeconds;
    const Stopwatch measuring;
    // What is measured is what a reader gets.
    const BumpMaps stored = bumpFromAsset(asset, s.output);
    asset.meta["error"] = measureBump(field.map, stored, bake.fit, request.format, progress);
    if (stored.indirect) {
        bake.light.indirect = *stored.indirect;
        asset.meta["error"]["indirect"] = measureIndirect(field.map, bake.light, request.light, progress);
    }
    asset.meta["measure_seconds"] = measuring.seconds();
    endProgress();
    writeAsset(asset, s.output);
    const json meta = readAsset(s.output).meta;
    putData(s.asJson ? meta.dump(2) + "\n" : summaryText(s, meta));
}

/// Finite, of either sign, not 0; or also NaN.
std::function<void(const std::string&)> numberInto(std::function<void(double)> store, bool zero, bool nan) {
    return [=](const std::string& text) {
        double value = 0;
        const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool good = failure == std::errc{} && end == text.data() + text.size() && !std::isinf(value) &&
                          (zero || value != 0) && (nan || !std::isnan(value));
        if (!good)
            throw UsageError(fmt::format("expected {}, found '{}'",
                                         nan ? "a finite number or nan" : "a finite number other than 0", text));
        store(value);
    };
}

constexpr const char* kDetails =
    "HEIGHT is a picture of heights: 8- or 16-bit PNG, BMP, TIFF, GeoTIFF, OpenEXR and what OpenImageIO reads. Codes "
    "are\n"
    "taken as they are, never sRGB-decoded: unsigned 8- and 16-bit codes as code / largest code, 0 to 1; signed and "
    "32-bit\n"
    "integers (elevation models) and floats as their numbers. Height = S times that; --texel-size is a texel's edge in "
    "the\n"
    "same unit (default 1), so that slopes and shadows are those of the real relief. --scale 65535 takes 16-bit codes "
    "as\n"
    "they are. Colours need --channel unless R = G = B. NaN is an error unless --nodata nan; a GeoTIFF's own nodata "
    "number\n"
    "makes holes too. Holes cast no shadow and are lit by any light above the plane.\n"
    "u runs along columns, v along rows from row 0, the file's first row; z points out of the surface, and directions "
    "are\n"
    "(x, y, z) = (along u, along v, out). Between four texel centres the surface is their bilinear patch; beyond the "
    "border\n"
    "it goes on as --wrap says.\n"
    "Outputs (default --normals --ellipses); each texture is addressed by uv:\n"
    "  --normals     x, y, z with levels that keep the mean slope; --roughness adds alpha, alpha^2 = 2 x the variance "
    "of\n"
    "                the slopes that a level has lost\n"
    "  --horizon K   elevation [rad] of the horizon towards the azimuths 2 pi k / K from u to v\n"
    "  --ellipses    the directions that see the sky as one ellipse, 1 - |M (lx, ly) + o|^2 >= 0: lit; and their "
    "share\n"
    "  --scatter M   for M directions (in the JSON), distance along the plane [texels] to the point seen, -1 = none\n"
    "  --indirect    radiance (RGB) that leaves each texel after light has bounced, for one light of irradiance 1 on "
    "a\n"
    "                surface that faces it, matt texels: a texture for that light alone, to be added to direct light\n"
    "Error, of what is stored, against rays over the same surface: at texel centres: ellipses misjudged = the share of "
    "pairs (texel, "
    "light\n"
    "weighted by the cosine) called lit wrongly or dark wrongly, misjudged_radii_only = the same with radii alone "
    "fitted;\n"
    "horizon max_rad, share_within_1e-3, rmse_deg; scatter hit_mismatch, beyond_one_texel; indirect relative_rmse "
    "against\n"
    "traced paths, alone and with direct light (relative_rmse_total).\n"
    "--max-error E: shadows with at most E misjudged, by the first of ellipses of 32, 64, ... directions (up to "
    "--directions) and horizon "
    "maps\n"
    "of 8, 16, ... 256 azimuths (with --horizon K: horizon maps up to K) that gets there.\n"
    "Examples: a picture whose white is 24 texels high; an elevation model in metres with texels of 90 m:\n"
    "  nacre bump rock.png -o rock.exr --scale 24 --ellipses --normals --roughness\n"
    "  nacre bump elevation.tif -o hills.exr --texel-size 90 --wrap clamp --horizon 16";

}  // namespace

Verb bumpVerb(Context& context) {
    const auto s = std::make_shared<Settings>();
    BumpRequest& w = s->wanted;
    const auto ofLight = [s](const std::string& flag, std::function<void(const std::string&)> take) {
        return [s, flag, take](const std::string& text) {
            if (s->lightFlag.empty()) s->lightFlag = flag;
            take(text);
        };
    };
    Verb verb{"bump",
              "Bake a height field: normals, horizons, shadow ellipses, scatter maps, bounced light",
              kDetails,
              {},
              {}};
    verb.options = {
        {"source", "HEIGHT", "Picture of heights", into(s->source), true},
        {"-o,--output", "OUT.exr", "The asset to write", into(s->output), true},
        {"--normals", "", "Tangent-space normals with levels", into(w.normals)},
        {"--roughness", "", "Normals with the roughness of lost slopes in alpha", into(w.roughness)},
        {"--horizon", "K", "Horizon map of K azimuths",
         integerInto([&w](long long v) { w.horizon = static_cast<int>(v); }, 1, 256)},
        {"--ellipses", "", "Horizon ellipses", into(w.ellipses)},
        {"--directions", "N", "Azimuths that each ellipse is fitted to (default 128)",
         integerInto([s](long long v) { s->directions = static_cast<int>(v); }, 8, 4096)},
        {"--fit",
         "NAME",
         "Of ellipses: centre, axis and radii (full, default), or the paper's radii alone",
         into(s->fit),
         false,
         {"full", "radii"}},
        {"--scatter", "M", "Scatter map of M directions",
         integerInto([&w](long long v) { w.scatter = static_cast<int>(v); }, 1, 256)},
        {"--indirect", "", "Light of one lamp that has bounced", into(w.indirect)},
        {"--light", "X,Y,Z", "Of --indirect: towards the lamp, any length (default 0.6,0,0.8)",
         ofLight("--light", into(s->light))},
        {"--albedo", "A", "Of --indirect: one number or r,g,b, 0 to 1 (default 0.7)",
         ofLight("--albedo", into(s->albedo))},
        {"--bounces", "B", "Of --indirect: how often light is reflected before the texel (default 3)",
         ofLight("--bounces", integerInto([&w](long long v) { w.light.bounces = static_cast<int>(v); }, 0, 16))},
        {"--paths", "P", "Of --indirect (default 100): more take longer and err less",
         ofLight("--paths", integerInto([&w](long long v) { w.light.paths = static_cast<int>(v); }, 1, 100000))},
        {"--heights", "", "Store the heights too, so that eval knows the truth without the source", into(w.heights)},
        {"--scale", "S", "Height of the number 1; negative: upside down (default 1)",
         numberInto([s](double v) { s->scale = v; }, false, false)},
        {"--texel-size", "T", "Edge of a texel, in the heights' unit (default 1)",
         positiveInto([s](double v) { s->texelSize = v; })},
        {"--wrap", "NAME", "Beyond the border (default repeat)", into(s->wrap), false, {"repeat", "clamp", "mirror"}},
        {"--nodata", "V", "Texels with this number in the file, or nan, are holes",
         numberInto([s](double v) { s->in.nodata = v; }, true, true)},
        {"--channel",
         "NAME",
         "Of colour pictures: r, g, b, a, or y, the luminance",
         into(s->in.channel),
         false,
         {"auto", "r", "g", "b", "a", "y"}},
        {"--format", "NAME", "Storage (default half)", into(s->format), false, {"half", "float", "unorm8"}},
        {"--max-error", "E", "Budget: share of shadows misjudged", positiveInto([&w](double v) {
             constexpr double kLeast = 1.0 / kBumpSamples;
             if (v > 1 || v < kLeast)
                 throw UsageError(fmt::format(
                     "expected a share from {:g}, which the samples can tell, to 1, found {:g}", kLeast, v));
             w.maxError = v;
         })},
        {"--max-bytes", "B", "Budget: bytes of all textures",
         integerInto([&w](long long v) { w.maxBytes = static_cast<std::size_t>(v); }, 1, 1ll << 40)},
        {"--threads", "N", "0 = all cores; the same bits for any",
         integerInto([&w](long long v) { w.threads = static_cast<unsigned>(v); }, 0, 1024)},
        {"--json", "", "One JSON object on standard output", into(s->asJson)}};
    verb.run = [s, &context] { runBump(context, *s); };
    return verb;
}

}  // namespace nacre::cli
