#include "core/scene.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "core/error.hpp"

namespace nacre {

glm::dmat4 Camera::view() const { return glm::lookAt(eye, target, up); }

glm::dmat4 Camera::projection(double aspect) const {
    if (!orthographic) return glm::perspective(fovY, aspect, near, far);
    const double y = height / 2, x = y * aspect;
    return glm::ortho(-x, x, -y, y, near, far);
}

void checkCone(const Light& light) {
    if (!light.cone) return;
    const SpotCone& cone = *light.cone;
    require(!light.directional, "light: a cone belongs to a point light, found one at a directional light");
    require(std::abs(glm::length(cone.axis) - 1) < 1e-6, "light: the axis of a cone must have unit length");
    require(cone.inner >= 0 && cone.inner < cone.outer && cone.outer <= kPi / 2 + 1e-9,
            "light: expected a cone with 0 <= inner < outer <= pi/2");
}

double coneShare(const SpotCone& cone, const glm::dvec3& toLight) {
    const double outer = std::cos(cone.outer), inner = std::cos(cone.inner);
    const double share = std::clamp((-glm::dot(cone.axis, toLight) - outer) / (inner - outer), 0.0, 1.0);
    return share * share;
}

double lightFalloff(const Light& light, const glm::dvec3& point) {
    if (light.directional) return 1;
    const glm::dvec3 away = light.position - point;
    const double distance = glm::length(away);
    return (light.cone ? coneShare(*light.cone, away / distance) : 1) / (distance * distance);
}

}  // namespace nacre
