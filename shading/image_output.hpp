// Pictures out: tone-mapped PNG for people, linear EXR for measurements.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/image.hpp"

namespace nacre {

struct ToneMap {
    double white = 1;  ///< linear value that becomes 255; larger ones are clamped
};

/// linear / white, clamped to [0, 1] and encoded as sRGB (IEC 61966-2-1), as 8-bit codes, rounded to nearest.
/// width × height × 3 bytes, row 0 on top; one-channel images become grey.
/// \throws std::invalid_argument when white is not finite and > 0, or a texel is not finite (names it)
std::vector<std::uint8_t> toneMap(const Image& image, const ToneMap& options = {});

/// A PNG file's bytes from 8-bit sRGB codes as toneMap returns them.
/// \throws std::invalid_argument when codes has not width × height × 3 bytes
std::vector<std::uint8_t> encodePng(const std::vector<std::uint8_t>& codes, int width, int height);

/// encodePng(toneMap(image)). \throws nacre::Error naming the path
void writePng(const Image& image, const std::filesystem::path& path, const ToneMap& options = {});

/// Linear 32-bit floats, channels R G B (A), or Y for one channel; written beside and renamed.
/// \throws nacre::Error naming the path
void writeExr(const Image& image, const std::filesystem::path& path);

}  // namespace nacre
