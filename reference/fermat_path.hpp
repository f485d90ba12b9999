// Light through refracting planes, from one point to another: Fermat's principle. Nothing of shading/.
#pragma once

#include <optional>
#include <vector>

#include "core/math.hpp"

namespace nacre {

/// A plane that light goes through: (n, d), n·x + d = 0, n unit; index beyond it over the index before it.
struct RefractingPlane {
    Vec4 plane{0};
    double eta = 1;
};

struct FermatPath {
    std::vector<Vec3> points;  ///< where it meets the planes, in their order
    /// Of the solid angle at `from` over the area at `to` across the path that its light goes through [1/length²].
    double spread = 0;
};

/// The path of least optical length Σ n |q − q'| over points q of the planes: convex, so that there is one, and Snell's
/// law holds in it. Newton's method. `spread` is |det ∂²S/∂u∂v| of the length S, u and v across the path at its ends:
/// −∂S/∂u are the cosines with which it leaves. Without planes 1 / distance².
/// \pre from and to differ. None where a point falls on an end, or the iteration doesn't settle. The caller checks that
/// each plane parts the points before and after.
std::optional<FermatPath> fermatPath(const Vec3& from, const Vec3& to, const std::vector<RefractingPlane>& planes);

}  // namespace nacre
