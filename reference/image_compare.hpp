// How far a picture is from the true one, and a picture of the difference.
#pragma once

#include <cstdint>

#include "core/image.hpp"

namespace nacre {

/// max(1.5 × the 90th percentile of the luminance of lit pixels, 0.05): the radiance shown as white. Lit: luminance >
/// 0, and inside the mask. The definition of reference/sphere_psnr.hpp. \param mask  one channel of the same size, a
/// pixel counts where it is 1; an empty image takes all pixels \throws std::invalid_argument when sizes differ
double pictureWhite(const Image& truth, const Image& mask = {});

/// All over the pixels inside the mask, colour channels pooled; a and b are the picture and the truth, w white.
struct ImageDifference {
    double psnrLinear = 0;   ///< −10 log10 mean(((a−b)/w)²) [dB], not clamped
    double psnrSrgb = 0;     ///< the same of sRGB-encoded a/w and b/w, clamped to [0, 1]: what the eye sees
    double relative = 0;     ///< √(Σ(a−b)² / Σb²)
    double rmsOverMean = 0;  ///< √mean((a−b)²) / mean(b); 0 for black against black
    double maxAbs = 0;       ///< of a−b [radiance]
    double meanAbs = 0;
    std::uint64_t pixels = 0, nonFinite = 0;  ///< inside the mask; with a channel of a that is no finite number
};

/// Decibels are capped at 200. A non-finite pixel makes the errors infinite (PSNR −∞).
/// \param mask  as in pictureWhite: pass the coverage where edges shall not count
/// \throws std::invalid_argument when sizes differ, no pixel is inside, white isn't > 0, or the truth isn't finite
ImageDifference compareImages(const Image& image, const Image& truth, double white, const Image& mask = {});

/// Colour of x in [0, 1] (clamped): black, violet, red, orange, yellow, white, of rising luminance. Linear RGB, so that
/// the usual sRGB encoding shows it.
Rgb differenceColor(double x);

/// differenceColor(d / scale), d = largest channel of |sRGB(a/w) − sRGB(b/w)|; grey 0.2 outside the mask, and pure
/// green (a colour the map lacks) where a isn't finite. \param scale  the difference of sRGB values that is drawn
/// white, > 0, for instance 0.1
Image differenceImage(const Image& image, const Image& truth, double white, double scale, const Image& mask = {});

}  // namespace nacre
