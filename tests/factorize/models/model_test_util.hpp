// What the tests of the analytic models share: random pairs, and quadrature over half vectors.
#pragma once

#include <random>

#include "core/directions.hpp"
#include "factorize/models/models.hpp"

namespace nacre::test {

inline constexpr double kDegree = kPi / 180;

/// Uniform on the upper hemisphere.
inline Vec3 randomDirection(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0, 1);
    const double z = unit(random), phi = 2 * kPi * unit(random), s = std::sqrt(1 - z * z);
    return {s * std::cos(phi), s * std::sin(phi), z};
}

/// Random directions whose half vectors crowd around the normal, so that narrow lobes are met: wo any, wi the mirror of
/// wo in a facet of slope about `width`. May be below the horizon.
inline DirectionPair randomPairInLobe(std::mt19937& random, double width) {
    std::uniform_real_distribution<double> unit(0, 1);
    const Vec3 wo = randomDirection(random);
    const double slope = width * 2 * unit(random), phi = 2 * kPi * unit(random);
    const Vec3 h = glm::normalize(Vec3(slope * std::cos(phi), slope * std::sin(phi), 1));
    return {2 * glm::dot(wo, h) * h - wo, wo};
}

/// ∫ g(h) dω over the hemisphere by midpoints in (u, φ), tanθ = width · u/(1 − u).
template <class Function>
Rgb integrateHalfVectors(double width, Function g, int steps = 256) {
    Rgb sum(0);
    for (int i = 0; i < steps; ++i) {
        const double u = (i + 0.5) / steps, t = width * u / (1 - u), c = 1 / std::sqrt(1 + t * t), s = t * c;
        const double dTheta = width / sqr(1 - u) * c * c / steps;
        for (int j = 0; j < steps; ++j) {
            const double phi = 2 * kPi * (j + 0.5) / steps;
            sum += g(Vec3(s * std::cos(phi), s * std::sin(phi), c)) * (s * dTheta * 2 * kPi / steps);
        }
    }
    return sum;
}

/// Directional albedo ∫ f(wi, wo) cosα dω_i, with dω_i = 4 (wo·h) dω_h.
inline Rgb albedo(const Reflectance& model, const Vec3& wo, double width, int steps = 256) {
    const auto integrand = [&](const Vec3& h) {
        const double c = glm::dot(wo, h);
        const Vec3 wi = 2 * c * h - wo;
        return c > 0 && wi.z > 0 ? model.f(wi, wo) * (wi.z * 4 * c) : Rgb(0);
    };
    return integrateHalfVectors(width, integrand, steps);
}

}  // namespace nacre::test
