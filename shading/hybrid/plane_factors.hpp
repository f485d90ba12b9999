// What each pixel of a plane before a point takes of the light that the point gives (Sillion and Puech's single plane,
// HYBRID section 3), by closed forms.
#pragma once

#include <vector>

namespace nacre {

/// Cosine: a differential area whose normal is the plane's. Its factors are form factors, 1 over the whole hemisphere
/// (Nusselt: a pixel projected onto the unit sphere, and from there onto the disk). Uniform: a point that shines alike
/// in all directions. Its factors are solid angles [sr].
enum class PlaneSource { Cosine, Uniform };

/// Factors of size × size pixels that cover the square [−halfWidth, halfWidth]² at distance 1, row by row.
/// For a rectangle from the middle to (x, y), with X = √(1 + x²), Y = √(1 + y²):
///   Cosine   (x/X · atan(y/X) + y/Y · atan(x/Y)) / 2π
///   Uniform  atan(x y / √(1 + x² + y²))
/// Differences of these between a pixel's corners are exact. O(size²)
/// \throws std::invalid_argument unless size ≥ 1 and halfWidth > 0, finite
std::vector<double> planeFactors(int size, double halfWidth, PlaneSource source);

}  // namespace nacre
