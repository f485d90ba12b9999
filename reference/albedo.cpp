#include "reference/albedo.hpp"

#include <limits>
#include <vector>

#include "core/directions.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "reference/pair_sampling.hpp"

namespace nacre {

static constexpr int kElevations = 16;

/// Point i of `count` on the lattice ((i+½)/count, frac(i·golden ratio)).
static Vec2 lattice(std::uint64_t i, std::uint64_t count) {
    const double turn = static_cast<double>(i) * 0.6180339887498949;
    return {(static_cast<double>(i) + 0.5) / static_cast<double>(count), turn - std::floor(turn)};
}

/// wi for one of 4·quarter points: half by cosine, a quarter as the mirror image of wo about an h drawn either way.
static Vec3 drawIncident(std::uint64_t n, std::uint64_t quarter, const Vec3& wo) {
    if (n < 2 * quarter) {
        const Vec2 u = lattice(n, 2 * quarter);  // radius² = u.x
        return {std::sqrt(u.x) * std::cos(2 * kPi * u.y), std::sqrt(u.x) * std::sin(2 * kPi * u.y), std::sqrt(1 - u.x)};
    }
    const Vec2 u = lattice(n % quarter, quarter);
    const Vec3 h =
        sphericalDirection(drawThetaH(n < 3 * quarter ? ThetaHDraw::Body : ThetaHDraw::Peak, u.x), 2 * kPi * u.y);
    return 2 * glm::dot(wo, h) * h - wo;
}

/// Density of wi [1/sr]: ½ cosθi/π + ½ p(h)/(4 wo·h), p(h) = thetaHDensity/(2π sinθh).
static double incidentDensity(const Vec3& wi, const Vec3& wo) {
    const Vec3 h = halfVector(wi, wo);
    const double thetaH = std::max(angleBetween(h, Vec3(0, 0, 1)), 1e-12);
    const double byHalf = thetaHDensity(thetaH) / (2 * kPi * std::sin(thetaH)) / (4 * glm::dot(wo, h));
    return 0.5 * wi.z / kPi + 0.5 * byHalf;
}

Rgb directionalAlbedo(const BrdfFunction& f, const Vec3& wo, std::uint64_t samples) {
    require(wo.z > 0 && samples >= 4, "directionalAlbedo: wo must be above the horizon, samples >= 4");
    const std::uint64_t quarter = samples / 4;
    Rgb sum(0);
    for (std::uint64_t n = 0; n < 4 * quarter; ++n) {
        const Vec3 wi = drawIncident(n, quarter, wo);
        if (wi.z > 0) sum += f(wi, wo) * (wi.z / incidentDensity(wi, wo));
    }
    return sum / static_cast<double>(4 * quarter);
}

double albedoMaxAbs(const BrdfFunction& approximate, const BrdfFunction& truth, int azimuths, unsigned threads) {
    require(azimuths >= 1, "albedoMaxAbs: azimuths must be >= 1");
    const BrdfFunction difference = [&](const Vec3& wi, const Vec3& wo) { return approximate(wi, wo) - truth(wi, wo); };
    std::vector<double> errors(static_cast<std::size_t>(kElevations * azimuths));
    parallelFor(errors.size(), threads, [&](std::size_t i) {
        const double theta = (static_cast<double>(i % kElevations) + 0.5) * kPi / 2 / kElevations;
        const double phi = (static_cast<double>(i / kElevations) + 0.5) * kPi / 4;
        const Rgb d = directionalAlbedo(difference, sphericalDirection(theta, phi));
        errors[i] = isFinite(d) ? maxComponent(glm::abs(d)) : std::numeric_limits<double>::infinity();
    });
    return *std::max_element(errors.begin(), errors.end());
}

}  // namespace nacre
