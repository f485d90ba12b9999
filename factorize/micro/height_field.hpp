// Small periodic height fields: the relief whose reflectance micro/gonioreflectometer.hpp simulates.
#pragma once

#include <functional>
#include <vector>

#include "core/math.hpp"

namespace nacre {

/// columns × rows square cells of edge 1/columns, repeated without end in x and y. Heights are given at the cells'
/// lower corners, in the same unit; a cell is two triangles that meet on its diagonal from (0,0) to (1,1), and has one
/// albedo. Cell (x, y) is element y · columns + x; triangle 2·cell lies on the x side of the diagonal, 2·cell + 1 on
/// the y side.
struct HeightField {
    int columns = 0, rows = 0;
    std::vector<double> heights;
    std::vector<Rgb> albedo;  ///< in [0, 1]
};

/// One triangle, seen as a small mirrorless Lambertian facet.
struct Facet {
    Vec3 centre, normal;
    double area;
    Rgb albedo;
};

/// Two a cell, in triangle order.
/// \throws std::invalid_argument for arrays that don't fit the size, non-finite heights, albedo outside [0, 1]
std::vector<Facet> facetsOf(const HeightField& field);

/// How the simulation asks what a ray from a surface point meets. Safe to call from several threads.
struct SurfaceTracer {
    std::function<bool(const Vec3& from, const Vec3& direction)> escapes;
    /// The triangle hit first, -1 when the ray escapes.
    std::function<std::ptrdiff_t(const Vec3& from, const Vec3& direction)> firstHit;
};

/// Exact for the triangles: the clearance above a triangle is linear along the ray, so it is looked at where the ray
/// crosses cell edges and diagonals. Rays that stay inside the relief for 64 periods count as escaped.
/// \param field  must outlive the tracer
SurfaceTracer makeTracer(const HeightField& field);

/// All heights 0.
HeightField flatField(const Rgb& albedo);

/// Ridges along y, one a period: a face that rises over `peak` of the period with slope `slope`, seen from -x, and one
/// that falls over the rest, seen from +x.
struct RidgeShape {
    double slope = 1, peak = 0.5;
    Rgb left{0.5}, right{0.5};
};
HeightField ridges(const RidgeShape& shape, int columns);

/// One bump a period: height · exp(-r²/(2 width²)), lowered so that it meets its neighbours; faces seen from -x have
/// the left colour, the others the right one.
struct BumpShape {
    double height = 0.3, width = 0.2;
    Rgb left{0.5}, right{0.5};
};
HeightField gaussianBumps(const BumpShape& shape, int columns);

}  // namespace nacre
