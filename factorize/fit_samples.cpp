#include "factorize/fit_samples.hpp"

#include <fmt/format.h>

#include "core/directions.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/sampling.hpp"
#include "factorize/mappings.hpp"

namespace nacre {
namespace {

constexpr double kSlopeMiddle = 1.5;         // as in mapping scaled_slope
constexpr std::uint64_t kFirstPoint = 1000;  // skips the Halton sequence's correlated start

struct HalfVector {
    double theta, phi, inverseDensity;  ///< inverse density per solid angle
};

/// pdf of θ = (π/2) a² for uniform a, per solid angle (up to 1/2π, which both densities share).
double densityBySqrtTheta(double theta) { return 1 / (std::sin(theta) * std::sqrt(2 * kPi * theta)); }

/// pdf of a uniform radius ρ on the scaled-slope disk; |m| = 1.5 ρ²/(1 − ρ²).
double densityBySlope(double theta, double phi, const glm::dvec2& width) {
    const double c = std::cos(theta), t = std::tan(theta);
    const double m = t * std::hypot(std::cos(phi) / width.x, std::sin(phi) / width.y);
    const double rho = std::sqrt(m / (m + kSlopeMiddle)),
                 slope = 2 * kSlopeMiddle * rho / sqr(1 - rho * rho);  // d|m|/dρ
    return 1 / (c * c * c * width.x * width.y * std::max(m, 1e-300) * slope);
}

HalfVector drawHalfVector(double a, double b, bool bySlope, const FitSampleOptions& options) {
    HalfVector out{0, options.isotropic ? 0 : 2 * kPi * b, 0};
    if (bySlope) {
        const double rho = std::clamp(a, 1e-4, 0.99999), m = kSlopeMiddle * rho * rho / (1 - rho * rho);
        const glm::dvec2 slope(options.width.x * m * std::cos(out.phi), options.width.y * m * std::sin(out.phi));
        out.theta = std::atan(glm::length(slope));
        out.phi = options.isotropic ? 0 : std::atan2(slope.y, slope.x);
    } else {
        out.theta = std::max(kPi / 2 * a * a, 1e-9);
    }
    out.inverseDensity =
        1 / (0.5 * densityBySqrtTheta(out.theta) + 0.5 * densityBySlope(out.theta, out.phi, options.width));
    return out;
}

}  // namespace

std::vector<FitSample> fitSamples(const BrdfFunction& f, const FitSampleOptions& options) {
    require(options.count >= 1, "fitSamples: count must be >= 1");
    std::vector<FitSample> all(options.count);
    const double lowest = std::cos(options.maxTheta);
    parallelFor(options.count, options.threads, [&](std::size_t i) {
        const std::uint64_t n = kFirstPoint + i / 2;
        const HalfVector h = drawHalfVector(radicalInverse(n, 2), radicalInverse(n, 7), i % 2 == 0, options);
        const double thetaD = kPi / 2 * radicalInverse(n, 3), phiD = 2 * kPi * radicalInverse(n, 5);
        const DirectionPair pair = fromHalfDifference({h.theta, h.phi, thetaD, phiD});
        FitSample& s = all[i];
        if (pair.wi.z < lowest || pair.wo.z < lowest) return;  // measure stays 0: dropped below
        s.wi = pair.wi;
        s.wo = pair.wo;
        s.value = glm::vec3(f(pair.wi, pair.wo));
        s.measure =
            static_cast<float>(4 * std::cos(thetaD) * std::sin(thetaD) * pair.wi.z * pair.wo.z * h.inverseDensity);
    });
    std::erase_if(all, [](const FitSample& s) { return !(s.measure > 0); });
    if (all.empty()) throw Error("factorize: no direction pair above the horizon could be sampled");
    for (const FitSample& s : all)
        if (!isFinite(Vec3(s.value)) || s.value.x < 0 || s.value.y < 0 || s.value.z < 0)
            throw Error(fmt::format("factorize: expected a finite BRDF >= 0, found ({}, {}, {}) at wi ({}, {}, {})",
                                    s.value.x, s.value.y, s.value.z, s.wi.x, s.wi.y, s.wi.z));
    return all;
}

double lobeHalfWidth(const BrdfFunction& f) {
    constexpr double kThetaD = 0.35;
    const auto at = [&](double theta) {
        const DirectionPair p = fromHalfDifference({theta, 0, kThetaD, kPi / 2});
        return mean(f(p.wi, p.wo));
    };
    const double foot = at(1.2), peak = at(1e-5);
    double theta = 1e-3;
    while (theta < kPi / 4 && at(theta) - foot > 0.5 * (peak - foot)) theta *= 1.04;
    return std::clamp(std::tan(theta), 1e-3, 1.0);
}

bool isQuadrantSymmetric(const BrdfFunction& f) {
    for (std::uint64_t i = 1; i <= 200; ++i) {
        const Vec3 wi = cosineHemisphere({radicalInverse(i, 2), radicalInverse(i, 3)});
        const Vec3 wo = cosineHemisphere({radicalInverse(i, 5), radicalInverse(i, 7)});
        const double scale = 1e-3 + maxComponent(f(wi, wo));
        for (const Vec3& mirror : {Vec3(-1, 1, 1), Vec3(1, -1, 1)})
            if (maxComponent(glm::abs(f(mirror * wi, mirror * wo) - f(wi, wo))) > 1e-3 * scale) return false;
    }
    return true;
}

}  // namespace nacre
