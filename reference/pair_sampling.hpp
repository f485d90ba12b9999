// The points at which BRDFs are compared: a low-discrepancy sequence that no fit uses, in half/difference angles, dense
// enough at the pole of h for lobes of any width.
#pragma once

#include <array>
#include <cstdint>

#include "core/directions.hpp"

namespace nacre {

/// Point n of the additive (Kronecker) sequence frac(start + n·α_k) in four dimensions, α_k = g^-k with g the real root
/// of x⁵ = x + 1. It shares no points with the Halton sequence of core/sampling.hpp, which the fits use.
/// \param seed  shifts the whole sequence; any value
std::array<double, 4> kroneckerPoint(std::uint64_t n, std::uint64_t seed);

/// The two ways to draw θh from u in [0, 1). Body: θh = (π/2)u². Peak: log-uniform between 1e-6 and π/2, which gives
/// each octave of angle, hence each lobe width, the same share of the points.
enum class ThetaHDraw { Body, Peak };
double drawThetaH(ThetaHDraw draw, double u);

/// Density of θh [1/rad] when each way draws half of the points (balance heuristic). thetaH in (0, π/2].
double thetaHDensity(double thetaH);

/// A pair and its share w of the measure dμ = cosθi cosθo dωi dωo: Σ w g / count → ∫ g dμ over both hemispheres.
/// w = 0 when a direction is at or below the horizon.
struct WeightedPair {
    DirectionPair pair;
    double weight = 0;  ///< [sr²]
};

/// dωi dωo = 4 cosθd dωh dωd: for fixed wi, dωo = 4 (wi·h) dωh; for fixed h, wi turns rigidly with d. θd has density
/// 2 sinθd cosθd, both azimuths are uniform, so that w = 8π² cosθi cosθo sinθh / density(θh), finite everywhere.
/// \param n  index of the point, < count;  the first half of the count draws θh as Body, the rest as Peak
WeightedPair drawPair(std::uint64_t n, std::uint64_t count, std::uint64_t seed);

}  // namespace nacre
