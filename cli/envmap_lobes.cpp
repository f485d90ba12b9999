#include "cli/envmap_lobes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/numbers.hpp"
#include "core/error.hpp"
#include "reference/environment_error.hpp"

namespace nacre::cli {

using nlohmann::json;

std::vector<Option> lobeOptions(LobeSettings& s) {
    const auto number = [](std::optional<double>& target) { return positiveInto([&target](double v) { target = v; }); };
    const auto exponent = [&s](const std::string& text) {
        double value = 0;
        if (!parseNumbers(text, {&value, 1}) || !std::isfinite(value) || value < 0)
            throw UsageError(fmt::format("expected a finite number >= 0, found '{}'", text));
        s.exponent = value;
    };
    return {{"--lobe", "NAME", "Prefilter with this lobe", into(s.lobe), false, lobeNames()},
            {"--exponent", "N", "Of phong: 1/r of HSE eq. 6, >= 0", exponent},
            {"--alpha", "A", "Of ggx, beckmann and their refractions: width of the slopes, in (0, 1]", number(s.alpha)},
            {"--ior", "N", "Of a refraction: index beyond the surface over the viewer's side", number(s.ior)},
            {"--chain", "LEVELS", "Levels of growing roughness, each half the size of the one before",
             integerInto([&s](long long v) { s.chain = static_cast<int>(v); }, 2, 16)},
            {"--values", "V0,V1,…", "Of the chain's levels: exponents or alphas (0 = mirror)", into(s.values)},
            {"--tolerance", "T", "Largest root mean square error that the method aims at (default 6e-4)",
             number(s.tolerance)},
            {"--max-error", "E", "Budget: largest error through the filter, root mean square over the mean",
             number(s.maxError)},
            {"--max-bytes", "B", "Budget: bytes of all levels",
             integerInto([&s](long long v) { s.maxBytes = static_cast<std::size_t>(v); }, 1, 1ll << 40)},
            {"--verify", "", "Measure every level against the sum over all texels", into(s.verify)},
            {"--samples", "N", "Texels, and directions, that --verify looks at (default 300)",
             integerInto([&s](long long v) { s.samples = static_cast<int>(v); }, 1, 1000000)}};
}

namespace {

bool refracts(LobeKind kind) { return kind == LobeKind::GgxRefraction || kind == LobeKind::BeckmannRefraction; }

void refuseUnused(const LobeSettings& s, LobeKind kind) {
    const auto refuse = [&](bool isSet, bool isUsed, const char* flag) {
        if (isSet && !isUsed) throw UsageError(fmt::format("{}: the lobe {} doesn't take it", flag, s.lobe));
    };
    refuse(s.exponent.has_value(), kind == LobeKind::Phong, "--exponent");
    refuse(s.alpha.has_value(), usesAlpha(kind), "--alpha");
    refuse(s.ior.has_value(), refracts(kind), "--ior");
    refuse(s.chain > 0, kind == LobeKind::Phong || usesAlpha(kind), "--chain");
    refuse(!s.values.empty(), s.chain > 0 || kind == LobeKind::Phong || usesAlpha(kind), "--values");
    const bool chained = s.chain > 0 || !s.values.empty();
    refuse(s.exponent && chained, false, "--exponent with a chain");
    refuse(s.alpha && chained, false, "--alpha with a chain");
    if (!chained && kind == LobeKind::Phong && !s.exponent) throw UsageError("--exponent: expected with --lobe phong");
    if (!chained && usesAlpha(kind) && !s.alpha)
        throw UsageError(fmt::format("--alpha: expected with --lobe {}", s.lobe));
    if (refracts(kind) && !s.ior) throw UsageError(fmt::format("--ior: expected with --lobe {}", s.lobe));
}

/// Exponents from 2048 to 2, halved and halved again; alphas p² with p (2 − p) = m/(levels − 1): 0 to 1, dense where
/// lobes are narrow.
std::vector<double> usualValues(LobeKind kind, int levels) {
    std::vector<double> out;
    for (int m = 0; m < levels; ++m) {
        const double t = static_cast<double>(m) / (levels - 1);
        out.push_back(kind == LobeKind::Phong ? std::exp2(10 * (1 - t) + 1) : sqr(1 - std::sqrt(1 - t)));
    }
    return out;
}

std::vector<double> parseValues(const std::string& text) {
    std::vector<double> out(static_cast<std::size_t>(std::count(text.begin(), text.end(), ',')) + 1);
    if (!parseNumbers(text, out))
        throw UsageError(fmt::format("--values: expected numbers between commas, found '{}'", text));
    return out;
}

Lobe lobeOf(LobeKind kind, double value, const LobeSettings& s) {
    Lobe lobe{kind};
    lobe.ior = s.ior.value_or(1);
    if (kind == LobeKind::Phong) lobe.exponent = value;
    if (usesAlpha(kind)) lobe.alpha = value;
    if (usesAlpha(kind) && value == 0) lobe.kind = LobeKind::Mirror;
    validateLobe(lobe);
    return lobe;
}

json levelJson(const Lobe& lobe, const EnvMap& map, const PrefilterStep& step) {
    json out = {{"size", map.size()}, {"lobe", toString(lobe.kind)}, {"seconds", step.seconds}};
    if (lobe.kind == LobeKind::Phong) out["exponent"] = lobe.exponent;
    if (usesAlpha(lobe.kind)) out["alpha"] = lobe.alpha;
    if (refracts(lobe.kind)) out["ior"] = lobe.ior;
    if (step.order >= 0) out["harmonics_order"] = step.order;
    if (step.directRadius > 0) out["direct_radius"] = step.directRadius;
    return out;
}

LobeBake bakeSize(const LobeSettings& s, const LobeChain& plan, const EnvMap& source, int size,
                  const PrefilterOptions& options) {
    std::vector<PrefilterLevel> levels;
    for (std::size_t m = 0; m < plan.lobes.size(); ++m) levels.push_back({plan.lobes[m], std::max(1, size >> m)});
    PrefilterOptions own = options;
    if (s.tolerance) own.tolerance = *s.tolerance;
    Prefiltered baked = prefilter(source, levels, own);
    LobeBake out{{}, json::array()};
    for (std::size_t m = 0; m < levels.size(); ++m)
        out.levels.push_back(levelJson(plan.lobes[m], baked.levels[m], baked.steps[m]));
    out.chain.levels = std::move(baked.levels);
    out.chain.mapping = plan.mapping;
    return out;
}

std::size_t bytesOf(const LobeChain& plan, EnvLayout layout, int size, TexelFormat format) {
    std::size_t bytes = 0;
    for (std::size_t m = 0; m < plan.lobes.size(); ++m) {
        const glm::ivec2 extent = envExtent(layout, std::max(1, size >> m));
        bytes += static_cast<std::size_t>(extent.x) * extent.y * 3 * bytesPerChannel(format);
    }
    return bytes;
}

double worstThroughFilter(const LobeChain& plan, const LobeBake& bake, const EnvironmentTruth& truth, int samples,
                          unsigned threads) {
    double worst = 0;
    for (std::size_t m = 0; m < plan.lobes.size(); ++m)
        if (plan.lobes[m].kind != LobeKind::Mirror)
            worst = std::max(
                worst,
                measureEnvironment(bake.chain.levels[m], truth, plan.lobes[m], samples, 1, threads).filteredRmse);
    return worst;
}

}  // namespace

LobeChain lobeChain(const LobeSettings& s) {
    const LobeKind kind = lobeKindFromString(s.lobe);
    refuseUnused(s, kind);
    if (s.chain == 0 && s.values.empty()) return {{lobeOf(kind, s.exponent.value_or(s.alpha.value_or(0)), s)}, {}};
    LevelMapping mapping;
    mapping.values = s.values.empty() ? usualValues(kind, s.chain) : parseValues(s.values);
    if (s.chain > 0 && static_cast<std::size_t>(s.chain) != mapping.values.size())
        throw UsageError(fmt::format("--values: expected {} numbers, found {}", s.chain, mapping.values.size()));
    mapping.parameter = kind == LobeKind::Phong ? "exponent" : "alpha";
    mapping.name = kind == LobeKind::Phong ? "log2" : "sqrt";
    requireValid(mapping);
    LobeChain out{{}, mapping};
    for (const double value : mapping.values) out.lobes.push_back(lobeOf(kind, value, s));
    return out;
}

LobeBake bakeLobes(const LobeSettings& s, const EnvMap& source, EnvLayout layout, int size, TexelFormat format,
                   const PrefilterOptions& options) {
    const LobeChain plan = lobeChain(s);
    PrefilterOptions own = options;
    own.layout = layout;
    if (!s.maxError && !s.maxBytes) return bakeSize(s, plan, source, size, own);
    const EnvironmentTruth truth(source, options.threads);
    const auto fits = [&](int n) { return !s.maxBytes || bytesOf(plan, layout, n, format) <= *s.maxBytes; };
    if (!fits(1))
        throw Error(fmt::format("expected at most {} bytes, found {} for the smallest map", *s.maxBytes,
                                bytesOf(plan, layout, 1, format)));
    double nearest = INFINITY;
    int largest = 1;
    for (int n = s.maxError ? 2 : 1; n <= size && fits(n); n *= 2) {
        largest = n;
        if (!s.maxError) continue;
        LobeBake bake = bakeSize(s, plan, source, n, own);
        const double error = worstThroughFilter(plan, bake, truth, std::min(s.samples, 100), options.threads);
        if (error <= *s.maxError) return bake;
        nearest = std::min(nearest, error);
    }
    if (!s.maxError) return bakeSize(s, plan, source, largest, own);
    throw Error(
        fmt::format("expected an error through the filter <= {}, found {:.3g} at size {}, the largest within the "
                    "budget and --size",
                    *s.maxError, nearest, largest));
}

json verifyLobes(const LobeSettings& s, const EnvMap& source, const EnvChain& written, unsigned threads,
                 const Progress& progress) {
    const LobeChain plan = lobeChain(s);
    const EnvironmentTruth truth(source, threads);
    json levels = json::array();
    double rmse = 0, filtered = 0;
    for (std::size_t m = 0; m < plan.lobes.size(); ++m) {
        report(progress, "verifying", static_cast<double>(m) / static_cast<double>(plan.lobes.size()));
        if (plan.lobes[m].kind == LobeKind::Mirror) {
            levels.push_back(nullptr);
            continue;
        }
        const EnvironmentError e = measureEnvironment(written.levels[m], truth, plan.lobes[m], s.samples, 1, threads);
        levels.push_back({{"rmse", e.rmse},
                          {"p95", e.p95},
                          {"max", e.max},
                          {"filtered_rmse", e.filteredRmse},
                          {"filtered_p95", e.filteredP95},
                          {"filtered_max", e.filteredMax},
                          {"mean", e.mean}});
        rmse = std::max(rmse, e.rmse);
        filtered = std::max(filtered, e.filteredRmse);
    }
    return {{"metric", "difference from the sum over the source's texels, relative to its mean"},
            {"samples", s.samples},
            {"rmse", rmse},
            {"filtered_rmse", filtered},
            {"levels", levels}};
}

}  // namespace nacre::cli
