// A surrounding that says where its axes are: a colour and a name on each face of the cube around the viewer.
#pragma once

#include "core/environment.hpp"

namespace nacre {

/// Seen from inside, each face's name is upright and readable: +X red, -X cyan, +Y green, -Y magenta, +Z blue, -Z
/// yellow, lines every quarter of a face, a dark frame; an arrow on the four sides points up (+y).
Rgb orientationChart(const Vec3& direction);

/// The chart as a map: a cube of 256² faces, 4 × 4 points a texel, converted by area.
EnvMap orientationChartMap(EnvLayout layout, int size);

}  // namespace nacre
