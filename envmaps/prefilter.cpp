#include "envmaps/prefilter.hpp"

#include <fmt/format.h>

#include <chrono>
#include <optional>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "envmaps/anisotropic_filter.hpp"
#include "envmaps/convert.hpp"
#include "envmaps/direct_filter.hpp"
#include "envmaps/texel_points.hpp"

namespace nacre {
namespace {

constexpr int kLargestOrder = 640;  // beyond it the middle of a kernel is summed directly, which then is cheaper
constexpr int kProbedOrder = 800;   // coefficients that say whether kLargestOrder is enough

constexpr double kWide = 0.3;  // a kernel this wide that has no end of harmonics is cut off sharply (Phong 0): its sum
constexpr int kEdgeOrder = 256;         // over texels jumps as each of them sets, and no order follows that
constexpr double kOffCentre = 1e-6;     // of all light: what a block of merged texels may have beside its middle
constexpr double kUnseen = 1e-9;        // a sum of weights below this share of the lobe saw no texel's centre
constexpr double kSpectrumShare = 0.2;  // of the tolerance, for the harmonics that a map turns out not to need

/// How one level is computed: coefficients of its smooth part and, for narrow kernels, the middle that they leave.
struct Plan {
    double integral = 1;               ///< of the kernel [sr]
    std::vector<double> coefficients;  ///< K_l = 2π ∫ k_smooth P_l(cosθ) sinθ dθ [sr]
    std::optional<ChordTable> middle;
    double radius = 0;
    bool cut = false;  ///< the coefficients don't reach the tolerance
};

/// The smallest order that filters a map of one point to `tolerance`: root mean square of what the harmonics above it
/// would add, as a share of the map's mean.
int sufficientOrder(const std::vector<double>& coefficients, double tolerance) {
    double sum = 0;
    int order = static_cast<int>(coefficients.size()) - 1;
    for (; order > 0; --order) {
        sum += (2.0 * order + 1) * sqr(coefficients[order]);
        if (sum > sqr(tolerance)) break;
    }
    return order;
}

std::vector<double> smoothCoefficients(const ZonalKernel& kernel, int order) {
    std::vector<double> out = zonalCoefficients(kernel, order);
    const double integral = zonalIntegral(kernel);
    for (double& k : out) k *= integral;
    return out;
}

Plan directPlan(const ZonalKernel& kernel) {
    return {zonalIntegral(kernel), {}, ChordTable(kernel.value, kernel.support, kernel.width), kernel.support, false};
}

/// Splits a narrow kernel at an angle, smoothly: the outer part has few harmonics, the middle few texels (as Ewald
/// 1921 splits a sum over charges). The step is an error function of width w; its spectrum falls as e^−(l w/2)².
Plan splitPlan(const ZonalKernel& kernel, double tolerance) {
    const double w = 7.5 / kLargestOrder;
    const double integral = zonalIntegral(kernel);
    if (kernel.support <= 6 * w) return directPlan(kernel);
    for (double centre = 4 * w;; centre += w) {
        const auto outer = [=](double theta) { return 0.5 * (1 + std::erf((theta - centre) / w)); };
        Plan plan{integral, {}, {}, centre + 4 * w, false};
        const ZonalKernel smooth{[=](double t) { return kernel.value(t) * outer(t); }, std::min(w, kernel.width),
                                 kernel.support};
        plan.coefficients = smoothCoefficients(smooth, kProbedOrder);
        std::vector<double> relative = plan.coefficients;
        for (double& k : relative) k /= integral;
        const int order = sufficientOrder(relative, tolerance);
        if (order > kLargestOrder && centre < 16 * w) continue;
        plan.coefficients.resize(std::min(order, kLargestOrder) + 1);
        plan.middle.emplace([=](double t) { return kernel.value(t) * (1 - outer(t)); }, plan.radius, kernel.width);
        return plan;
    }
}

/// Sums over every texel in the lobe: for small maps, and for lobes so narrow that most texels' centres miss them,
/// where the largest weight decides and harmonics' rounding would drown it.
bool isDirectBetter(const ZonalKernel& kernel, double points, double results) {
    constexpr double kPairs = 3e6;  // kernel evaluations that cost less than the smallest transforms
    constexpr double kFew = 3e4;    // points that are sorted into cells in no time
    const double spacing = std::sqrt(4 * kPi / points);
    const double pairs = results * points * 0.5 * (1 - std::cos(kernel.support));
    return (points < kFew && pairs < kPairs) || (kernel.width < 0.5 * spacing && kernel.support < 16 * spacing);
}

Plan makePlan(const EnvMap& source, const PrefilterLevel& level, const PrefilterOptions& options) {
    const ZonalKernel kernel = zonalKernel(level.lobe);
    const auto texels = [](EnvLayout layout, int size) {
        const glm::ivec2 extent = envExtent(layout, size);
        return static_cast<double>(extent.x) * extent.y;
    };
    if (isDirectBetter(kernel, texels(source.layout, source.size()), texels(options.layout, level.size)))
        return directPlan(kernel);
    // Most kernels need a few waves across their width: probe that far before all.
    int probed = std::min(kProbedOrder, static_cast<int>(6 / kernel.width) + 64);
    for (;; probed = std::min(kProbedOrder, 2 * probed)) {
        std::vector<double> relative = zonalCoefficients(kernel, probed);
        const int order = sufficientOrder(relative, options.tolerance);
        if (order <= std::min(kLargestOrder, probed * 4 / 5)) {
            relative.resize(order + 1);
            return {1, relative, {}, 0, false};
        }
        if (probed < kProbedOrder) continue;
        if (kernel.width < kWide) return splitPlan(kernel, options.tolerance);
        relative.resize(kEdgeOrder + 1);
        return {1, relative, {}, 0, true};
    }
}

/// Texels a block may average: what it blurs, l(l+1)(b²−1)h²/24 of a harmonic, stays below the tolerance.
int affordableBlock(const EnvMap& source, const std::vector<Plan>& plans, double tolerance) {
    const double texel = kPi / 2 / (source.layout == EnvLayout::LatLong ? source.size() / 2.0 : source.size());
    for (int block = 8; block > 1; block /= 2) {
        if (source.size() % block) continue;
        const double blur = (sqr(block) - 1) * sqr(texel) / 24;
        bool fine = true;
        for (const Plan& plan : plans) {
            double sum = 0;
            for (std::size_t l = 1; l < plan.coefficients.size(); ++l)
                sum += (2.0 * static_cast<double>(l) + 1) *
                       sqr(plan.coefficients[l] * static_cast<double>(l * (l + 1)) * blur);
            fine = fine && !plan.middle && std::sqrt(sum) <= tolerance;
        }
        if (fine) return block;
    }
    return 1;
}

/// The order that this map needs of a level: what the cut harmonics hold, root mean square as a share of the mean.
int orderFor(const Harmonics& map, const std::vector<double>& coefficients, double tolerance) {
    const auto powerOf = [&](int l) {
        double sum = 0;
        for (int m = 0; m <= l; ++m)
            for (int c = 0; c < 3; ++c) sum += (m ? 2 : 1) * (sqr(map.at(l, m).re[c]) + sqr(map.at(l, m).im[c]));
        return sum * sqr(coefficients[l] / coefficients[0]);
    };
    const double allowed = powerOf(0) * sqr(tolerance);
    double sum = 0;
    int order = static_cast<int>(coefficients.size()) - 1;
    for (; order > 0; --order)
        if ((sum += powerOf(order)) > allowed) break;
    return order;
}

Harmonics filtered(const Harmonics& in, const std::vector<double>& coefficients) {
    const int order = static_cast<int>(coefficients.size()) - 1;
    Harmonics out(order);
    for (int m = 0; m <= order; ++m)
        for (int l = m; l <= order; ++l)
            out.at(l, m) = {coefficients[l] * in.at(l, m).re, coefficients[l] * in.at(l, m).im};
    return out;
}

Rgb nearestTexel(const EnvMap& source, const Vec3& direction) {
    const glm::dvec2 p = envPosition(source.layout, source.size(), direction);
    return source.image.rgb(std::clamp(static_cast<int>(p.x), 0, source.image.width() - 1),
                            std::clamp(static_cast<int>(p.y), 0, source.image.height() - 1));
}

class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// What every level draws on.
struct Basis {
    bool hasNegative = false;
    double brightness =
        0;  ///< mean |radiance|: the weights' channel is scaled by it, so that rounding treats all alike
    std::vector<SpherePoint> points;
    Harmonics harmonics;
    std::optional<PointIndex> index;
};

Basis inspect(const EnvMap& source) {
    Basis basis;
    for (const float v : source.image.data()) {
        require(std::isfinite(v), "prefilter: expected finite radiance");
        basis.hasNegative = basis.hasNegative || v < 0;
        basis.brightness += std::abs(v);
    }
    basis.brightness /= static_cast<double>(source.image.data().size());
    return basis;
}

void analyse(const EnvMap& source, const std::vector<Plan>& plans, const PrefilterOptions& options, Basis& basis) {
    std::size_t coefficients = 0;
    double radius = 0;
    for (const Plan& plan : plans) {
        coefficients = std::max(coefficients, plan.coefficients.size());
        radius = std::max(radius, plan.radius);
    }
    if (coefficients == 0 && radius == 0) return;
    basis.points = blockPoints(source, affordableBlock(source, plans, options.tolerance), kOffCentre, options.threads);
    for (SpherePoint& p : basis.points) p.weight.w *= basis.brightness;
    if (coefficients > 0)
        basis.harmonics = analyseHarmonics(basis.points, static_cast<int>(coefficients) - 1, options.threads);
    if (radius > 0) basis.index.emplace(basis.points, radius);
}

EnvMap filterLevel(const EnvMap& source, const Basis& basis, Plan& plan, int size, const PrefilterOptions& options) {
    EnvMap map(options.layout, size);
    if (basis.brightness == 0) return map;
    const std::vector<Vec3> directions = texelDirections(options.layout, size, options.threads);
    std::vector<Vec4> sums(directions.size(), Vec4(0));
    if (!plan.coefficients.empty()) {
        const double allowed = kSpectrumShare * options.tolerance;
        plan.coefficients.resize(orderFor(basis.harmonics, plan.coefficients, allowed) + 1);
        sums = synthesiseHarmonics(filtered(basis.harmonics, plan.coefficients), directions, options.threads);
    }
    parallelFor(directions.size(), options.threads, [&](std::size_t i) {
        if (plan.middle) sums[i] += basis.index->sum(directions[i], *plan.middle);
        const double weight = sums[i].w / basis.brightness;
        Rgb value = weight > kUnseen * plan.integral ? Rgb(sums[i]) / weight : nearestTexel(source, directions[i]);
        if (!basis.hasNegative) value = glm::max(value, Rgb(0));
        for (int c = 0; c < 3; ++c) map.image.data()[3 * i + c] = static_cast<float>(value[c]);
    });
    return map;
}

}  // namespace

Prefiltered prefilter(const EnvMap& source, std::span<const PrefilterLevel> levels, const PrefilterOptions& options) {
    Basis basis = inspect(source);
    std::vector<Plan> plans(levels.size());
    for (std::size_t i = 0; i < levels.size(); ++i) {
        validateLobe(levels[i].lobe);
        require(levels[i].size >= 1, "prefilter: size must be >= 1");
        if (isZonal(levels[i].lobe.kind) && !isMirror(levels[i].lobe)) plans[i] = makePlan(source, levels[i], options);
    }
    report(options.progress, "analysing", 0);
    analyse(source, plans, options, basis);
    Prefiltered out;
    for (std::size_t i = 0; i < levels.size(); ++i) {
        report(options.progress, "filtering", static_cast<double>(i + 1) / static_cast<double>(levels.size() + 1));
        const Stopwatch watch;
        const int size = levels[i].size;
        if (isMirror(levels[i].lobe))
            out.levels.push_back(convertEnv(source, options.layout, size, options.threads));
        else if (isZonal(levels[i].lobe.kind))
            out.levels.push_back(filterLevel(source, basis, plans[i], size, options));
        else
            out.levels.push_back(filterAnisotropic(source, levels[i].lobe, options.layout, size, options.threads));
        out.steps.push_back(
            {static_cast<int>(plans[i].coefficients.size()) - 1, plans[i].radius, plans[i].cut, watch.seconds()});
    }
    return out;
}

}  // namespace nacre
