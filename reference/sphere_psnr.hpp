// The picture behind one number: a sphere under six lights, true and approximate.
#pragma once

#include "factorize/reflectance.hpp"

namespace nacre {

/// PSNR [dB] of a sphere seen orthographically along −z in 128² pixels (the sphere touches the picture's edges), lit by
/// one directional light of irradiance 1 at a time: azimuth 0°, 30°, … 150° from the view direction, 20° above it,
/// l = (sin az · cos el, sin el, cos az · cos el). The tangent circles the y axis: t ∥ y × n. A pixel is lit when its
/// centre lies on the sphere and n·l > 0; its radiance is f · n·l. White = max(1.5 × the 90th percentile of the true
/// luminance of the lit pixels of all six pictures, 0.05); values are divided by white, clamped to [0, 1] and encoded
/// as sRGB. PSNR = −10 log10(mean squared difference over all lit pixels, lights and channels pooled), at most 200. −∞
/// when f̂ isn't finite at a lit pixel.
double spherePsnr(const BrdfFunction& approximate, const BrdfFunction& truth, unsigned threads = 0);

}  // namespace nacre
