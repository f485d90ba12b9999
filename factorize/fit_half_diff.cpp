// Method `fit`: logarithmic tables over (θh, θd), see factored_evaluate.cpp for the formula. Colour is handled in the
// material's own basis: the principal axes of ln f, so that brightness gets most channels and hue few.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "core/error.hpp"
#include "factorize/fit_samples.hpp"
#include "factorize/log_table_fit.hpp"
#include "factorize/mappings.hpp"
#include "factorize/methods.hpp"

namespace nacre {
namespace {

using ColorBasis = std::array<glm::vec3, 3>;

/// Principal axes of ln(f + ε) over the samples, largest first; the first has length √3, so that grey gives (1,1,1).
ColorBasis colorBasis(const std::vector<FitSample>& samples) {
    const auto logOf = [](const FitSample& s) {
        return Eigen::Vector3d(std::log(s.value.x + 1e-3), std::log(s.value.y + 1e-3), std::log(s.value.z + 1e-3));
    };
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double total = 0;
    for (const FitSample& s : samples) {
        centre += s.measure * logOf(s);
        total += s.measure;
    }
    centre /= total;
    Eigen::Matrix3d covariance = 1e-9 * Eigen::Matrix3d::Ones();  // a constant BRDF still has grey as its first axis
    for (const FitSample& s : samples) {
        const Eigen::Vector3d d = logOf(s) - centre;
        covariance += s.measure / total * d * d.transpose();
    }
    const Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors();
    ColorBasis basis;
    for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d a = axes.col(2 - k) * (k == 0 ? std::copysign(std::sqrt(3.0), axes.col(2).sum()) : 1.0);
        basis[k] = glm::vec3(a.x(), a.y(), a.z());
    }
    return basis;
}

LogTableModel makeModel(HalfDiffLayout layout, const ColorBasis& c) {
    LogTableModel model;
    const auto add = [&](std::vector<glm::vec3> colors) { model.tables.emplace_back(2, 2, std::move(colors)); };
    if (layout == HalfDiffLayout::Harmonics) {
        add({c[0], c[0], c[0], c[1]});
        add({c[0], c[1], c[2], c[2]});
    } else {
        add({c[0], c[0], c[1], c[2]});
        if (layout == HalfDiffLayout::Grazing) add({c[0], c[1], c[2]});
    }
    model.lookupCount = static_cast<int>(model.tables.size());
    return model;
}

/// The lookups of factored_evaluate.cpp's halfDiff, channel weights = powers of x.
void setLookups(LogTableModel& model, HalfDiffLayout layout, float s) {
    model.lookups = [layout, s](const FitSample& sample, std::span<FitLookup> out) {
        const glm::vec3 wi(sample.wi), wo(sample.wo);
        const HalfGeometry g = halfGeometry(wi, wo);
        const float x = cosSquaredPhiD(g, wi, wo);
        const glm::vec2 uv = mapHalfDiff(g, s);
        if (layout == HalfDiffLayout::Harmonics) {
            out[0] = {0, uv, {1, x, x * x, 1}};
            out[1] = {1, uv, {x * x * x, x, 1, x}};
        } else {
            out[0] = {0, uv, {1, x, 1, 1}};
            if (layout == HalfDiffLayout::Grazing) out[1] = {1, mapElevations(wi.z, wo.z), {1, 1, 1, 1}};
        }
    };
}

void resizeTables(LogTableModel& model, const TextureSizes& sizes, int divisor) {
    const auto edge = [&](int full) { return std::max(std::min(full, 4), full / divisor); };
    model.tables[0].resize(edge(sizes.first.x), edge(sizes.first.y));
    if (model.tables.size() > 1) model.tables[1].resize(edge(sizes.second.x), edge(sizes.second.y));
}

/// All that a bake needs while it runs.
struct Bake {
    const Reflectance& r;
    HalfDiffLayout layout;
    TextureSizes sizes;
    const FactorizeOptions& options;

    std::vector<FitSample> samples(std::size_t count, double s) const {
        FitSampleOptions sampling;
        sampling.count = count;
        sampling.width = glm::dvec2(s / 1.5);
        sampling.threads = options.threads;
        return fitSamples(r.f, sampling);
    }
};

struct Start {
    double s = 0, loss = std::numeric_limits<double>::infinity();
    LogTableModel model;
    ColorBasis basis{};
};

/// A coarse fit with the slope s in the middle of the u axis.
Start tryMiddle(const Bake& bake, double s) {
    const std::vector<FitSample> samples = bake.samples(24000, s);
    Start start{s, 0, {}, colorBasis(samples)};
    start.model = makeModel(bake.layout, start.basis);
    setLookups(start.model, bake.layout, static_cast<float>(s));
    resizeTables(start.model, bake.sizes, 4);
    const FitOptions fit{.newtonSteps = 5, .conjugateSteps = 15, .threads = bake.options.threads};
    start.loss = fitLogTables(start.model, samples, fit);
    return start;
}

/// The best middle of the u axis: a few decades first, then its neighbours.
Start findMiddle(const Bake& bake) {
    Start best;
    const auto consider = [&](double s) {
        Start start = tryMiddle(bake, s);
        report(bake.options.progress, "choosing coordinates", 0.1);
        if (start.loss < best.loss) best = std::move(start);
    };
    const double half = 1.5 * lobeHalfWidth(bake.r.f);
    for (double s : {half, 0.04, 0.16, 0.64}) consider(s);
    const double centre = best.s;
    for (double s : {centre * 0.5, centre * 2}) consider(std::clamp(s, 2e-3, 1.5));
    return best;
}

/// Samples of the last fit: some forty a texel, about a third of which fall below the horizon.
std::size_t sampleCount(const TextureSizes& sizes) {
    const int texels = sizes.first.x * sizes.first.y + sizes.second.x * sizes.second.y;
    return std::clamp<std::size_t>(40 * static_cast<std::size_t>(texels), 72000, 320000);
}

}  // namespace

FactoredBrdf factorizeFit(const Reflectance& r, HalfDiffLayout layout, const TextureSizes& sizes,
                          const FactorizeOptions& options) {
    require(r.isotropic, "factorize: method fit needs an isotropic input; use homomorphic");
    const Bake bake{r, layout, sizes, options};
    Start best = findMiddle(bake);
    LogTableModel& model = best.model;

    report(options.progress, "fitting half size", 0.3);
    resizeTables(model, sizes, 2);
    const std::size_t full = sampleCount(sizes);
    fitLogTables(model, bake.samples(full / 3, best.s),
                 {.newtonSteps = 6, .conjugateSteps = 25, .threads = options.threads});
    report(options.progress, "fitting full size", 0.5);
    resizeTables(model, sizes, 1);
    fitLogTables(model, bake.samples(full, best.s),
                 {.newtonSteps = 4, .conjugateSteps = 25, .threads = options.threads});
    report(options.progress, "fitted", 1);

    FactoredBrdf out;
    out.form = FactoredForm::HalfDiff;
    out.method = "fit";
    out.params[0] = {static_cast<float>(best.s), static_cast<float>(layout), 0, 0};
    for (int k = 0; k < 3; ++k) out.params[2 + k] = glm::vec4(best.basis[k], 0);
    const char* second = layout == HalfDiffLayout::Grazing ? "elevations" : "half_diff";
    out.textures.push_back(makeTexture("t0", "half_diff", model.tables[0].image(), options.format));
    if (model.tables.size() > 1)
        out.textures.push_back(makeTexture("t1", second, model.tables[1].image(), options.format));
    out.fetches = static_cast<int>(out.textures.size());
    return out;
}

}  // namespace nacre
