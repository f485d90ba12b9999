#include "shading/shading_frame.hpp"

#include <algorithm>

namespace nacre {

Mat3 shadingFrame(const Vec3& normal, const Vec4& tangent) {
    const Vec3 n = glm::normalize(normal);
    Vec3 t = Vec3(tangent) - n * glm::dot(n, Vec3(tangent));
    if (glm::dot(t, t) < 1e-12) t = glm::cross(n, std::abs(n.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0));
    t = glm::normalize(t);
    return {t, glm::cross(n, t) * (tangent.w < 0 ? -1.0 : 1.0), n};
}

Mat3 bumpedFrame(const Mat3& mesh, double handedness, const Vec3& normal, const Vec3& toEye) {
    static constexpr double kLeast = 0.05;
    const double facing = glm::dot(mesh[2], toEye);
    if (facing <= 0) return mesh;
    Vec3 n = mesh * normal;
    const double missing = std::min(facing, kLeast) - glm::dot(n, toEye);
    if (missing > 0) n += missing * toEye;
    return shadingFrame(n, Vec4(mesh[0], handedness));
}

}  // namespace nacre
