#include "shading/primitives.hpp"

#include <functional>

#include "core/error.hpp"

namespace nacre {
namespace {

struct SurfacePoint {
    Vec3 position, normal, tangent;
};

/// A grid of (columns + 1) × (rows + 1) vertices over the unit square; `at(u, v)` gives the surface.
/// ∂P/∂u × ∂P/∂v points outwards. Triangles with two corners in one point (at a pole) are left out.
Mesh makeGrid(int columns, int rows, const std::function<SurfacePoint(double, double)>& at) {
    Mesh mesh;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) {
            const double u = static_cast<double>(i) / columns, v = static_cast<double>(j) / rows;
            const SurfacePoint point = at(u, v);
            mesh.positions.emplace_back(point.position);
            mesh.normals.emplace_back(point.normal);
            mesh.tangents.emplace_back(glm::vec3(point.tangent), 1.0f);
            mesh.uvs.emplace_back(u, v);
        }
    const auto index = [columns](int i, int j) { return static_cast<unsigned>(j * (columns + 1) + i); };
    const auto add = [&mesh](unsigned a, unsigned b, unsigned c) {
        const auto& p = mesh.positions;
        if (p[a] != p[b] && p[b] != p[c] && p[c] != p[a]) mesh.triangles.emplace_back(a, b, c);
    };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            add(index(i, j), index(i + 1, j), index(i + 1, j + 1));
            add(index(i, j), index(i + 1, j + 1), index(i, j + 1));
        }
    return mesh;
}

bool isLength(float length) { return std::isfinite(length) && length > 0; }

/// cos and sin of a whole turn's share, exact at quarters' ends so that poles and seams meet bit for bit.
Vec2 turn(double share) {
    if (share == 0 || share == 1) return {1, 0};
    if (share == 0.5) return {-1, 0};
    return {std::cos(2 * kPi * share), std::sin(2 * kPi * share)};
}

}  // namespace

Mesh makeTorus(float ring, float tube, int rings, int sides, TangentDirection tangents) {
    require(isLength(ring) && isLength(tube) && rings >= 3 && sides >= 3,
            "makeTorus: radii must be > 0, rings and sides >= 3");
    return makeGrid(rings, sides, [=](double u, double v) {
        const Vec2 sweep = turn(u), around = turn(v);
        const Vec3 out(sweep.x, 0, -sweep.y), along(-sweep.y, 0, -sweep.x), up(0, 1, 0);
        const Vec3 normal = around.x * out + around.y * up;
        const Vec3 side = -around.y * out + around.x * up;
        return SurfacePoint{static_cast<double>(ring) * out + static_cast<double>(tube) * normal, normal,
                            tangents == TangentDirection::Circular ? along : side};
    });
}

Mesh makeSphere(float radius, int segments, int stacks, TangentDirection tangents) {
    require(isLength(radius) && segments >= 3 && stacks >= 2,
            "makeSphere: radius must be > 0, segments >= 3, stacks >= 2");
    return makeGrid(segments, stacks, [=](double u, double v) {
        // v runs from the south pole up; theta from the north pole. The half-way turn gives both poles sin = 0.
        const Vec2 circle = turn(u), polar = turn(0.5 * (1 - v));
        const double cosTheta = polar.x, sinTheta = polar.y;
        const Vec3 out(circle.x, 0, -circle.y), along(-circle.y, 0, -circle.x);
        const Vec3 normal = sinTheta * out + cosTheta * Vec3(0, 1, 0);
        const Vec3 down = cosTheta * out - sinTheta * Vec3(0, 1, 0);
        return SurfacePoint{static_cast<double>(radius) * normal, normal,
                            tangents == TangentDirection::Circular ? along : down};
    });
}

Mesh makeDisk(float radius, int segments, int rings, TangentDirection tangents) {
    require(isLength(radius) && segments >= 3 && rings >= 1, "makeDisk: radius must be > 0, segments >= 3, rings >= 1");
    return makeGrid(segments, rings, [=](double u, double v) {
        // u runs counter-clockwise, so v must run inwards for ∂P/∂u × ∂P/∂v = +z
        const Vec2 circle = turn(u);
        const Vec3 out(circle.x, circle.y, 0), along(-circle.y, circle.x, 0);
        return SurfacePoint{static_cast<double>(radius) * (1 - v) * out, Vec3(0, 0, 1),
                            tangents == TangentDirection::Circular ? along : out};
    });
}

Mesh makeQuad(float size, int steps) {
    require(isLength(size) && steps >= 1, "makeQuad: size must be > 0, steps >= 1");
    return makeGrid(steps, steps, [=](double u, double v) {
        return SurfacePoint{static_cast<double>(size) * Vec3(u - 0.5, v - 0.5, 0), Vec3(0, 0, 1), Vec3(1, 0, 0)};
    });
}

}  // namespace nacre
