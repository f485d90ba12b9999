// Radiance by direction as an image: the layouts, their texels' directions and exact solid angles, and the lookup that
// matches the GPU's filter. World frame: right-handed, y up. Orientation is OpenEXR's (ImfEnvmap.h), texel centres are
// at (i + 0.5)/N. CONVENTIONS.md has the drawing.
#pragma once

#include <string>
#include <vector>

#include "core/image.hpp"

namespace nacre {

/// `size` N is what a layout's other measures follow from:
///   LatLong         2N × N    row 0 at +y; the left edge at −z, then +x, +z in the middle, −x
///   Cube            N × 6N    faces +X −X +Y −Y +Z −Z from top to bottom, each as OpenEXR has it
///   DualParaboloid  N × 2N    front (+z) above back (Heidrich & Seidel 1999): (x, y)/(1 + |z|), y up
///   Octahedral      N × N     +z in the middle, −z in the corners, x to the right, y up
/// The outermost texel centres of DualParaboloid and Octahedral lie on the seam, so that clamped bilinear lookups are
/// continuous across it (DualParaboloid: up to the radiance's curvature over a texel): coordinate c in [−1, 1] is at
/// texel (c + 1)/2·(N − 1) + 0.5.
enum class EnvLayout { LatLong, Cube, DualParaboloid, Octahedral };

std::string toString(EnvLayout layout);  ///< latlong, cube, dual_paraboloid, octahedral
/// \throws std::invalid_argument that lists the known names
EnvLayout envLayoutFromString(const std::string& name);

glm::ivec2 envExtent(EnvLayout layout, int size);  ///< width, height of the image [texels]

/// A map of radiance [W/(sr·m²)], linear RGB.
struct EnvMap {
    EnvLayout layout = EnvLayout::LatLong;
    Image image;

    EnvMap() = default;
    /// Black. \throws std::invalid_argument when size < 1
    EnvMap(EnvLayout mapLayout, int size);
    /// \throws std::invalid_argument unless the image has three channels and the layout's proportions
    EnvMap(EnvLayout mapLayout, Image radiance);

    int size() const;
};

/// Unit direction of a point in texel coordinates: texel (i, j) spans [i, i+1] × [j, j+1]. In a Cube's and a
/// DualParaboloid's image, y / N says which face.
Vec3 envDirection(EnvLayout layout, int size, double x, double y);
inline Vec3 envTexelDirection(EnvLayout layout, int size, int x, int y) {
    return envDirection(layout, size, x + 0.5, y + 0.5);
}

/// Inverse of envDirection. floor of the result is the texel that holds the direction (clamp at the far edges).
glm::dvec2 envPosition(EnvLayout layout, int size, const Vec3& direction);

/// Solid angle of a texel [sr]; all of a layout's together are 4π. Closed forms but for DualParaboloid's rim, which is
/// integrated to 1e-6. 0 for a DualParaboloid's texels that lie outside both disks.
double envSolidAngle(EnvLayout layout, int size, int x, int y);
/// envSolidAngle of every texel, row by row.
std::vector<double> envSolidAngles(EnvLayout layout, int size, unsigned threads = 0);

/// Radiance in a direction (need not be unit) as GL_LINEAR gives it: a Cube seamless across edges, with the mean of the
/// three texels at a corner; a LatLong repeated around.
Rgb sampleEnv(const EnvMap& map, const Vec3& direction);

}  // namespace nacre
