// Distribution, masking and Fresnel terms of micro-facet models as functions of angles [rad].
#pragma once

#include <complex>

#include "core/math.hpp"

namespace nacre::terms {

// Distributions D(θh, φh) [1/sr], ∫ D cosθh dωh = 1.

/// Walter 2007, eq. 25.
inline double beckmann(double theta, double alpha) {
    return std::exp(-sqr(std::tan(theta) / alpha)) / (kPi * sqr(alpha) * std::pow(std::cos(theta), 4));
}
/// Walter 2007, eq. 33, stretched along x and y (Burley 2012, appendix B).
inline double ggx(double theta, double phi, double alphaX, double alphaY) {
    const double slope2 = sqr(std::tan(theta)) * (sqr(std::cos(phi) / alphaX) + sqr(std::sin(phi) / alphaY));
    return 1 / (kPi * alphaX * alphaY * std::pow(std::cos(theta), 4) * sqr(1 + slope2));
}
/// ∫ exp(−(δ/α)²) cosδ dω over the hemisphere, by the midpoint rule: what a Gaussian of the angle is divided by.
inline double gaussianNorm(double alpha) {
    constexpr int kSteps = 100000;  // h² error below 1e-9
    const double end = std::min(kPi / 2, 10 * alpha), step = end / kSteps;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double delta = (i + 0.5) * step;
        sum += std::exp(-sqr(delta / alpha)) * std::cos(delta) * std::sin(delta);
    }
    return 2 * kPi * sum * step;
}

// Smith's Λ(θ): G1 = 1/(1 + Λ). 0 at normal incidence, where tanθ = 0.

/// Heitz 2014, eq. 72: Λ = (erf a − 1)/2 + exp(−a²)/(2a√π), a = 1/(α tanθ).
inline double beckmannLambda(double theta, double alpha) {
    const double a = 1 / (alpha * std::tan(theta));
    return a > 30 ? 0 : -0.5 * std::erfc(a) + std::exp(-a * a) / (2 * a * std::sqrt(kPi));
}
/// Heitz 2014, eq. 72 and 80: Λ = (√(1 + α²tan²θ) − 1)/2, α that of the direction's azimuth.
inline double ggxLambda(double theta, double phi, double alphaX, double alphaY) {
    const double alpha2 = sqr(alphaX * std::cos(phi)) + sqr(alphaY * std::sin(phi));
    return (std::sqrt(1 + alpha2 * sqr(std::tan(theta))) - 1) / 2;
}

// Fresnel reflectance of unpolarised light at angle θ from outside.

/// From the complex amplitudes rs = (cosθ − m cosθt)/(cosθ + m cosθt), rp = (m cosθ − cosθt)/(m cosθ + cosθt) with
/// m = eta + ik, cosθt = √(1 − sin²θ/m²) (Snell). k = 0 is a dielectric, total reflection included; m = 1 no interface.
inline double fresnel(double theta, double eta, double k) {
    if (eta == 1 && k == 0) return 0;  // 0/0 at grazing
    const std::complex<double> m(eta, k), cosT = std::sqrt(1.0 - sqr(std::sin(theta)) / (m * m));
    const double c = std::cos(theta);
    return (std::norm((c - m * cosT) / (c + m * cosT)) + std::norm((m * c - cosT) / (m * c + cosT))) / 2;
}
/// Schlick 1994, eq. 15.
inline Rgb schlick(double theta, const Rgb& f0) { return f0 + (Rgb(1) - f0) * std::pow(1 - std::cos(theta), 5); }

}  // namespace nacre::terms
