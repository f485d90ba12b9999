// The specular term of a cosine power fitted to Ward's isotropic Gaussian (MPR section 5, equations 3 to 6). The fitted
// quantity is what a lamp's irradiance is multiplied by, cosine included, for ρs = 1:
//   Ward   w = cosθi · exp(−tan²δ/α²) / (√(cosθi cosθr) 4πα²)        MPR eq. 5
//   Phong  p = scale · cosδ^exponent                                  MPR eq. 6, Blinn's form
// with δ the angle between the half vector and the normal.
#pragma once

#include "core/math.hpp"

namespace nacre {

struct CosinePower {
    double scale = 1, exponent = 1;
    double operator()(const Vec3& wi, const Vec3& wo) const;
};

/// w above. \param alpha  root mean square slope, > 0. 0 at and below the horizon.
double wardSpecular(const Vec3& wi, const Vec3& wo, double alpha);

/// MPR's fit: exponent n = 1.999/α², scale .0398 n. It is the limit of perpendicular light: n → 2/α² since ln cosδ ≈
/// −δ²/2, and .0398 · 2 = 1/(4π).
CosinePower paperCosinePower(double alpha);

/// Least squares of p − w over all pairs of directions with θi, θr ≤ most, each with its solid angle: scale in closed
/// form, exponent by golden section. About 1e5 evaluations a step.
/// \throws std::invalid_argument unless 0.01 ≤ alpha ≤ 1 and 0 < most < π/2
CosinePower fitCosinePower(double alpha, double most = 80 * kPi / 180);

/// √(∫(p − w)² / ∫w²) over the same pairs.
double cosinePowerError(const CosinePower& p, double alpha, double most = 80 * kPi / 180);

/// The same for one incident elevation [rad], over the directions with θr ≤ most.
double cosinePowerErrorAt(const CosinePower& p, double alpha, double thetaI, double most = 80 * kPi / 180);

/// Isotropic rows of Ward 1992, table 1: diffuse and specular albedo and slope, as measured. (Quoted, not checked
/// against the print.)
struct WardMeasured {
    const char* name;
    double diffuse, specular, alpha;
};
inline constexpr WardMeasured kWardMeasured[] = {{"white ceramic tile", 0.70, 0.050, 0.071},
                                                 {"glossy grey paper", 0.29, 0.083, 0.082},
                                                 {"ivory computer plastic", 0.45, 0.043, 0.13},
                                                 {"plastic laminate", 0.67, 0.070, 0.092}};

}  // namespace nacre
