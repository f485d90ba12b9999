#include "core/scene.hpp"

#include <glm/gtc/matrix_transform.hpp>

namespace nacre {

glm::dmat4 Camera::view() const { return glm::lookAt(eye, target, up); }

glm::dmat4 Camera::projection(double aspect) const {
    if (!orthographic) return glm::perspective(fovY, aspect, near, far);
    const double y = height / 2, x = y * aspect;
    return glm::ortho(-x, x, -y, y, near, far);
}

}  // namespace nacre
