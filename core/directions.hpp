// Unit directions in the local frame (z = shading normal, x = tangent, y = bitangent) and Rusinkiewicz's
// half-difference angles (Rusinkiewicz 1998). Angles in radians. CONVENTIONS.md has the drawing.
#pragma once

#include "core/math.hpp"

namespace nacre {

/// The pair a BRDF is asked for: wi towards the light, wo towards the viewer; unit, away from the surface.
struct DirectionPair {
    Vec3 wi, wo;
};

/// theta_h, theta_d in [0, π/2], phi_h, phi_d in [0, 2π). phi_d is 0 where it is undefined (theta_h = 0 keeps phi_h =
/// 0).
struct HalfDifference {
    double thetaH = 0, phiH = 0, thetaD = 0, phiD = 0;
};

/// (sinθ cosφ, sinθ sinφ, cosθ).
inline Vec3 sphericalDirection(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// Angle between unit vectors, exact to rounding at 0 and π where acos(dot) is not (Kahan).
double angleBetween(const Vec3& a, const Vec3& b);

/// Normalised a + b; for opposite vectors, where it has no direction, the normal (0,0,1).
Vec3 halfVector(const Vec3& wi, const Vec3& wo);

/// Rusinkiewicz's angles of a pair: d = rotation of wi that takes h to the pole.
HalfDifference halfDifference(const Vec3& wi, const Vec3& wo);

/// Inverse of halfDifference. The result may dip below the horizon: check z.
DirectionPair fromHalfDifference(const HalfDifference& angles);

}  // namespace nacre
