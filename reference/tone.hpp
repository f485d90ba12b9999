// From linear light to what a screen shows, and decibels.
#pragma once

#include <vector>

#include "core/math.hpp"

namespace nacre {

/// sRGB transfer (IEC 61966-2-1) of a linear value, clamped to [0, 1].
inline double srgbEncode(double linear) {
    const double v = clamp01(linear);
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

/// −10 log10(meanSquare) [dB] for values with peak 1; 200 for anything below 1e-20, identical pictures included.
inline double psnrOfMeanSquare(double meanSquare) { return -10 * std::log10(std::max(meanSquare, 1e-20)); }

/// Radiance shown as white: max(1.5 × the 90th percentile of the luminances of lit pixels, 0.05); 0.05 when there are
/// none.
inline double whitePoint(std::vector<double> luminances) {
    if (luminances.empty()) return 0.05;
    const auto place = luminances.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(luminances.size()));
    std::nth_element(luminances.begin(), place, luminances.end());
    return std::max(1.5 * *place, 0.05);
}

}  // namespace nacre
