#include "reference/camera_rays.hpp"

#include <cmath>

namespace nacre {

CameraRays::CameraRays(const Camera& camera, int width, int height, int supersample)
    : toWorld_(glm::inverse(camera.view())),
      width_(width),
      height_(height),
      supersample_(supersample),
      orthographic_(camera.orthographic),
      near_(camera.near),
      far_(camera.far) {
    const double y = camera.orthographic ? camera.height / 2 : std::tan(camera.fovY / 2);
    halfExtent_ = {y * width / height, y};
}

Ray CameraRays::at(int x, int y, int k) const {
    const int n = supersample_;
    const Vec2 centre(x + (k % n + 0.5) / n, y + (k / n + 0.5) / n);
    const Vec2 ndc(2 * centre.x / width_ - 1, 1 - 2 * centre.y / height_);
    const Vec3 plane(ndc * halfExtent_, orthographic_ ? 0 : -1);
    const Vec3 o = orthographic_ ? plane : Vec3(0), d = orthographic_ ? Vec3(0, 0, -1) : plane;
    return {Vec3(toWorld_ * Vec4(o, 1)), Vec3(toWorld_ * Vec4(d, 0)), near_, far_};
}

}  // namespace nacre
