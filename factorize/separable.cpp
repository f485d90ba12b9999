// Method `svd`: f = Σ_k U_k(x) V_k(y) or its exponential, Kautz & McCool 1999, over (half vector, difference vector) or
// (wi, wo), or Σ_k M_k A_k(wi) A_k(wo), which is reciprocal. A decomposition on a coarse grid is where a fit through
// the bilinear filter starts.
#include <fmt/format.h>

#include "core/directions.hpp"
#include "core/error.hpp"
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

/// Values or logarithms: what a coarse fit says.
Fitted chooseDomain(const Reflectance& r, Layout layout, int size, const FactorizeOptions& options) {
    Fitted best;
    std::vector<SeparableStorage> storages{layout.terms == 1 && layout.arguments != SeparableArguments::Symmetric
                                               ? SeparableStorage::Factors
                                               : SeparableStorage::Logarithm};
    if (!overHalfVector(layout)) storages.push_back(SeparableStorage::Values);  // there lobes need logarithms
    for (const SeparableStorage storage : storages) {
        layout.storage = storage;
        Fitted tried{layout, makeModel(layout, startTables(r, layout, kStartEdge, options.threads))};
        fitAtEdge(tried, r, std::min(size, kStartEdge), 12, 24000, options.threads);
        if (tried.loss < best.loss) best = std::move(tried);
        report(options.progress, "decomposing", 0.2);
    }
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
    const int size = sizes.first.x;
    Fitted fitted = chooseDomain(r, layout, size, options);
    layout = fitted.layout;
    const auto samplesFor = [](int edge) { return std::clamp<std::size_t>(80ull * edge * edge, 30000, 300000); };
    if (size > 2 * kStartEdge) fitAtEdge(fitted, r, size / 2, 6, samplesFor(size / 2), options.threads);
    report(options.progress, "fitting full size", 0.5);
    fitAtEdge(fitted, r, size, 8, samplesFor(size), options.threads);
    report(options.progress, "fitted", 1);

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
        out.textures.push_back(makeScaledTexture(name, mapping, tables[i].image(), options.format));
        if (shared)
            for (std::size_t c = 0; c < 4; ++c) out.params[2 + 4 * i + c] = glm::vec4(tables[i].color[c], 0);
    }
    out.fetches = 2 * layout.terms;
    return out;
}

}  // namespace nacre
