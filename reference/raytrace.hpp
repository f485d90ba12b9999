// The true picture of a lit mesh: one Embree ray a sample, the unfactored BRDF, the frame that the shaders use.
#pragma once

#include <vector>

#include "core/image.hpp"
#include "core/scene.hpp"
#include "factorize/reflectance.hpp"

namespace nacre {

struct RaytraceOptions {
    int width = 512, height = 512;  ///< [pixels] ≥ 1
    int supersample = 1;            ///< n × n rays a pixel on a regular grid, ≥ 1; 1 = the pixel's centre
    bool shadows = false;           ///< false: local illumination, as the rasteriser's
    Rgb background{0};              ///< radiance where no triangle is hit
    unsigned threads = 0;           ///< 0 = all cores, same bits for any
};

struct RaytracedPicture {
    Image radiance;  ///< linear RGB, row 0 on top
    Image coverage;  ///< one channel: share of the pixel's rays that hit the mesh
};

/// Σ over lights of f(wi, wo) · cosα · irradiance at the first triangle (either side) between the near and far plane.
/// Frame: n = the interpolated normal, normalised; t = the interpolated tangent made orthogonal to n; b = w · n × t.
/// A light contributes nothing when wi.z ≤ 0, and the point none when wo.z ≤ 0. wo points to the eye; with an
/// orthographic camera it is the same everywhere. Rays pass where OpenGL has its pixel centres (Camera::projection).
/// \throws std::invalid_argument: sizes < 1, attribute arrays of other lengths than positions, indices out of range,
///         non-finite positions
RaytracedPicture raytrace(const Mesh& mesh, const Camera& camera, const std::vector<Light>& lights,
                          const BrdfFunction& brdf, const RaytraceOptions& options = {});

}  // namespace nacre
