// The overlap of spherical polygons with a map's texels. Part of convert.cpp.
#pragma once

#include "envmaps/footprint.hpp"

namespace nacre {

/// Σ L ω and Σ ω.
struct Overlap {
    Rgb radiance{0};
    double solidAngle = 0;
    Overlap& operator+=(const Overlap& other) {
        radiance += other.radiance;
        solidAngle += other.solidAngle;
        return *this;
    }
};

/// A map as piecewise-constant radiance. The sphere is cut into charts, bounded by great circles, in which the texels
/// are squares of a plane: cube faces, hemispheres of the paraboloids, octants of the others.
class TexelGrid {
public:
    explicit TexelGrid(const EnvMap& map);

    /// Room that is used again.
    struct Scratch {
        footprint::SpherePolygon clipped, other;
        std::vector<glm::dvec2> plane, rest, row, rowRest, cell;
    };
    /// ∫ over the polygon: its planar image is clipped to the texels; ω follows from area and centroid.
    Overlap overlap(const footprint::SpherePolygon& polygon, Scratch& scratch) const;

private:
    struct Chart {
        std::vector<Vec3> inside;  ///< normals: dot ≥ 0 is inside
        Vec3 sign{1};              ///< octant
        int block = 0;             ///< cube face or paraboloid: row of its first texel / size
    };
    const Chart& chartOf(const Vec3& direction) const;
    glm::dvec2 place(const Chart& chart, const Vec3& direction) const;
    void addEdge(const Chart& chart, const Vec3& p, const Vec3& q, const glm::dvec2& P, const glm::dvec2& Q, int depth,
                 std::vector<glm::dvec2>& out) const;
    void toPlane(const Chart& chart, const footprint::SpherePolygon& polygon, std::vector<glm::dvec2>& corners,
                 std::vector<glm::dvec2>& out) const;
    double solidAngle(const Chart& chart, const glm::dvec2& centroid, double area) const;
    Overlap inChart(const Chart& chart, const footprint::SpherePolygon& polygon, Scratch& scratch) const;
    Overlap inRow(const Chart& chart, int row, Scratch& scratch) const;
    Overlap inCell(const Chart& chart, int column, int row, const std::vector<glm::dvec2>& polygon) const;

    EnvMap map_;
    int size_, refined_, fine_;  ///< texels are cut into refined_² squares, so that the density hardly varies over one
    std::vector<Chart> charts_;
};

}  // namespace nacre
