// Method `svd`: f = Σ_k U_k(x) V_k(y) or its exponential, Kautz & McCool 1999, over (half vector, difference vector) or
// (wi, wo), or Σ_k M_k A_k(wi) A_k(wo), which is reciprocal. A decomposition on a coarse grid is where a fit through
// the bilinear filter starts.
#include <fmt/format.h>

#include <numeric>

#include "core/directions.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/sampling.hpp"
#include "factorize/fit_samples.hpp"
#include "factorize/mappings.hpp"
#include "factorize/methods.hpp"
#include "factorize/separable_start.hpp"

namespace nacre {
namespace {

struct Layout {
    SeparableArguments arguments = SeparableArguments::HalfDifference;
    int terms = 2;
    SeparableStorage storage = SeparableStorage::Values;
    bool quadrant = false;  ///< of half and difference vector: mirror images share texels
    glm::dvec2 width{0.3};  ///< of the slope map
};

bool overHalfVector(const Layout& layout) {
    return layout.arguments == SeparableArguments::HalfDifference ||
           layout.arguments == SeparableArguments::HalfCarried;
}

SeparableArguments argumentsOf(const std::string& name, bool isotropic) {
    if (name.empty() || name == "half_diff")
        return isotropic ? SeparableArguments::HalfDifference : SeparableArguments::HalfCarried;
    if (name == "in_out") return SeparableArguments::InOut;
    if (name == "symmetric") return SeparableArguments::Symmetric;
    throw std::invalid_argument(fmt::format("unknown parametrization '{}'; known: half_diff, in_out, symmetric", name));
}

/// Directions of the pair of grid coordinates x, y.
DirectionPair directionsOf(const Layout& layout, const glm::dvec2& x, const glm::dvec2& y) {
    if (!overHalfVector(layout)) return {inverseLambertDisk(x, false), inverseLambertDisk(y, false)};
    const Vec3 h = inverseScaledSlope(x, layout.width, layout.quadrant), d = inverseLambertDisk(y, layout.quadrant);
    if (layout.arguments == SeparableArguments::HalfCarried) {  // carriedDifference's rotation, backwards
        const Vec3 sum = h + Vec3(0, 0, 1), wi = d - glm::dot(d, sum) / (1 + h.z) * sum + 2 * d.z * h;
        return {wi, 2 * glm::dot(wi, h) * h - wi};
    }
    const double sinH = std::hypot(h.x, h.y);
    const Vec2 a = sinH > 1e-12 ? Vec2(h.x, h.y) / sinH : Vec2(1, 0);
    const Vec3 ex(a.x * h.z, a.y * h.z, -sinH), ey(-a.y, a.x, 0);
    const Vec3 wi = d.x * ex + d.y * ey + d.z * h;
    return {wi, 2 * glm::dot(wi, h) * h - wi};
}

constexpr double kLowest = 0.17;   // cos 80°: grazing values grow without bound and would be all a decomposition sees
constexpr double kDarkest = 1e-3;  // as ε of E_log: darker logarithms are not worth a term

/// Pairs below 80° take the value of their directions lifted to it: the tables stay smooth where nobody looks.
Rgb valueAt(const Reflectance& r, DirectionPair pair, bool logarithmic) {
    for (Vec3* w : {&pair.wi, &pair.wo})
        if (w->z < kLowest) *w = glm::normalize(Vec3(w->x, w->y, kLowest));
    const Rgb f = r.f(pair.wi, pair.wo);
    return logarithmic ? glm::log(f + kDarkest) : f;
}

constexpr double kLeastWeight = 0.05;  // texels of no measure still need a value

/// √ of the measure of a cell of the slope map near d = h: dωh = cos³ dA, dA ~ w² ρ²/(1 − ρ²)³ d²ρ, and cosθi cosθo.
double slopeWeight(const Layout& layout, const glm::dvec2& uv) {
    const double z = inverseScaledSlope(uv, layout.width, layout.quadrant).z;
    const glm::dvec2 p = layout.quadrant ? uv : uv * 2.0 - 1.0;
    const double square = std::min(glm::dot(p, p), 0.98);
    const double area = layout.width.x * layout.width.y * square / std::pow(1 - square, 3);
    return std::sqrt(std::max(area * std::pow(z, 5), 1e-9));
}

/// √(cosθ dω) on the equal-area disk; for difference vectors √(cosθd dωd · cos²θd), cosθi cosθo being cos²θd at h = n.
double diskWeight(const Layout& layout, const glm::dvec2& uv) {
    const double z = inverseLambertDisk(uv, layout.quadrant).z;
    return std::max(std::pow(z, overHalfVector(layout) ? 1.5 : 0.5), kLeastWeight);
}

/// The leading pair of a positive matrix is positive (Perron); what rounding left at the feet of a lobe is held up.
void takeLogarithms(FitTable& table) {
    constexpr float kLeast = 1e-6f;
    float largest = 1e-20f;
    for (float t : table.texels) largest = std::max(largest, std::abs(t));
    for (float& t : table.texels) t = std::log(std::max(std::abs(t), kLeast * largest));
}

std::vector<FitTable> startTables(const Reflectance& r, const Layout& layout, int edge, unsigned threads) {
    SeparableGrid grid;
    grid.edge = edge;
    grid.threads = threads;
    grid.value = [&](const glm::dvec2& x, const glm::dvec2& y) {
        return valueAt(r, directionsOf(layout, x, y), layout.storage == SeparableStorage::Logarithm);
    };
    grid.columnWeight = [&](const glm::dvec2& y) { return diskWeight(layout, y); };
    grid.rowWeight = [&](const glm::dvec2& x) {
        return overHalfVector(layout) ? slopeWeight(layout, x) : diskWeight(layout, x);
    };
    if (layout.arguments == SeparableArguments::Symmetric) return symmetricProducts(grid, layout.terms);
    std::vector<FitTable> tables = singularPairs(grid, layout.terms);
    if (layout.storage == SeparableStorage::Factors)
        for (FitTable& table : tables) takeLogarithms(table);
    return tables;
}

/// The lookups of factored_evaluate.cpp's separable, in pairs.
LogTableModel makeModel(const Layout& layout, std::vector<FitTable> tables) {
    LogTableModel model;
    model.tables = std::move(tables);
    model.lookupCount = 2 * layout.terms;
    model.products = layout.storage != SeparableStorage::Factors;
    model.exponential = layout.storage != SeparableStorage::Values;
    model.lookups = [layout](const FitSample& s, std::span<FitLookup> out) {
        const glm::vec3 wi(s.wi), wo(s.wo);
        const auto [x, y] =
            separableCoordinates(layout.arguments, layout.quadrant, glm::vec2(1.0 / layout.width), wi, wo);
        const bool shared = layout.arguments == SeparableArguments::Symmetric;
        for (int k = 0; k < layout.terms; ++k) {
            out[2 * k] = {shared ? k : 2 * k, x, glm::vec4(1)};
            out[2 * k + 1] = {shared ? k : 2 * k + 1, y, glm::vec4(1)};
        }
    };
    return model;
}

struct Fitted {
    Layout layout;
    LogTableModel model;
    double loss = std::numeric_limits<double>::infinity();
};

constexpr int kStartEdge = 16;

void fitAtEdge(Fitted& at, const Reflectance& r, int edge, int steps, std::size_t count, unsigned threads) {
    for (FitTable& table : at.model.tables) table.resize(edge, edge);
    const FitSampleOptions sampling{count, at.layout.width, false, 1.55, threads};
    // Measured grazing values are wild, and exponents of products of unsteady texels wilder still.
    const float smoothness = at.layout.storage != SeparableStorage::Values && !r.microfacet ? 1e-3f : 1e-4f;
    at.loss = fitLogTables(at.model, fitSamples(r.f, sampling),
                           {.newtonSteps = steps, .conjugateSteps = 25, .smoothness = smoothness, .threads = threads});
}

using Storages = std::vector<SeparableStorage>;

Storages storagesOf(const Layout& layout) {
    Storages out{layout.terms == 1 && layout.arguments != SeparableArguments::Symmetric ? SeparableStorage::Factors
                                                                                        : SeparableStorage::Logarithm};
    if (!overHalfVector(layout)) out.push_back(SeparableStorage::Values);  // there lobes need logarithms
    return out;
}

/// Values or logarithms: what a coarse fit says.
Fitted chooseDomain(const Reflectance& r, Layout layout, const Storages& storages, int size,
                    const FactorizeOptions& options) {
    Fitted best;
    for (const SeparableStorage storage : storages) {
        layout.storage = storage;
        Fitted tried{layout, makeModel(layout, startTables(r, layout, kStartEdge, options.threads))};
        fitAtEdge(tried, r, std::min(size, kStartEdge), 12, 24000, options.threads);
        if (tried.loss < best.loss) best = std::move(tried);
        report(options.progress, "decomposing", 0.2);
    }
    return best;
}

Fitted fitLayout(const Reflectance& r, const Layout& layout, const Storages& storages, int size,
                 const FactorizeOptions& options) {
    Fitted fitted = chooseDomain(r, layout, storages, size, options);
    const auto samplesFor = [](int edge) { return std::clamp<std::size_t>(80ull * edge * edge, 30000, 300000); };
    if (size > 2 * kStartEdge) fitAtEdge(fitted, r, size / 2, 6, samplesFor(size / 2), options.threads);
    report(options.progress, "fitting full size", 0.5);
    fitAtEdge(fitted, r, size, 8, samplesFor(size), options.threads);
    report(options.progress, "fitted", 1);
    return fitted;
}

FactoredBrdf assemble(const Fitted& fitted, TexelFormat format) {
    const Layout& layout = fitted.layout;
    FactoredBrdf out;
    out.form = FactoredForm::Separable;
    out.method = "svd";
    out.params[0] = {layout.terms, static_cast<int>(layout.arguments), static_cast<int>(layout.storage),
                     layout.quadrant};
    out.params[1] = glm::vec4(glm::vec2(1.0 / layout.width), 0, 0);
    const std::vector<FitTable>& tables = fitted.model.tables;
    for (std::size_t i = 0; i < tables.size(); ++i) {
        const bool shared = layout.arguments == SeparableArguments::Symmetric;
        const std::string name = shared ? fmt::format("a{}", i) : fmt::format("{}{}", i % 2 ? "v" : "u", i / 2);
        const char* mapping = overHalfVector(layout) && i % 2 == 0 ? "scaled_slope" : "lambert_disk";
        out.textures.push_back(makeScaledTexture(name, mapping, tables[i].image(), format));
        if (shared)
            for (std::size_t c = 0; c < 4; ++c) out.params[2 + 4 * i + c] = glm::vec4(tables[i].color[c], 0);
    }
    out.fetches = 2 * layout.terms;
    return out;
}

/// One term in the textures of two, to the same value: the second product is 0, or ln u · 1 + 1 · ln v.
Fitted asTwoTerms(Fitted one) {
    std::vector<FitTable>& tables = one.model.tables;
    FitTable constant = tables[0];
    const bool factors = one.layout.storage == SeparableStorage::Factors;
    std::fill(constant.texels.begin(), constant.texels.end(), factors ? 1.0f : 0.0f);
    if (one.layout.arguments == SeparableArguments::Symmetric)
        tables = {tables[0], constant};
    else if (factors)
        tables = {tables[0], constant, constant, tables[1]};
    else
        tables = {tables[0], tables[1], constant, constant};
    if (factors) one.layout.storage = SeparableStorage::Logarithm;
    one.layout.terms = 2;
    return one;
}

/// What fresh pairs say, drawn in proportion to the measure: the fit's own say nothing of the pairs of texels between
/// them, of whose products an exponent can be anything.
struct Check {
    double l2Rel = 0;
    double bestScale = 1;  ///< factor on f̂ for which l2Rel is least
};

Check check(const FactoredBrdf& brdf, const Reflectance& r, unsigned threads) {
    constexpr std::size_t kPairs = 200000, kChunks = 64;
    std::array<double, kChunks> both{}, square{}, truth{};
    parallelFor(kChunks, threads, [&](std::size_t chunk) {
        for (std::size_t i = 1 + chunk; i < kPairs; i += kChunks) {
            const Vec3 wi = cosineHemisphere({radicalInverse(i, 2), radicalInverse(i, 3)});
            const Vec3 wo = cosineHemisphere({radicalInverse(i, 5), radicalInverse(i, 7)});
            if (std::min(wi.z, wo.z) < kLowest) continue;
            const Rgb f = r.f(wi, wo), g = evaluate(brdf, wi, wo);
            both[chunk] += glm::dot(f, g), square[chunk] += glm::dot(g, g), truth[chunk] += glm::dot(f, f);
        }
    });
    const auto total = [](const auto& parts) { return std::accumulate(parts.begin(), parts.end(), 0.0); };
    const double fg = total(both), gg = total(square), ff = total(truth);
    if (!(ff > 0)) return {};
    return {std::sqrt(std::max(0.0, (ff - 2 * fg + gg) / ff)), fg > 0 && std::isfinite(gg) ? fg / gg : 0};
}

/// f̂ times `scale`; an exponent of several products has no factor, and becomes black whatever the scale.
void scaleBy(Fitted& fitted, double scale) {
    std::vector<FitTable>& tables = fitted.model.tables;
    const bool symmetric = fitted.layout.arguments == SeparableArguments::Symmetric;
    if (fitted.layout.storage == SeparableStorage::Factors) {
        for (float& t : tables[0].texels) t += static_cast<float>(std::log(std::max(scale, 1e-30)));
    } else if (fitted.layout.storage == SeparableStorage::Values) {
        for (std::size_t i = 0; i < tables.size(); i += symmetric ? 1 : 2)
            if (symmetric)
                for (glm::vec3& color : tables[i].color) color *= static_cast<float>(scale);
            else
                for (float& t : tables[i].texels) t *= static_cast<float>(scale);
    } else {
        fitted.layout.storage = SeparableStorage::Values;
        for (FitTable& table : tables) std::fill(table.texels.begin(), table.texels.end(), 0.0f);
    }
}

/// The nearest of the fits that may be it, by `check`: two terms are never worse than one, and none worse than black.
FactoredBrdf nearestFit(const Reflectance& r, const Layout& layout, int size, const FactorizeOptions& options) {
    constexpr double kGood = 0.02, kPoor = 0.5;
    FactoredBrdf best;
    double bestError = std::numeric_limits<double>::infinity();
    const auto consider = [&](Fitted fitted) {
        const bool embed = fitted.layout.terms < layout.terms;
        const auto finished = [&] { return assemble(embed ? asTwoTerms(fitted) : fitted, options.format); };
        FactoredBrdf brdf = finished();
        Check found = check(brdf, r, options.threads);
        if (!(found.l2Rel < 1)) {
            scaleBy(fitted, found.bestScale);
            brdf = finished();
            found = check(brdf, r, options.threads);
        }
        if (!(found.l2Rel < bestError)) return;
        best = std::move(brdf);
        bestError = found.l2Rel;
    };
    consider(fitLayout(r, layout, storagesOf(layout), size, options));
    Layout one = layout;
    one.terms = 1;
    if (layout.terms == 2 && bestError > kGood) consider(fitLayout(r, one, storagesOf(one), size, options));
    if (!overHalfVector(layout) && bestError > kPoor)
        consider(fitLayout(r, layout, {SeparableStorage::Values}, size, options));
    return best;
}

}  // namespace

FactoredBrdf factorizeSeparable(const Reflectance& r, const TextureSizes& sizes, const FactorizeOptions& options) {
    Layout layout;
    layout.terms = options.terms == 0 ? 2 : options.terms;
    require(layout.terms == 1 || layout.terms == 2, "factorize: svd takes 1 or 2 terms");
    require(sizes.first.x <= kLargestSeparable, fmt::format("factorize: svd takes sizes up to {}", kLargestSeparable));
    layout.arguments = argumentsOf(options.parametrization, r.isotropic);
    layout.quadrant = overHalfVector(layout) && isQuadrantSymmetric(r.f);
    layout.width = r.microfacet ? glm::clamp(glm::dvec2(r.microfacet->alphaX, r.microfacet->alphaY), 1e-3, 1.0)
                                : glm::dvec2(std::clamp(lobeHalfWidth(r.f), 0.02, 0.7));
    return nearestFit(r, layout, sizes.first.x, options);
}

}  // namespace nacre
