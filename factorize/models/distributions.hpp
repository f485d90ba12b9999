// Micro-facet distributions D(h) [1/sr]: differential area of facets with normal h per unit macroscopic area. Each is
// normalised, ∫ D(h) (n·h) dω_h = 1 over the hemisphere, and takes tangents from the components of h, so that narrow
// lobes keep their digits (acos(h.z) loses half of them).
#pragma once

#include "core/math.hpp"

namespace nacre {

/// sin²θ of a unit vector, from x and y: exact near the pole.
inline double sinSquared(const Vec3& h) { return h.x * h.x + h.y * h.y; }

/// e^(−x), 0 from x = 700 on: what is left out is below 1e-304, and denormal results would cost ten times the rest.
inline double expNegative(double x) { return x < 700.0 ? std::exp(-x) : 0.0; }

/// Beckmann (Beckmann & Spizzichino 1963, as normalised by Walter 2007, eq. 25):
///   D = exp(−tan²δ/α²) / (π α² cos⁴δ),   α > 0 = √2 × rms slope
struct BeckmannDistribution {
    double alpha;
    double operator()(const Vec3& h) const {
        if (h.z < 1e-6) return 0.0;  // tan²δ > 1e12: the exponential is exactly 0 for α ≤ 1, and cos⁴ may underflow
        const double c2 = h.z * h.z, a2 = alpha * alpha;
        return expNegative(sinSquared(h) / (c2 * a2)) / (kPi * a2 * c2 * c2);
    }
};

/// GGX / Trowbridge–Reitz, elliptical (Walter 2007, eq. 33; anisotropic as Burley 2012, eq. 13):
///   D = 1 / (π αx αy ((h.x/αx)² + (h.y/αy)² + h.z²)²)
struct GgxDistribution {
    double alphaX, alphaY;
    double operator()(const Vec3& h) const {
        const double q = sqr(h.x / alphaX) + sqr(h.y / alphaY) + h.z * h.z;
        return 1.0 / (kPi * alphaX * alphaY * q * q);
    }
};

/// Gaussian of the angle (Torrance & Sparrow 1967; Cook & Torrance 1982 write D = c exp(−(δ/m)²)):
///   D = c exp(−(δ/α)²),   c = 1 / (2π ∫_0^{π/2} exp(−(δ/α)²) cosδ sinδ dδ)
struct GaussianDistribution {
    double alpha, scale;
    explicit GaussianDistribution(double a) : alpha(a), scale(1.0 / normalisation(a)) {}
    double operator()(const Vec3& h) const {
        const double delta = std::atan2(std::sqrt(sinSquared(h)), h.z);
        return scale * expNegative(sqr(delta / alpha));
    }

private:
    /// Simpson's rule over [0, min(π/2, 9α)]: e^(−81) is below double precision; its own error is about 1e-13.
    static double normalisation(double a) {
        constexpr int kSteps = 8192;
        const double end = std::min(0.5 * kPi, 9.0 * a), step = end / kSteps;
        double sum = 0;
        for (int i = 0; i <= kSteps; ++i) {
            const double delta = step * i, weight = i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
            sum += weight * std::exp(-sqr(delta / a)) * 0.5 * std::sin(2.0 * delta);
        }
        return 2.0 * kPi * sum * step / 3.0;
    }
};

/// Elliptical Gaussian of the slopes, Ward 1992 eq. 5a, without the 1/4 and the elevation term:
///   W = exp(−tan²δ (cos²φ/αx² + sin²φ/αy²)) / (π αx αy)
/// W/cos⁴δ is the normalised (anisotropic Beckmann) distribution; W itself is what Ward's formula has.
struct WardGaussian {
    double alphaX, alphaY;
    double operator()(const Vec3& h) const {
        if (h.z < 1e-6) return 0.0;  // as in BeckmannDistribution
        return expNegative((sqr(h.x / alphaX) + sqr(h.y / alphaY)) / (h.z * h.z)) / (kPi * alphaX * alphaY);
    }
};

}  // namespace nacre
