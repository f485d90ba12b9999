#include "reference/brdf_metrics.hpp"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "reference/albedo.hpp"
#include "reference/pair_sampling.hpp"
#include "reference/sphere_psnr.hpp"

namespace nacre {

namespace {

constexpr double kLogFloor = 1e-3;       // ε of E_log [1/sr]
constexpr double kRelativeFloor = 1e-2;  // of max_rel [1/sr]
constexpr double kNoLight = 1e-12;       // root mean square of a truth that is 0 but for rounding [1/sr]
constexpr double kBlack = 1e-6;          // of what may stand for it [1/sr]: a thousandth of ε, which no picture shows
constexpr std::size_t kChunk = 2048;     // pairs a task: fixes the order of all sums
constexpr double kInfinity = std::numeric_limits<double>::infinity();
const double kCosBody = std::cos(80 * kPi / 180), kCosGrazing = std::cos(89 * kPi / 180);

using Region = TruthSample::Region;

struct ErrorSums {
    double body = 0, bodyTruth = 0, grazing = 0, grazingTruth = 0, logSquare = 0, weight = 0, grazingWeight = 0,
           maxRel = 0;
    std::uint64_t samples = 0, negative = 0, nonFinite = 0;
};

double square(const Rgb& v) { return glm::dot(v, v); }

double logSquare(const Rgb& approximate, const Rgb& truth) {
    double sum = 0;
    for (int c = 0; c < 3; ++c)
        sum += sqr(std::log((std::max(approximate[c], 0.0) + kLogFloor) / (truth[c] + kLogFloor)));
    return sum;
}

double relativeError(const Rgb& approximate, const Rgb& truth) {
    double worst = 0;
    for (int c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(approximate[c] - truth[c]) / (truth[c] + kRelativeFloor));
    return worst;
}

void accumulate(ErrorSums& sums, const TruthSample& s, const Rgb& approximate) {
    const bool finite = isFinite(approximate);
    sums.nonFinite += !finite;
    sums.negative += approximate.r < 0 || approximate.g < 0 || approximate.b < 0;
    const double error = finite ? s.weight * square(approximate - s.f) : kInfinity;
    if (s.region == Region::Body) {
        ++sums.samples;
        sums.body += error;
        sums.bodyTruth += s.weight * square(s.f);
        sums.logSquare += finite ? s.weight * logSquare(approximate, s.f) : kInfinity;
        sums.weight += s.weight;
        sums.maxRel = std::max(sums.maxRel, finite ? relativeError(approximate, s.f) : kInfinity);
    } else if (s.region == Region::Grazing) {
        sums.grazing += error;
        sums.grazingTruth += s.weight * square(s.f);
        sums.grazingWeight += s.weight;
    } else if (!finite) {
        sums.grazing = kInfinity;
    }
}

ErrorSums& operator+=(ErrorSums& a, const ErrorSums& b) {
    a.body += b.body, a.bodyTruth += b.bodyTruth, a.grazing += b.grazing, a.grazingTruth += b.grazingTruth;
    a.logSquare += b.logSquare, a.weight += b.weight, a.grazingWeight += b.grazingWeight,
        a.maxRel = std::max(a.maxRel, b.maxRel);
    a.samples += b.samples, a.negative += b.negative, a.nonFinite += b.nonFinite;
    return a;
}

/// Both sums over channels and samples of this weight. A truth without light has no scale: 0 for what is as black.
double relativeL2(double error, double truth, double weight) {
    if (truth <= 3 * weight * sqr(kNoLight)) return error <= 3 * weight * sqr(kBlack) ? 0 : kInfinity;
    return std::sqrt(error / truth);
}

ErrorSums sumErrors(const BrdfFunction& approximate, const std::vector<TruthSample>& truth, unsigned threads) {
    std::vector<ErrorSums> parts((truth.size() + kChunk - 1) / kChunk);
    parallelFor(parts.size(), threads, [&](std::size_t chunk) {
        const std::size_t end = std::min(truth.size(), (chunk + 1) * kChunk);
        for (std::size_t i = chunk * kChunk; i < end; ++i)
            accumulate(parts[chunk], truth[i], approximate(truth[i].wi, truth[i].wo));
    });
    ErrorSums total;
    for (const ErrorSums& part : parts) total += part;
    return total;
}

TruthSample toSample(const WeightedPair& drawn, const BrdfFunction& truth) {
    TruthSample s{drawn.pair.wi, drawn.pair.wo, truth(drawn.pair.wi, drawn.pair.wo), drawn.weight, Region::Horizon};
    const double lower = std::min(s.wi.z, s.wo.z);
    if (lower >= kCosGrazing) s.region = lower >= kCosBody ? Region::Body : Region::Grazing;
    return s;
}

void checkTruth(const std::vector<TruthSample>& samples) {
    for (const TruthSample& s : samples) {
        if (isFinite(s.f) && std::min(s.f.r, std::min(s.f.g, s.f.b)) >= 0) continue;
        const auto text = [](const Vec3& v) { return fmt::format("({}, {}, {})", v.x, v.y, v.z); };
        throw std::invalid_argument("measureBrdf: the true BRDF must be finite and >= 0, found " + text(s.f) +
                                    " for wi = " + text(s.wi) + ", wo = " + text(s.wo));
    }
}

}  // namespace

std::vector<TruthSample> sampleTruth(const BrdfFunction& truth, const BrdfMetricOptions& options) {
    require(options.samples >= 2 && options.samples <= (std::uint64_t{1} << 32), "measureBrdf: samples not in 2..2^32");
    std::vector<std::vector<TruthSample>> parts((options.samples + kChunk - 1) / kChunk);
    parallelFor(parts.size(), options.threads, [&](std::size_t chunk) {
        const std::uint64_t end = std::min<std::uint64_t>(options.samples, (chunk + 1) * kChunk);
        for (std::uint64_t n = chunk * kChunk; n < end; ++n)
            if (const WeightedPair drawn = drawPair(n, options.samples, options.seed); drawn.weight > 0)
                parts[chunk].push_back(toSample(drawn, truth));
    });
    std::vector<TruthSample> samples;
    for (const auto& part : parts) samples.insert(samples.end(), part.begin(), part.end());
    checkTruth(samples);
    return samples;
}

double l2Rel(const BrdfFunction& approximate, const std::vector<TruthSample>& truth, unsigned threads) {
    const ErrorSums sums = sumErrors(approximate, truth, threads);
    return relativeL2(sums.body, sums.bodyTruth, sums.weight);
}

double l2Rel(const BrdfFunction& approximate, const BrdfFunction& truth, const BrdfMetricOptions& options) {
    return l2Rel(approximate, sampleTruth(truth, options), options.threads);
}

BrdfError measureBrdf(const BrdfFunction& approximate, const BrdfFunction& truth, const BrdfMetricOptions& options) {
    const ErrorSums sums = sumErrors(approximate, sampleTruth(truth, options), options.threads);
    BrdfError error;
    error.l2Rel = relativeL2(sums.body, sums.bodyTruth, sums.weight);
    error.logRms = sums.logSquare == 0 ? 0 : std::sqrt(sums.logSquare / (3 * sums.weight));
    error.maxRel = sums.maxRel;
    error.grazingL2Rel = relativeL2(sums.grazing, sums.grazingTruth, sums.grazingWeight);
    error.spherePsnr = spherePsnr(approximate, truth, options.threads);
    error.albedoMaxAbs = albedoMaxAbs(approximate, truth, options.isotropic ? 1 : 4, options.threads);
    if (options.truthEnergy > 0)
        error.energySeen = sums.bodyTruth / static_cast<double>(options.samples) / options.truthEnergy;
    error.samples = sums.samples;
    error.negative = sums.negative;
    error.nonFinite = sums.nonFinite;
    return error;
}

nlohmann::json toJson(const BrdfError& e) {
    return {{"l2_rel", e.l2Rel},           {"log_rms", e.logRms},
            {"max_rel", e.maxRel},         {"grazing_l2_rel", e.grazingL2Rel},
            {"sphere_psnr", e.spherePsnr}, {"albedo_max_abs", e.albedoMaxAbs},
            {"energy_seen", e.energySeen}, {"samples", e.samples},
            {"negative", e.negative},      {"non_finite", e.nonFinite}};
}

}  // namespace nacre
