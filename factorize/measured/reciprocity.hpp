// How far measured data are from reciprocal: their own floor for any reciprocal fit.
#pragma once

#include "factorize/reflectance.hpp"

namespace nacre {

inline constexpr int kReciprocitySamples = 32768;

/// √(∫ |f(i,o) − f(o,i)|² dμ / ∫ |f(i,o)|² dμ), dμ = cosθi cosθo dωi dωo, θi, θo ≤ 80°, |·|² summed over channels:
/// E_L2 of `raw` against itself with the directions swapped. 0 for black data.
/// \param samples  low-discrepancy pairs (Halton in √θh, θd, φd, φh), ≥ 1; two evaluations each
double reciprocityResidual(const BrdfFunction& raw, int samples = kReciprocitySamples);

}  // namespace nacre
