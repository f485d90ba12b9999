// Curves as a picture, where a table would hide their shape.
#pragma once

#include <vector>

#include "core/image.hpp"

namespace nacre {

struct Curve {
    std::vector<double> x, y;  ///< as many of each, x ascending
    Rgb color{1};              ///< linear
    bool dashed = false;
};

/// Black, with the curves over a frame of grey lines at tenths of both ranges; y from 0 up to the largest. \param size
/// edge of the picture [pixels], > 20. \throws std::invalid_argument without a point
Image curvePicture(const std::vector<Curve>& curves, int size);

}  // namespace nacre
