#include "shading/texture_matrix.hpp"

#include "core/error.hpp"

namespace nacre {
namespace {

void requireUnit(const Vec3& toLight, const Vec3& toView) {
    const auto unit = [](const Vec3& v) { return std::abs(glm::length(v) - 1) < 1e-6; };
    require(unit(toLight) && unit(toView), "texture matrix: directions must have unit length");
}

/// The rows of a matrix, as the paper prints them; GLM wants columns.
glm::dmat4 fromRows(const Vec4& a, const Vec4& b) {
    return glm::transpose(glm::dmat4(a, b, Vec4(0), Vec4(0, 0, 0, 1)));
}

}  // namespace

glm::dmat4 textureMatrixHalf(const Vec3& toLight, const Vec3& toView) {
    requireUnit(toLight, toView);
    const Vec3 sum = toLight + toView;
    const double length = glm::length(sum);
    require(length > 1e-9, "textureMatrixHalf: opposite directions have no half vector");
    const Vec3 h = sum / length;
    return fromRows({0, 0, 0, 0.5 * length}, {h, 0});  // h·l = |l + v|/2
}

glm::dmat4 textureMatrixLightView(const Vec3& toLight, const Vec3& toView) {
    requireUnit(toLight, toView);
    return fromRows({toLight, 0}, {toView, 0});
}

}  // namespace nacre
