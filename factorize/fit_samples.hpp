// The direction pairs a fit looks at. The measurement in reference/ draws others.
#pragma once

#include <vector>

#include "factorize/log_table_fit.hpp"
#include "factorize/reflectance.hpp"

namespace nacre {

struct FitSampleOptions {
    std::size_t count = 100000;  ///< pairs drawn; those below the horizon or beyond maxTheta are dropped
    glm::dvec2 width{0.3};       ///< slope widths of the lobe along x and y
    bool isotropic = true;       ///< half vectors in the xz plane only
    double maxTheta = 1.55;      ///< largest elevation of either direction [rad]
    unsigned threads = 0;
};

/// Low-discrepancy pairs in half/difference angles. Half of the half vectors are uniform in √θh (body and tails), half
/// uniform on the `scaled_slope` disk (so that every texel of a table over h is seen); weighted by the balance
/// heuristic. measure = cosθi cosθo dωi dωo with dωi dωo = 4 cosθd dωh dωd. \throws nacre::Error when no sample is
/// left, or f is not finite somewhere
std::vector<FitSample> fitSamples(const BrdfFunction& f, const FitSampleOptions& options);

/// Slope at which the lobe around the normal has fallen half-way to its foot, at θd = 0.35 rad: a first guess of its
/// width, in [1e-3, 1].
double lobeHalfWidth(const BrdfFunction& f);

/// f(mirrored wi, mirrored wo) = f for mirrors in x and in y, on a few pairs.
bool isQuadrantSymmetric(const BrdfFunction& f);

}  // namespace nacre
