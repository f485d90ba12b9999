// Fresnel reflectance of unpolarised light at a smooth interface, seen from the outside: exact for dielectrics and
// conductors, and Schlick's approximation. `cosTheta` is the cosine of the angle to the (micro-facet) normal, in
// [0, 1]; results are in [0, 1]. All are finite over the whole closed range, grazing included.
#pragma once

#include "core/math.hpp"

namespace nacre {

/// Exact Fresnel reflectance of a conductor with index η + ik relative to the outside (Born & Wolf, section 14.2).
///
/// With the complex cosine inside, a + ib = √(η² − k² − sin²θ + 2iηk):
///   Rs = ((a − c)² + b²) / ((a + c)² + b²),   c = cosθ
///   Rp = Rs · ((a c − s²)² + b² c²) / ((a c + s²)² + b² c²),   s = sinθ;   F = (Rs + Rp)/2.
/// k = 0 is a dielectric; then η < 1 reflects totally beyond the critical angle. η = 1, k = 0 is no interface: 0 at
/// every angle, grazing too. a − c is computed as (η² − k² − 1 + b²)/(a + c), which keeps its digits near η = 1.
/// \param eta  > 0;  \param k  ≥ 0
inline double fresnelConductor(double cosTheta, double eta, double k) {
    if (eta == 1.0 && k == 0.0) return 0.0;
    const double c = clamp01(cosTheta), c2 = c * c, s2 = 1.0 - c2;
    const double re = (eta - k) * (eta + k) - s2, im = 2.0 * eta * k, modulus = std::hypot(re, im);
    double a, b;  // the larger part from the sum, the other from a b = ηk: neither subtracts nearly equal numbers
    if (re >= 0.0) {
        a = std::sqrt(0.5 * (modulus + re));
        b = a > 0.0 ? eta * k / a : 0.0;
    } else {
        b = std::sqrt(0.5 * (modulus - re));
        a = eta * k / b;
    }
    const double sum = a + c;
    if (sum == 0.0) return 1.0;  // exactly grazing, nothing gets in
    const double difference = ((eta - 1.0) * (eta + 1.0) - k * k + b * b) / sum;
    const double rs = (sqr(difference) + b * b) / (sqr(sum) + b * b);
    const double rp = rs * (sqr(a * c - s2) + b * b * c2) / (sqr(a * c + s2) + b * b * c2);
    return std::min(1.0, 0.5 * (rs + rp));
}

/// Exact Fresnel reflectance of a dielectric of relative index η (Cook & Torrance 1982, section 4), with g² = η² − 1 +
/// c²:
///   F = ½ ((g − c)/(g + c))² · (1 + ((c(g + c) − 1)/(c(g − c) + 1))²);   1 where g² < 0 (total internal reflection).
/// g − c is computed as (η² − 1)/(g + c). η = 1 is no interface: 0 at every angle, grazing too.
/// \param eta  > 0
inline double fresnelDielectric(double cosTheta, double eta) {
    if (eta == 1.0) return 0.0;
    const double c = clamp01(cosTheta), contrast = (eta - 1.0) * (eta + 1.0), g2 = contrast + c * c;
    if (g2 <= 0.0) return 1.0;
    const double sum = std::sqrt(g2) + c, difference = contrast / sum;
    const double ratio = (c * sum - 1.0) / (c * difference + 1.0);
    return std::min(1.0, 0.5 * sqr(difference / sum) * (1.0 + ratio * ratio));
}

/// (1 − cosθ)⁵.
inline double schlickWeight(double cosTheta) {
    const double m = clamp01(1.0 - cosTheta), m2 = m * m;
    return m2 * m2 * m;
}

/// Schlick's approximation F = f0 + (1 − f0)(1 − cosθ)⁵ (Schlick 1994, eq. 15). \param f0  reflectance at cosθ = 1
inline double fresnelSchlick(double cosTheta, double f0) { return f0 + (1.0 - f0) * schlickWeight(cosTheta); }
inline Rgb fresnelSchlick(double cosTheta, const Rgb& f0) { return f0 + (Rgb(1.0) - f0) * schlickWeight(cosTheta); }

/// Reflectance at normal incidence ((η − 1)² + k²)/((η + 1)² + k²).
inline double normalReflectance(double eta, double k = 0.0) {
    return (sqr(eta - 1.0) + k * k) / (sqr(eta + 1.0) + k * k);
}

}  // namespace nacre
