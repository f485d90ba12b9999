// A map's texels as weighted points on the sphere: what the filters sum over.
#pragma once

#include <vector>

#include "core/environment.hpp"
#include "envmaps/sphere_transform.hpp"

namespace nacre {

/// One point a texel, at its centre: weight (radiance · Ω, Ω) with the exact solid angle Ω [sr]. Texels outside both
/// paraboloids are left out.
std::vector<SpherePoint> texelPoints(const EnvMap& map, unsigned threads = 0);

/// One point for every block × block texels, at the middle of their solid angles, but single texels where a block's
/// light is off its middle: where |Σ w_i (d_i − middle)| of the light w = Ω (|r| + |g| + |b|) is more than
/// `offCentre` of all the light. `block` divides the map's size.
std::vector<SpherePoint> blockPoints(const EnvMap& map, int block, double offCentre, unsigned threads = 0);

/// Every texel's direction, row by row.
std::vector<Vec3> texelDirections(EnvLayout layout, int size, unsigned threads = 0);

}  // namespace nacre
