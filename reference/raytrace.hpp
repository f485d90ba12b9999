// The true picture of a lit mesh: one Embree ray a sample, the unfactored BRDF, the frame that the shaders use.
#pragma once

#include <vector>

#include "core/image.hpp"
#include "core/scene.hpp"
#include "factorize/reflectance.hpp"
#include "reference/surface_point.hpp"

namespace nacre {

struct RaytraceOptions {
    int width = 512, height = 512;  ///< [pixels] ≥ 1
    int supersample = 1;            ///< n × n rays a pixel on a regular grid, ≥ 1; 1 = the pixel's centre
    bool shadows = false;           ///< false: local illumination, as the rasteriser's
    Rgb background{0};              ///< radiance where no triangle is hit
    unsigned threads = 0;           ///< 0 = all cores, same bits for any
};

/// The rays of a picture: sample k of pixel (x, y) is element (y · width + x) · n² + k, row by row within the pixel.
struct TracedSurface {
    int width = 0, height = 0, supersample = 1;
    std::vector<SurfacePoint> points;  ///< normal (0, 0, 0) where no triangle was hit
    std::vector<Vec3> directions;      ///< unit, where the ray goes

    static bool hit(const SurfacePoint& p) { return p.normal != Vec3(0); }
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
///         non-finite positions, a light's cone that isn't as SpotCone says
RaytracedPicture raytrace(const Mesh& mesh, const Camera& camera, const std::vector<Light>& lights,
                          const BrdfFunction& brdf, const RaytraceOptions& options = {});

/// Where the rays of raytrace hit, for shading by another formula. Takes sizes and threads of the options.
TracedSurface traceSurface(const Mesh& mesh, const Camera& camera, const RaytraceOptions& options = {});

/// The picture of one radiance a sample, as raytrace averages them. \throws std::invalid_argument unless there is one
/// for each
RaytracedPicture assemblePicture(const TracedSurface& surface, const std::vector<Rgb>& radiance);

}  // namespace nacre
