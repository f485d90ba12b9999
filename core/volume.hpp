// A scalar field on a regular grid, and the surface in it: what shading/volume_pass.hpp slices and
// reference/volume_trace.hpp follows rays through.
#pragma once

#include <vector>

#include "core/math.hpp"

namespace nacre {

/// Samples at the texel centres (i + 0.5, j + 0.5, k + 0.5) of a box of size.x × size.y × size.z texels, trilinear
/// between them and constant in the outer half texel, as GL_LINEAR with GL_CLAMP_TO_EDGE. Where value ≥ iso is inside.
struct Volume {
    glm::ivec3 size{0};
    Vec3 spacing{1};            ///< edges of a texel, > 0; only their ratios matter (volumeToLocal)
    std::vector<float> values;  ///< x fastest, then y, then z; finite

    float at(int x, int y, int z) const {
        return values[(static_cast<std::size_t>(z) * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(y)) *
                          static_cast<std::size_t>(size.x) +
                      static_cast<std::size_t>(x)];
    }
};

/// How a picture finds the surface. Slices: polygons across the volume, facing the camera, nearest first; fragments
/// outside the surface are discarded, which is the paper's alpha test (HSE figure 7), and the depth test keeps the
/// first. A surface point is up to a step off along the line of sight. March: one fragment a pixel follows its line of
/// sight and finds the crossing within the step.
enum class VolumeMethod { Slices, March };

/// \throws std::invalid_argument: a size < 1, another number of values, values not finite, a spacing not finite or ≤ 0
void checkVolume(const Volume& volume);

/// Texture coordinates [0, 1]³ to the volume's own space: centred at the origin, the longest edge 2 units long.
glm::dmat4 volumeToLocal(const Volume& volume);

/// The field at texture coordinates `at`; outside [0, 1]³ the border's value.
double sampleVolume(const Volume& volume, const Vec3& at);

/// ∂value/∂(own space) at each sample: central differences, one-sided at the border; x fastest. 0 along an axis of one
/// texel. A shader and the reference interpolate these trilinearly (Westermann & Ertl 1998: gradients in RGB).
std::vector<glm::vec3> volumeGradients(const Volume& volume);

/// `gradients` interpolated at texture coordinates `at`.
Vec3 sampleGradients(const Volume& volume, const std::vector<glm::vec3>& gradients, const Vec3& at);

}  // namespace nacre
