#include "envmaps/texel_grid.hpp"

namespace nacre {

using footprint::clipSphere;
using footprint::SpherePolygon;

static constexpr int kFinest = 256;         ///< squares across, at least: over one the density is a parabola
static constexpr double kStraight = 1e-4;   ///< chord × sag at which an edge counts as straight [squares²]
static constexpr double kParabola = 1e-2;   ///< … and at which it counts as a parabola
static constexpr double kOnBorder = 1e-12;  ///< corners this far outside belong to the chart [rad]
static constexpr double kAtPole = 1e-11;    ///< no longitude closer to the axis than this [rad]

/// A seamed map of size 1 has no extent between its texel centres; these texels hold the same radiance.
static EnvMap withExtent(const EnvMap& map) {
    if (map.size() > 1 || map.layout == EnvLayout::LatLong || map.layout == EnvLayout::Cube) return map;
    EnvMap out(map.layout, 2);
    for (int y = 0; y < out.image.height(); ++y)
        for (int x = 0; x < out.image.width(); ++x) out.image.setRgb(x, y, map.image.rgb(0, y / 2));
    return out;
}

TexelGrid::TexelGrid(const EnvMap& map) : map_(withExtent(map)), size_(map_.size()) {
    refined_ = (kFinest + size_ - 1) / size_;
    fine_ = size_ * refined_;
    if (map_.layout == EnvLayout::Cube) {
        for (int face = 0; face < 6; ++face) {
            Vec3 major(0);
            major[face / 2] = face % 2 ? -1 : 1;
            Chart chart{{}, Vec3(1), face};
            for (int axis = 0; axis < 3; ++axis)
                for (const double side : {1.0, -1.0}) {
                    Vec3 normal = major;
                    normal[axis] = side;
                    if (axis != face / 2) chart.inside.push_back(normal);
                }
            charts_.push_back(chart);
        }
    } else if (map_.layout == EnvLayout::DualParaboloid) {
        charts_ = {{{{0, 0, 1}}, Vec3(1, 1, 1), 0}, {{{0, 0, -1}}, Vec3(1, 1, -1), 1}};
    } else {
        for (int octant = 0; octant < 8; ++octant) {
            const Vec3 sign(octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1);
            charts_.push_back({{{sign.x, 0, 0}, {0, sign.y, 0}, {0, 0, sign.z}}, sign, 0});
        }
    }
}

const TexelGrid::Chart& TexelGrid::chartOf(const Vec3& d) const {
    if (map_.layout == EnvLayout::DualParaboloid) return charts_[d.z < 0];
    if (map_.layout != EnvLayout::Cube) return charts_[(d.x < 0) + 2 * (d.y < 0) + 4 * (d.z < 0)];
    const Vec3 a = glm::abs(d);
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return charts_[2 * axis + (d[axis] < 0)];
}

/// Position within the chart's block in fine squares.
glm::dvec2 TexelGrid::place(const Chart& chart, const Vec3& direction) const {
    // A corner that lies on the border takes the chart's side of it.
    Vec3 d = direction;
    if (map_.layout == EnvLayout::LatLong || map_.layout == EnvLayout::Octahedral)
        d = chart.sign * glm::max(chart.sign * d, Vec3(0));
    switch (map_.layout) {
        case EnvLayout::LatLong: {
            const double quarter = std::atan2(std::abs(d.x), std::abs(d.z)),
                         longitude = chart.sign.x * (chart.sign.z > 0 ? quarter : kPi - quarter),
                         latitude = std::atan2(d.y, std::hypot(d.x, d.z));
            return glm::dvec2(1 - longitude / kPi, 0.5 - latitude / kPi) * static_cast<double>(fine_);
        }
        case EnvLayout::Cube: {
            // As envPosition's faces, but for this face even when the corner is on the border.
            const int axis = chart.block / 2;
            const double m = std::abs(d[axis]), positive = chart.block % 2 ? -1 : 1;
            const double right = axis == 0 ? positive * d.z : axis == 1 ? d.x : -positive * d.x;
            const double down = axis == 1 ? -positive * d.z : -d.y;
            return glm::dvec2(right / m + 1, down / m + 1) * (fine_ / 2.0);
        }
        case EnvLayout::DualParaboloid: {
            const glm::dvec2 disk = glm::dvec2(d.x, -d.y) / (glm::length(d) + std::abs(d.z));
            return ((disk + 1.0) * ((size_ - 1) / 2.0) + 0.5) * static_cast<double>(refined_);
        }
        case EnvLayout::Octahedral:
            break;
    }
    const Vec3 a = glm::abs(d) / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
    const glm::dvec2 folded = chart.sign.z > 0 ? glm::dvec2(a.x, a.y) : glm::dvec2(1 - a.y, 1 - a.x);
    const glm::dvec2 square(chart.sign.x * folded.x, -chart.sign.y * folded.y);
    return ((square + 1.0) * ((size_ - 1) / 2.0) + 0.5) * static_cast<double>(refined_);
}

/// Solid angle of a cell: density ρ at the centroid, and its curvature over the spread of a square of that area:
/// ∫ρ = A (ρ + A/24 ∇²ρ).
double TexelGrid::solidAngle(const Chart& chart, const glm::dvec2& centroid, double area) const {
    const auto integral = [&](double step, double density, double laplacian) {  // both per unit of the plane
        const double a = area * step * step;
        return a * density * (1 + a / 24 * laplacian);
    };
    switch (map_.layout) {
        case EnvLayout::LatLong:
            return integral(kPi / fine_, std::cos(kPi * (0.5 - centroid.y / fine_)), -1);
        case EnvLayout::Cube: {  // ρ = u^(−3/2), u = 1 + r²
            const glm::dvec2 ab = centroid * (2.0 / fine_) - 1.0;
            const double r2 = glm::dot(ab, ab), u = 1 + r2;
            return integral(2.0 / fine_, 1 / (u * std::sqrt(u)), (9 * r2 - 6) / (u * u));
        }
        case EnvLayout::DualParaboloid:
        case EnvLayout::Octahedral:
            break;
    }
    const double step = 2.0 / ((size_ - 1) * refined_);
    const glm::dvec2 st = (centroid / static_cast<double>(refined_) - 0.5) * (2.0 / (size_ - 1)) - 1.0;
    if (map_.layout == EnvLayout::DualParaboloid) {  // ρ = 4 u^(−2)
        const double r2 = glm::dot(st, st), u = 1 + r2;
        return integral(step, 4 / (u * u), (16 * r2 - 8) / (u * u));
    }
    // ρ = q^(−3/2), q = |p|², p on the octahedron's face
    const glm::dvec2 a = glm::abs(st), inner = chart.sign.z > 0 ? a : glm::dvec2(1 - a.y, 1 - a.x);
    const double height = 1 - inner.x - inner.y, q = glm::dot(inner, inner) + height * height;
    const glm::dvec2 slope = inner - height;
    return integral(step, 1 / (q * std::sqrt(q)), (15 * glm::dot(slope, slope) / q - 12) / q);
}

/// Appends P and points (not Q) of a polyline that encloses the area which the great circle from p to q does.
void TexelGrid::addEdge(const Chart& chart, const Vec3& p, const Vec3& q, const glm::dvec2& P, const glm::dvec2& Q,
                        int depth, std::vector<glm::dvec2>& out) const {
    static constexpr int kDeepest = 24;
    const Vec3 m = glm::normalize(p + q);
    const glm::dvec2 M = place(chart, m), chord = Q - P, bend = M - (P + Q) / 2.0;
    const double twiceArea = std::abs(chord.x * bend.y - chord.y * bend.x);
    if (twiceArea > kParabola && depth < kDeepest) {
        addEdge(chart, p, m, P, M, depth + 1, out);
        addEdge(chart, m, q, M, Q, depth + 1, out);
        return;
    }
    out.push_back(P);
    if (twiceArea > kStraight) out.push_back(M + bend / 3.0);  // a parabola holds 4/3 of its triangle
}

void TexelGrid::toPlane(const Chart& chart, const SpherePolygon& polygon, std::vector<glm::dvec2>& corners,
                        std::vector<glm::dvec2>& out) const {
    out.clear();
    const std::size_t count = polygon.size();
    for (const Vec3& p : polygon) out.push_back(place(chart, p));
    if (map_.layout == EnvLayout::Cube || map_.layout == EnvLayout::Octahedral) return;
    corners.swap(out);
    out.clear();
    const auto atPole = [&](const Vec3& p) {
        return map_.layout == EnvLayout::LatLong && p.x * p.x + p.z * p.z < kAtPole * kAtPole;
    };
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t next = i + 1 < count ? i + 1 : 0;
        const glm::dvec2 P = corners[i], Q = corners[next];
        const bool from = atPole(polygon[i]), to = atPole(polygon[next]);
        // The pole is a whole edge of the plane: it is reached, and left, along the meridian of the other corner.
        if (from && !to) out.emplace_back(Q.x, P.y);
        if (!from && to) out.insert(out.end(), {P, {P.x, Q.y}});
        if (!from && !to) addEdge(chart, polygon[i], polygon[next], P, Q, 0, out);
    }
}

/// Splits at coordinate `axis` = `at` into the part below and the part above.
static void split(const std::vector<glm::dvec2>& polygon, int axis, double at, std::vector<glm::dvec2>& below,
                  std::vector<glm::dvec2>& above) {
    below.clear();
    above.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2 &p = polygon[i], &q = polygon[i + 1 < polygon.size() ? i + 1 : 0];
        const double dp = p[axis] - at, dq = q[axis] - at;
        if (dp <= 0) below.push_back(p);
        if (dp >= 0) above.push_back(p);
        if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) {
            glm::dvec2 cut = (p * std::abs(dq) + q * std::abs(dp)) / (std::abs(dp) + std::abs(dq));
            cut[axis] = at;
            below.push_back(cut);
            above.push_back(cut);
        }
    }
}

static glm::dvec2 range(const std::vector<glm::dvec2>& polygon, int axis) {
    glm::dvec2 out(polygon[0][axis]);
    for (const glm::dvec2& p : polygon) out = {std::min(out.x, p[axis]), std::max(out.y, p[axis])};
    return out;
}

Overlap TexelGrid::inCell(const Chart& chart, int column, int row, const std::vector<glm::dvec2>& polygon) const {
    static constexpr double kNothing = 1e-14;  // rounding leaves slivers on borders
    if (polygon.size() < 3) return {};
    double area = 0;
    glm::dvec2 moment(0);
    for (std::size_t i = 2; i < polygon.size(); ++i) {
        const glm::dvec2 a = polygon[i - 1] - polygon[0], b = polygon[i] - polygon[0];
        const double twice = a.x * b.y - a.y * b.x;
        area += twice / 2;
        moment += (a + b) * (twice / 6);
    }
    if (std::abs(area) < kNothing) return {};
    const double omega = solidAngle(chart, polygon[0] + moment / area, std::abs(area));
    const int width = map_.image.width(), block = chart.block * size_;
    const int x = std::clamp(column / refined_, 0, width - 1), y = std::clamp(row / refined_, 0, size_ - 1) + block;
    return {map_.image.rgb(x, y) * omega, omega};
}

Overlap TexelGrid::inRow(const Chart& chart, int row, Scratch& scratch) const {
    if (scratch.row.size() < 3) return {};
    const glm::dvec2 extent = range(scratch.row, 0);
    const int first = static_cast<int>(std::floor(extent.x)), last = static_cast<int>(std::ceil(extent.y)) - 1;
    Overlap sum;
    for (int column = first; column < last; ++column) {
        split(scratch.row, 0, column + 1, scratch.cell, scratch.rowRest);
        sum += inCell(chart, column, row, scratch.cell);
        std::swap(scratch.row, scratch.rowRest);
    }
    if (last >= first) sum += inCell(chart, last, row, scratch.row);
    return sum;
}

Overlap TexelGrid::inChart(const Chart& chart, const SpherePolygon& polygon, Scratch& scratch) const {
    toPlane(chart, polygon, scratch.rest, scratch.plane);
    if (scratch.plane.size() < 3) return {};
    const glm::dvec2 extent = range(scratch.plane, 1);
    const int first = static_cast<int>(std::floor(extent.x)), last = static_cast<int>(std::ceil(extent.y)) - 1;
    Overlap sum;
    for (int row = first; row < last; ++row) {
        split(scratch.plane, 1, row + 1, scratch.row, scratch.rest);
        sum += inRow(chart, row, scratch);
        std::swap(scratch.plane, scratch.rest);
    }
    if (last < first) return sum;
    std::swap(scratch.row, scratch.plane);
    sum += inRow(chart, last, scratch);
    return sum;
}

Overlap TexelGrid::overlap(const SpherePolygon& polygon, Scratch& scratch) const {
    Vec3 middle(0);
    for (const Vec3& p : polygon) middle += p;
    const Chart& home = chartOf(middle);
    bool within = true;
    for (const Vec3& normal : home.inside)
        for (const Vec3& p : polygon) within = within && glm::dot(normal, p) >= -kOnBorder;
    if (within) return inChart(home, polygon, scratch);
    Overlap sum;
    for (const Chart& chart : charts_) {
        scratch.clipped = polygon;
        for (const Vec3& normal : chart.inside) {
            clipSphere(scratch.clipped, normal, scratch.other);
            std::swap(scratch.clipped, scratch.other);
        }
        if (scratch.clipped.size() >= 3) sum += inChart(chart, scratch.clipped, scratch);
    }
    return sum;
}

}  // namespace nacre
