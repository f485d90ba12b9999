// False colours for differences: from black at 0 over violet, red and yellow to white at the end of the scale,
// lightness rising all the way so that it reads without colour vision and in grey print.
#pragma once

#include <string>

#include "core/math.hpp"

namespace nacre {

/// sRGB-encoded colour, components in [0, 1]. \param share  of the scale; values outside [0, 1] count as 0 or 1
Vec3 falseColorSrgb(double share);

/// The same colours as a CSS gradient from left to right.
std::string falseColorGradient();

/// The smallest number 1, 2 or 5 times a power of ten that is ≥ value. \throws std::invalid_argument unless value > 0
/// and finite
double roundUpScale(double value);

}  // namespace nacre
