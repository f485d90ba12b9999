// Directional albedo by quadrature that holds for lobes of any width.
#pragma once

#include <cstdint>

#include "factorize/reflectance.hpp"

namespace nacre {

inline constexpr std::uint64_t kAlbedoSamples = 4096;

/// a(wo) = ∫ f(wi, wo) cosθi dωi over the upper hemisphere. Half of the points are cosine-distributed, half are drawn
/// by their half vector as in reference/pair_sampling.hpp, combined by the balance heuristic. \param wo  unit, wo.z >
/// 0;  \param samples  ≥ 4, a multiple of 4 is used.  \throws std::invalid_argument when those are broken
Rgb directionalAlbedo(const BrdfFunction& f, const Vec3& wo, std::uint64_t samples = kAlbedoSamples);

/// Largest |∫(f̂−f) cosθi dωi| over channels, 16 θo = (j+½)·90°/16, and `azimuths` φo = k·45° + 22.5°.
/// Infinite when f̂ isn't finite at a point.
double albedoMaxAbs(const BrdfFunction& approximate, const BrdfFunction& truth, int azimuths, unsigned threads = 0);

}  // namespace nacre
