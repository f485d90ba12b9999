// Small steps from float images to the page's pictures.
#pragma once

#include "core/image.hpp"
#include "demos/page.hpp"

namespace nacre {

/// Mean of 2 × 2 texels. \throws std::invalid_argument when a size is odd
Image halved(const Image& image);

/// image + (1 − coverage) · background, three channels. `image` is premultiplied: what covers nothing is black.
/// \throws std::invalid_argument when sizes differ
Image over(const Image& image, const Image& coverage, double background);

/// Channel `channel` alone.
Image channelOf(const Image& image, int channel);

/// The largest difference of sRGB values, over the channels, that only `share` of the pixels inside the mask exceed.
/// \param white  radiance shown as white. \throws std::invalid_argument when sizes differ
double differenceQuantile(const Image& image, const Image& truth, double white, const Image& mask, double share);

/// The smallest number 1, 2 or 5 times a power of ten that is ≥ value. \throws std::invalid_argument unless value > 0
/// and finite
double roundUpScale(double value);

/// PNG of linear radiance, `white` shown as white.
Picture encodePicture(std::string file, const Image& image, double white);

}  // namespace nacre
