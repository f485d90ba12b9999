// The true picture of the surface in a volume: rays followed through the trilinear field in small steps, in double
// precision.
#pragma once

#include <vector>

#include "core/volume.hpp"
#include "reference/raytrace.hpp"

namespace nacre {

/// A volume in the world and the value of its surface.
struct TracedVolume {
    const Volume& volume;
    double iso;
    glm::dmat4 toWorld{1};  ///< of the volume's own space
};

/// As raytrace (raytrace.hpp), of that surface: the first point of the ray within the box where value ≥ iso, by steps
/// of an eighth of a texel and forty bisections. Normal: against the interpolated gradient (volumeGradients); towards
/// the eye where that is zero. With options.shadows light is followed the same way, from a thousandth of a texel off.
/// \throws std::invalid_argument: a size below 1, checkVolume's
RaytracedPicture traceVolume(const TracedVolume& surface, const Camera& camera, const std::vector<Light>& lights,
                             const BrdfFunction& brdf, const RaytraceOptions& options = {});

}  // namespace nacre
