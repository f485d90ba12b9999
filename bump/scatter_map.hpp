// Scatter maps (HSE section 3.2): for chosen directions, what each texel sees there, so that light can be passed on
// from texel to texel without tracing a ray.
#pragma once

#include <vector>

#include "bump/height_map.hpp"

namespace nacre {

/// Distance along the plane [texels] at which the ray from each texel's point towards `direction` (unit) first goes
/// below the surface: the point seen is p + distance · (dx, dy)/|(dx, dy)|. 0: the ray starts below the own patch. −1:
/// nothing is hit within reachOf(map); so do holes.
/// \return row by row, width × height
/// \throws std::invalid_argument for a bad map, or a direction that is not unit length
std::vector<float> rayDistances(const HeightMap& map, const Vec3& direction, unsigned threads = 0);

/// Directions and what is seen there.
struct ScatterMap {
    std::vector<Vec3> directions;  ///< unit; also below the plane where the relief is steep enough to see there
    std::vector<double> weights;   ///< 1/(M · density) [sr]: ∫ f dω ≈ Σ weights f(directions)
    std::vector<Image> distance;   ///< of each direction: rayDistances, one channel
    int count() const { return static_cast<int>(directions.size()); }
};

struct ScatterOptions {
    int directions = 64;   ///< M ≥ 1
    unsigned threads = 0;  ///< same bits for any
};

/// Directions are stratified, half with the density of the cosine about the texels' own normals, averaged over the
/// relief (of a flat one the cosine about z, of a steep one some look down), half with the part of it that hits the
/// relief, by the horizons of four azimuths: a shallow relief is seen only near its plane. \throws
/// std::invalid_argument for a bad map or option
ScatterMap makeScatterMap(const HeightMap& map, const ScatterOptions& options = {});

/// The point seen [texels] from texel (x, y)'s centre; not wrapped. Only where the distance is ≥ 0.
Vec2 seenPoint(int x, int y, const Vec3& direction, double distance);

}  // namespace nacre
