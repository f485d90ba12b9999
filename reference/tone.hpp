// From linear light to what a screen shows, and decibels.
#pragma once

#include "core/math.hpp"

namespace nacre {

/// sRGB transfer (IEC 61966-2-1) of a linear value, clamped to [0, 1].
inline double srgbEncode(double linear) {
    const double v = clamp01(linear);
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

/// −10 log10(meanSquare) [dB] for values with peak 1; 200 for anything below 1e-20, identical pictures included.
inline double psnrOfMeanSquare(double meanSquare) { return -10 * std::log10(std::max(meanSquare, 1e-20)); }

}  // namespace nacre
