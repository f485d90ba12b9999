#include "cli/envmap_lobes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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
    const auto axis = [&s](const std::string& text) {
        std::array<double, 3> v{};
        if (!parseNumbers(text, v) || !isFinite({v[0], v[1], v[2]}) || v == std::array<double, 3>{})
            throw UsageError(fmt::format("expected a direction x,y,z, found '{}'", text));
        s.axis = Vec3(v[0], v[1], v[2]);
    };
    return {{"--lobe", "NAME", "Prefilter with this lobe", into(s.lobe), false, lobeNames()},
            {"--exponent", "N", "Of phong: 1/r of HSE eq. 6, >= 0", exponent},
            {"--alpha", "A", "Of ggx, beckmann and their refractions: width of the slopes, in (0, 1]", number(s.alpha)},
            {"--alpha-y", "A", "Of ggx_anisotropic: width across the tangent, --alpha along it", number(s.alphaY)},
            {"--axis", "X,Y,Z", "Of ggx_anisotropic: the tangent's direction in the world (default 0,1,0)", axis},
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

constexpr const char* kMetric = "difference from the sum over the source's texels, root mean square over its mean";

bool refracts(LobeKind kind) { return kind == LobeKind::GgxRefraction || kind == LobeKind::BeckmannRefraction; }

void refuseUnused(const LobeSettings& s, LobeKind kind) {
    const auto refuse = [&](bool isSet, bool isUsed, const char* flag) {
        if (isSet && !isUsed) throw UsageError(fmt::format("{}: the lobe {} doesn't take it", flag, s.lobe));
    };
    refuse(s.exponent.has_value(), kind == LobeKind::Phong, "--exponent");
    refuse(s.alpha.has_value(), usesAlpha(kind), "--alpha");
    const bool anisotropic = kind == LobeKind::GgxAnisotropic;
    refuse(s.ior.has_value(), refracts(kind), "--ior");
    refuse(s.alphaY.has_value(), anisotropic, "--alpha-y");
    refuse(s.axis.has_value(), anisotropic, "--axis");
    refuse(s.chain > 0, kind == LobeKind::Phong || (usesAlpha(kind) && !anisotropic), "--chain");
    refuse(!s.values.empty(), kind == LobeKind::Phong || (usesAlpha(kind) && !anisotropic), "--values");
    const bool chained = s.chain > 0 || !s.values.empty();
    refuse(s.exponent && chained, false, "--exponent with a chain");
    refuse(s.alpha && chained, false, "--alpha with a chain");
    if (!chained && kind == LobeKind::Phong && !s.exponent) throw UsageError("--exponent: expected with --lobe phong");
    if (!chained && usesAlpha(kind) && !s.alpha)
        throw UsageError(fmt::format("--alpha: expected with --lobe {}", s.lobe));
    if (anisotropic && !s.alphaY) throw UsageError(fmt::format("--alpha-y: expected with --lobe {}", s.lobe));
    refuse(s.maxError.has_value(), kind != LobeKind::Mirror, "--max-error");
    refuse(s.verify, kind != LobeKind::Mirror, "--verify");
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
    lobe.alphaY = s.alphaY.value_or(0);
    lobe.axis = s.axis.value_or(lobe.axis);
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
    if (lobe.kind == LobeKind::GgxAnisotropic) {
        out["alpha_y"] = lobe.alphaY;
        out["axis"] = {lobe.axis.x, lobe.axis.y, lobe.axis.z};
    }
    if (step.order >= 0) out["harmonics_order"] = step.order;
    if (step.cut) out["harmonics_cut"] = true;
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
    LobeBake out{{}, json::array(), nullptr};
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
        if (!isMirror(plan.lobes[m]))
            worst = std::max(
                worst,
                measureEnvironment(bake.chain.levels[m], truth, plan.lobes[m], samples, 1, threads).filteredRmse);
    return worst;
}

}  // namespace

std::string anyLobeOption(const LobeSettings& s) {
    const std::pair<bool, const char*> options[] = {{!s.lobe.empty(), "--lobe"},
                                                    {s.exponent.has_value(), "--exponent"},
                                                    {s.alpha.has_value(), "--alpha"},
                                                    {s.alphaY.has_value(), "--alpha-y"},
                                                    {s.axis.has_value(), "--axis"},
                                                    {s.ior.has_value(), "--ior"},
                                                    {s.chain > 0, "--chain"},
                                                    {!s.values.empty(), "--values"},
                                                    {s.tolerance.has_value(), "--tolerance"},
                                                    {s.maxError.has_value(), "--max-error"},
                                                    {s.maxBytes.has_value(), "--max-bytes"},
                                                    {s.verify, "--verify"}};
    for (const auto& [isSet, name] : options)
        if (isSet) return name;
    return {};
}

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
    if (!s.maxError && !s.maxBytes) {
        if (size >> (plan.lobes.size() - 1) == 0)
            throw UsageError(fmt::format("--chain: {} levels halve down to one texel from --size {} on, found {}",
                                         plan.lobes.size(), 1ll << (plan.lobes.size() - 1), size));
        return bakeSize(s, plan, source, size, own);
    }
    const EnvironmentTruth truth(source, options.threads);
    const auto fits = [&](int n) { return !s.maxBytes || bytesOf(plan, layout, n, format) <= *s.maxBytes; };
    if (!fits(1))
        throw Error(fmt::format("expected at most {} bytes, found {} for the smallest map", *s.maxBytes,
                                bytesOf(plan, layout, 1, format)));
    const int samples = std::min(s.samples, 100);
    double nearest = INFINITY;
    int largest = 1;
    for (int n = s.maxError ? 2 : 1; n <= size && fits(n); n *= 2) {
        largest = n;
        if (!s.maxError) continue;
        LobeBake bake = bakeSize(s, plan, source, n, own);
        const double error = worstThroughFilter(plan, bake, truth, samples, options.threads);
        if (error <= *s.maxError) {
            bake.error = {{"metric", kMetric}, {"samples", samples}, {"filtered_rmse", error}};
            return bake;
        }
        nearest = std::min(nearest, error);
    }
    if (!s.maxError) return bakeSize(s, plan, source, largest, own);
    throw Error(
        fmt::format("expected an error through the filter <= {}, found {:.3g} at size {}, the largest within the "
                    "budgets and --size (by default the source's)",
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
        if (isMirror(plan.lobes[m])) {
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
    return {
        {"metric", kMetric}, {"samples", s.samples}, {"rmse", rmse}, {"filtered_rmse", filtered}, {"levels", levels}};
}

}  // namespace nacre::cli
