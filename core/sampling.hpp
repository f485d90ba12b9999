// Deterministic low-discrepancy points.
#pragma once

#include <cstdint>

#include "core/math.hpp"

namespace nacre {

/// Van der Corput radical inverse of i in base b, in [0, 1). Base 2, 3, 5, 7… give the Halton sequence.
double radicalInverse(std::uint64_t i, unsigned base);

/// Halton point i in the first three prime bases, in [0,1)³.
inline Vec3 halton3(std::uint64_t i) { return {radicalInverse(i, 2), radicalInverse(i, 3), radicalInverse(i, 5)}; }

/// Shirley–Chiu concentric map of [0,1]² to the unit disk, area preserving up to the factor π.
Vec2 concentricDisk(const Vec2& square);

/// Cosine-weighted direction on the hemisphere z ≥ 0 from a point of [0,1]²; pdf = cosθ/π [1/sr].
Vec3 cosineHemisphere(const Vec2& square);

}  // namespace nacre
