// Horizons: how far the sky is hidden, azimuth by azimuth (Max 1988; HSE section 3.1).
#pragma once

#include <vector>

#include "bump/height_map.hpp"

namespace nacre {

/// Tangent of the horizon's elevation above the plane, ≥ 0, of every texel towards `azimuth` [rad, from x to y]:
/// sup over the line from the texel's point of (height − own height) / distance, the slope of the own patch included,
/// to within 1e-3. Blockers end at reachOf(map). Holes answer 0. \return row by row, width × height \throws
/// std::invalid_argument for a bad map or azimuth Cost: the texels on a line until nothing ahead can rise higher, but
/// for those of which bounds tell that they can't; texels are 32 at a time. Memory: 16 bytes a texel and azimuth at
/// work. Same bits for any thread count and processor.
std::vector<float> horizonSlopes(const HeightMap& map, double azimuth, unsigned threads = 0);

/// Elevations [rad], 0…π/2, towards the azimuths 2πk/K.
struct HorizonMap {
    std::vector<Image> elevation;  ///< K images of one channel
    int azimuths() const { return static_cast<int>(elevation.size()); }
};

/// \param azimuths  K ≥ 1
HorizonMap makeHorizonMap(const HeightMap& map, int azimuths, unsigned threads = 0);

/// Elevation at a texel towards any azimuth, linear between the two next: what a shader reads. \throws nothing
double horizonElevation(const HorizonMap& map, int x, int y, double azimuth);

}  // namespace nacre
