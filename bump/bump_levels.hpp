// What the shadows of a relief become from afar: levels of horizon ellipses and horizons, half the size each, with how
// far the lights' verdicts under a texel spread.
#pragma once

#include <vector>

#include "bump/horizon_ellipses.hpp"
#include "bump/horizon_map.hpp"

namespace nacre {

/// Share of a texel's area that is lit: value ≥ 0 without spread, else 1/2 + value/(2 spread) within [0, 1].
/// Twin: nacre_lit_share (shaders/nacre/bump.glsl).
double litShare(double value, double spread);

/// √(α₁² + α₂²). Twin: nacre_bump_alpha.
double bumpedAlpha(double material, double relief);

struct EllipseLevel {
    Image shape;   ///< m11, m12, m22, spread (0 at the finest)
    Image offset;  ///< o1, o2, share of the sky seen
};

/// Levels, finest first, level l of max(1, ⌊size / 2ˡ⌋) texels, the last of 1 × 1. A coarse level's ellipse is k times
/// the mean of M and of o over the texels that it stands for, by area; k and the spread are those of a grid with which
/// litShare(ellipseValue) is nearest, over directions drawn by the cosine, to the share of these texels that the finest
/// level calls lit. So a far wall under a low light is as grey as its texels are on average.
/// The mean alone would be all or nothing, and too bright: |M l + o| of a mean is at most the mean of |M l + o|.
/// Cost: 48 directions a texel, and about 100 trials for each coarse one. Same bits for any thread count.
std::vector<EllipseLevel> ellipseLevels(const EllipseMap& map, unsigned threads = 0);

struct HorizonLevel {
    std::vector<Image> elevation;  ///< K images of one channel [rad], means by area
    Image spread;  ///< √3 σ of the elevations under a texel [rad], σ² the mean over azimuths: the half width of an even
                   ///< spread
};
std::vector<HorizonLevel> horizonLevels(const HorizonMap& map, unsigned threads = 0);

}  // namespace nacre
