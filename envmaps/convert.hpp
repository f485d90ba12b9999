// From one layout and size to another by area: no texel is skipped, no sun counted twice.
#pragma once

#include "core/environment.hpp"

namespace nacre {

/// The map in another layout or size. Each texel of the result is the average of `map`'s piecewise-constant radiance
/// over the texel's footprint, by solid angle: Σ L ω / Σ ω over the map's texels, ω = solid angle of the overlap.
/// Overlaps are polygons clipped in the plane of the map's own texels (no sampling), exact but for curved edges, which
/// are short parabolas. So a constant map stays constant, bit by bit, and the energy Σ L dω stays within 2e-5 for any
/// pair of layouts, suns included (7e-6 on real maps). The same layout and size is a copy. O(texels of both).
///
/// Seams: the border texels of Octahedral and the DualParaboloid texels that the rim passes through share their value
/// with the texels they touch across the seam (the average over both parts), so that clamped bilinear lookups meet
/// there. A DualParaboloid's texels beyond the rim hold the other hemisphere, where their directions go.
/// \param size     of the result, ≥ 1
/// \param threads  0 = all cores, same bits for any
/// \throws std::invalid_argument when the map is empty or size < 1; non-finite texels are passed on, not hidden
EnvMap convertEnv(const EnvMap& map, EnvLayout layout, int size, unsigned threads = 0);

/// The surrounding turned by `yaw` about y, from +z towards +x [rad]: L'(d) = L(R⁻¹ d), averaged as above.
EnvMap rotateEnv(const EnvMap& map, double yaw, unsigned threads = 0);

/// L'(x, y, z) = L(−x, y, z): left and right exchanged. Texels move, none is averaged.
EnvMap mirrorEnvX(const EnvMap& map);
/// L'(x, y, z) = L(x, −y, z): upside down.
EnvMap mirrorEnvY(const EnvMap& map);

/// The size at which `layout` has texels about as wide as the map's: 256 faces for 1024 × 512, and so on.
int matchingSize(const EnvMap& map, EnvLayout layout);

/// Σ L dω [W/m²]: what conversion keeps.
Rgb envEnergy(const EnvMap& map, unsigned threads = 0);

}  // namespace nacre
