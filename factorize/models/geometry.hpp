// Masking and shadowing. Each function returns the visibility V = G / (4 cosα cosβ) [without unit], α of wi and β of
// wo, where G is the share of facets seen from both: the quotient stays finite at grazing angles where G and the
// cosines vanish together. Both directions are above the horizon.
#pragma once

#include "factorize/models/distributions.hpp"

namespace nacre {

/// Smith masking for the Beckmann distribution, exact (Walter 2007, section 5.2; no rational fit), divided by cosθ:
///   G1 = 2 / (1 + erf a + exp(−a²)/(a√π)),   a = cosθ/(α sinθ);   G1/cosθ = 2 / (cosθ (1 + erf a) + α sinθ
///   exp(−a²)/√π)
inline double beckmannG1OverCos(double cosTheta, double sinTheta, double alpha) {
    constexpr double kInvSqrtPi = 0.56418958354775628695;
    const double slope = alpha * sinTheta;
    if (cosTheta > 6.0 * slope) return 1.0 / cosTheta;  // erf(6) = 1, exp(-36) = 2e-16: exact in double
    const double a = cosTheta / slope;
    return 2.0 / (cosTheta * (1.0 + std::erf(a)) + slope * std::exp(-a * a) * kInvSqrtPi);
}

/// Uncorrelated (separable) Smith, G = G1(wi) G1(wo), for Beckmann slopes of width alpha.
struct BeckmannSmith {
    double alpha;
    double operator()(const Vec3& wi, const Vec3& wo) const {
        return 0.25 * beckmannG1OverCos(wi.z, std::sqrt(sinSquared(wi)), alpha) *
               beckmannG1OverCos(wo.z, std::sqrt(sinSquared(wo)), alpha);
    }
};

/// r(w) = √(cos²θ + αx² w.x² + αy² w.y²), the length of the stretched direction (Heitz 2014, eq. 86: Λ = (r/cosθ −
/// 1)/2).
inline double ggxRadius(const Vec3& w, double alphaX, double alphaY) {
    return std::sqrt(w.z * w.z + sqr(alphaX * w.x) + sqr(alphaY * w.y));
}

/// Uncorrelated (separable) Smith for GGX: G1/cosθ = 2 / (cosθ + r).
struct GgxSmith {
    double alphaX, alphaY;
    double operator()(const Vec3& wi, const Vec3& wo) const {
        return 1.0 / ((wi.z + ggxRadius(wi, alphaX, alphaY)) * (wo.z + ggxRadius(wo, alphaX, alphaY)));
    }
};

/// Height-correlated Smith for GGX (Heitz 2014, eq. 99): G = 1/(1 + Λ(wi) + Λ(wo)),
///   V = 1 / (2 (cosβ r(wi) + cosα r(wo)))
struct GgxSmithCorrelated {
    double alphaX, alphaY;
    double operator()(const Vec3& wi, const Vec3& wo) const {
        return 0.5 / (wo.z * ggxRadius(wi, alphaX, alphaY) + wi.z * ggxRadius(wo, alphaX, alphaY));
    }
};

/// V-shaped grooves (Torrance & Sparrow 1967; Cook & Torrance 1982, the closed form):
///   G = min(1, 2 (n·h)(n·wo)/(wo·h), 2 (n·h)(n·wi)/(wo·h));   it depends on h as well as on the elevations.
struct VCavity {
    double operator()(const Vec3& wi, const Vec3& wo) const {
        const Vec3 sum = wi + wo;  // = 2 (wo·h) h, so (n·h)/(wo·h) = 2 sum.z/|sum|²
        const double slope = 4.0 * sum.z / glm::dot(sum, sum);
        return 0.25 * std::min(1.0 / (wi.z * wo.z), slope / std::max(wi.z, wo.z));
    }
};

}  // namespace nacre
