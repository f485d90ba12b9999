// nacre factorize: open, bake, measure what was written, write both.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "cli/data_report.hpp"
#include "cli/output_file.hpp"
#include "cli/terminal.hpp"
#include "cli/verb.hpp"
#include "core/asset.hpp"
#include "core/error.hpp"
#include "core/temporary_files.hpp"
#include "factorize/factorize.hpp"
#include "reference/factored_metrics.hpp"

namespace nacre::cli {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

struct Settings {
    std::string source, output, format = "half";
    FactorizeOptions options;
    bool asJson = false;
};

}  // namespace

static json dataJson(const DataReport& d) {
    json out = {{"entries", d.entries},
                {"missing", d.missing},
                {"negative", d.negative},
                {"non_finite", d.nonFinite},
                {"rule", d.rule}};
    if (d.distinct > 0) {
        out["distinct"] = d.distinct;
        out["holdout_l2_rel"] = d.holdoutL2Rel;
    }
    return out;
}

/// The asset as it comes back from disk: what is measured is what a reader gets.
static Asset throughFile(const Asset& asset, const fs::path& path) {
    writeAsset(asset, path);
    return readAsset(path);
}

static std::string summaryText(const std::string& output, const json& meta) {
    const json& e = meta["error"];
    const auto number = [&](const char* key, const char* format) {  // JSON has no infinity
        return e[key].is_number() ? fmt::format(fmt::runtime(format), e[key].get<double>()) : std::string("none");
    };
    return fmt::format(
        "{}: {} by {}, textures: {}, {}, fetches: {}, {:.2f} s\n"
        "l2_rel {}  log_rms {}  max_rel {}  grazing_l2_rel {}  sphere {} dB  albedo {}\n",
        output, meta.value("form", "?"), meta.value("method", "?"), meta["textures"].size(),
        humanBytes(meta["bytes"].get<std::size_t>()), meta.value("fetches", 0), meta["seconds"].get<double>(),
        number("l2_rel", "{:.4g}"), number("log_rms", "{:.4g}"), number("max_rel", "{:.4g}"),
        number("grazing_l2_rel", "{:.4g}"), number("sphere_psnr", "{:.1f}"), number("albedo_max_abs", "{:.2g}"));
}

static void describe(json& meta, const Context& context, const Settings& s, const Reflectance& reflectance) {
    meta["source"] = reflectance.source;
    meta["source_kind"] = reflectance.kind;
    meta["source_hash"] = reflectance.hash;
    meta["isotropic"] = reflectance.isotropic;
    meta["format"] = s.format;
    meta["command_line"] = context.commandLine;
    if (reflectance.data.entries > 0) meta["data"] = dataJson(reflectance.data);
}

/// An explicit size leaves the search out; the budget holds all the same.
static void requireBudget(const Settings& s, const FactoredBrdf& baked) {
    if (s.options.maxBytes && baked.bytes() > *s.options.maxBytes)
        throw Error(
            fmt::format("{}: expected at most {} bytes, found {}", s.output, *s.options.maxBytes, baked.bytes()));
    if (s.options.maxFetches && baked.fetches > *s.options.maxFetches)
        throw Error(
            fmt::format("{}: expected at most {} fetches, found {}", s.output, *s.options.maxFetches, baked.fetches));
}

static void runFactorize(const Context& context, Settings& s) {
    if (const auto unused = unusedOption(s.options)) throw UsageError("--" + *unused);
    const fs::path provisional = provisionalName(s.output);
    const TemporaryFile removeLater(provisional);
    requireWritable({s.source}, s.output, provisional);

    const Stopwatch baking;
    const Reflectance reflectance = openReflectance(s.source);
    tellDataReport(reflectance);
    const BrdfFunction truth = truthOf(reflectance);
    BrdfMetricOptions metric;
    metric.isotropic = reflectance.isotropic;
    metric.threads = s.options.threads;
    metric.truthEnergy = reflectance.energy;
    s.options.format = texelFormatFromString(s.format);
    s.options.progress = terminalProgress(context.quiet);
    s.options.measure = budgetMeasure(truth, metric);
    const FactoredBrdf baked = factorize(reflectance, s.options);
    const double seconds = baking.seconds();
    endProgress();

    Asset asset = toAsset(baked);
    const Asset written = throughFile(asset, provisional);
    const Stopwatch measuring;
    const FactoredBrdf readBack = factoredFromAsset(written, s.output);
    const BrdfError error = measureBrdf(functionOf(readBack), truth, metric);
    requireBudget(s, baked);
    if (s.options.maxError && !(error.l2Rel <= *s.options.maxError))
        throw Error(fmt::format("{}: expected l2_rel <= {}, found {:.4g}", s.output, *s.options.maxError, error.l2Rel));
    describe(asset.meta, context, s, reflectance);
    asset.meta["seconds"] = seconds;
    asset.meta["measure_seconds"] = measuring.seconds();
    asset.meta["error"] = toJson(error);
    asset.meta["error"]["reciprocity_residual"] = reflectance.reciprocityResidual;
    const json meta = throughFile(asset, s.output).meta;
    if (!(error.l2Rel < 1) || error.negative > 0)
        tell(fmt::format("{}: a poor fit: l2_rel {:.3g} (black scores 1), {} of {} samples negative", s.output,
                         error.l2Rel, error.negative, error.samples));
    if (std::abs(error.energySeen - 1) > kEnergyTolerance)  // false for NaN: nobody counted
        tell(fmt::format(
            "{}: the errors were measured at {} pairs that see {:.3g} % of the energy of {}: a spike of few "
            "cells lies between them, and the errors do not speak of it",
            s.output, error.samples, 100 * error.energySeen, s.source));
    putData(s.asJson ? meta.dump(2) + "\n" : summaryText(s.output, meta));
}

static std::vector<std::string> methodNames() {
    std::vector<std::string> names = {"auto"};
    for (const FactorizeMethod& method : factorizeMethods()) names.push_back(method.name);
    return names;
}

static std::string factorizeDetails() {
    std::string text =
        "SOURCE is a model (nacre models), a published fit (sgd:gold-paint), a MERL .binary, an RGL .bsdf, a .csv of\n"
        "samples wi, wo, rgb, or a micro-geometry (micro:ridges). Methods:\n";
    for (const FactorizeMethod& m : factorizeMethods())
        text += fmt::format("  {:<14} {} [fits: {}]\n", m.name, m.summary, m.fits);
    return text +
           "The error is measured on the file as written, against reference/: l2_rel is relative, 0.017 = 1.7 %.";
}

Verb factorizeVerb(Context& context) {
    const auto s = std::make_shared<Settings>();
    FactorizeOptions& o = s->options;
    const auto size = [&o](long long v) { o.size = static_cast<int>(v); };
    const auto terms = [&o](long long v) { o.terms = static_cast<int>(v); };
    const auto threads = [&o](long long v) { o.threads = static_cast<unsigned>(v); };
    Verb verb{"factorize", "Bake a reflectance into lookup textures", factorizeDetails(), {}, {}};
    verb.options = {
        {"source", "SOURCE", "Model or file", into(s->source), true},
        {"-o,--output", "OUT.exr", "The asset to write", into(s->output), true},
        {"--method", "NAME", "Factorization (default auto)", into(o.method), false, methodNames()},
        {"--size", "N", "Edge of the largest texture, 2 to 4096 (svd: to 256)", integerInto(size, 2, 4096)},
        {"--terms", "K", "Terms of the svd, 1 or 2; harmonics of the fit, 1 to 3", integerInto(terms, 1, 3)},
        {"--parametrization", "NAME", "Of svd", into(o.parametrization), false, {"half_diff", "in_out", "symmetric"}},
        {"--format", "NAME", "Storage (default half)", into(s->format), false, {"half", "float", "unorm8"}},
        {"--max-error", "E", "Budget: largest l2_rel", positiveInto([&o](double v) { o.maxError = v; })},
        {"--max-bytes", "B", "Budget: bytes of all textures",
         integerInto([&o](long long v) { o.maxBytes = static_cast<std::size_t>(v); }, 1, 1ll << 40)},
        {"--max-fetches", "F", "Budget: texture lookups an evaluation",
         integerInto([&o](long long v) { o.maxFetches = static_cast<int>(v); }, 1, 64)},
        {"--threads", "N", "0 = all cores; the same bits for any", integerInto(threads, 0, 1024)},
        {"--json", "", "One JSON object on standard output", into(s->asJson)}};
    verb.run = [s, &context] { runFactorize(context, *s); };
    return verb;
}

}  // namespace nacre::cli
