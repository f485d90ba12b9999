#include "shading/multipass/projective_map.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "core/error.hpp"

namespace nacre {
namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

void checkQuad(const Quad& q) {
    double size = 0;
    for (int i = 0; i < 4; ++i) size = std::max(size, glm::length(q[(i + 2) % 4] - q[i]));
    for (int i = 0; i < 4; ++i) {
        const double area = cross(q[(i + 1) % 4] - q[i], q[(i + 2) % 4] - q[i]);
        require(std::isfinite(area) && std::abs(area) > 1e-12 * size * size,
                "quadrilateral map: expected no three corners on one line");
    }
}

}  // namespace

glm::dmat3 squareToQuad(const Quad& q) {
    checkQuad(q);
    const Vec2 sum = q[0] - q[1] + q[2] - q[3], d1 = q[1] - q[2], d2 = q[3] - q[2];
    const double g = cross(sum, d2) / cross(d1, d2), h = cross(d1, sum) / cross(d1, d2);
    return {Vec3(q[1] - q[0] + g * q[1], g), Vec3(q[3] - q[0] + h * q[3], h), Vec3(q[0], 1)};
}

glm::dmat3 quadToQuad(const Quad& from, const Quad& to) {
    return squareToQuad(to) * glm::inverse(squareToQuad(from));  // the adjoint over the determinant
}

glm::dmat4 flatteningMap(const glm::dmat3& m) {
    const auto column = [&m](int c) { return Vec4(m[c].x, m[c].y, 0, m[c].z); };
    return {column(0), column(1), Vec4(0), column(2)};
}

}  // namespace nacre
