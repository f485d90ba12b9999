// Horizon ellipses (HSE section 3.1, equations 7 to 9; Heidrich, Daubert, Kautz & Seidel 2000): the directions that see
// the sky, projected to the tangent plane, covered by one ellipse a texel. A light is one test.
#pragma once

#include "bump/height_map.hpp"

namespace nacre {

/// HSE's centre c, axis a and radii r1, r2 as the affine map that makes the ellipse the unit circle:
///   1 − |M (lx, ly)ᵀ + o|² ≥ 0  ⇔  lit,   M = R(a)ᵀ diag(1/r1, 1/r2) R(a), o = −M c
/// (equations 7–9 with a turn of the result, which changes no length, so that M is symmetric and two texels' values can
/// be blended). Always lit: M = 0, o = 0. Always dark: M = 0, o = (2, 0).
struct HorizonEllipse {
    double m11 = 0, m12 = 0, m22 = 0;
    double o1 = 0, o2 = 0;
};

/// The left side of the test at a light's direction: lit when ≥ 0. Twin: nacre_ellipse_value (shaders/nacre/bump.glsl).
double ellipseValue(const HorizonEllipse& e, const Vec3& light);

/// Centre, axis (unit) and radii, both > 0. \throws std::invalid_argument for radii ≤ 0 or a zero axis
HorizonEllipse ellipseFromAxes(const Vec2& centre, const Vec2& axis, double r1, double r2);

enum class EllipseFit {
    Radii,  ///< the paper's: centre and axes from the lit directions' mean and covariance, radii optimised
    Full    ///< centre, axes and radii optimised
};

struct EllipseOptions {
    int directions = 128;  ///< azimuths whose exact horizons a fit sees, ≥ 8; rounded up to a multiple of 16
    EllipseFit fit = EllipseFit::Full;
    unsigned threads = 0;  ///< same bits for any
};

/// Two textures of three channels: shape = (m11, m12, m22), offset = (o1, o2, share of the sky that is seen, weighted
/// by the cosine).
struct EllipseMap {
    Image shape, offset;
    HorizonEllipse at(int x, int y) const;
};

/// Each texel's ellipse makes the area of the unit disk (so: directions weighted by the cosine) on which it is wrong
/// small. Holes are always lit.
/// \throws std::invalid_argument for a bad map or option
EllipseMap fitEllipses(const HeightMap& map, const EllipseOptions& options = {});

}  // namespace nacre
