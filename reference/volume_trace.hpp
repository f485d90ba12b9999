// The true picture of the surface in a volume.
#pragma once

#include <vector>

#include "reference/raytrace.hpp"
#include "reference/volume_field.hpp"

namespace nacre {

/// As raytrace (raytrace.hpp), of that surface: the first point of the ray within the box where value ≥ iso
/// (volume_field.hpp). With options.shadows light is followed the same way.
/// \throws std::invalid_argument: a size below 1, checkVolume's
RaytracedPicture traceVolume(const TracedVolume& surface, const Camera& camera, const std::vector<Light>& lights,
                             const BrdfFunction& brdf, const RaytraceOptions& options = {});

}  // namespace nacre
