// What a surface in a surrounding sends to the eye, from whatever maps, tables or formulas are handed in: with
// brute-force sums and exact Fresnel it is the truth, with sampleEnv and table lookups the shader's twin.
#pragma once

#include <functional>

#include "reference/raytrace.hpp"

namespace nacre {

using RadianceByDirection = std::function<Rgb(const Vec3&)>;

/// W Lm + D, or W Lm + (1 − W) D with `blend` (HSE section 1.5); D = transmission + diffuse. Empty functions are 0, but
/// W, which is 1. Must be safe to call from several threads.
struct SurroundedSurface {
    RadianceByDirection reflection{};    ///< of the viewing direction mirrored about the normal
    RadianceByDirection transmission{};  ///< of the viewing direction refracted once
    RadianceByDirection diffuse{};       ///< of the normal
    std::function<Rgb(double cosView)> weight{};
    double ior = 1.5;  ///< of the transmission
    bool blend = false;
};

/// 2 (n·v) n − v.
Vec3 mirrored(const Vec3& toEye, const Vec3& normal);
/// Snell: the direction inside the medium of relative index `ior`, away from the eye; (0, 0, 0) where all is reflected.
Vec3 refracted(const Vec3& toEye, const Vec3& normal, double ior);

/// 0 where the surface is seen from behind. \param toEye, normal  unit
Rgb surroundedRadiance(const SurroundedSurface& surface, const Vec3& toEye, const Vec3& normal);

/// Of every sample; `sky` of the ray's direction where nothing was hit (empty: 0).
std::vector<Rgb> shadeSurrounded(const TracedSurface& traced, const SurroundedSurface& surface,
                                 const RadianceByDirection& sky = {}, unsigned threads = 0);

}  // namespace nacre
