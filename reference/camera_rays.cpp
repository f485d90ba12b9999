#include "reference/camera_rays.hpp"

#include <cmath>

namespace nacre {

static std::vector<Vec2> grid(int n) {
    std::vector<Vec2> out;
    for (int k = 0; k < n * n; ++k) out.emplace_back((k % n + 0.5) / n, (k / n + 0.5) / n);
    return out;
}

CameraRays::CameraRays(const Camera& camera, int width, int height, int supersample)
    : CameraRays(camera, width, height, grid(supersample)) {}

CameraRays::CameraRays(const Camera& camera, int width, int height, std::vector<Vec2> points)
    : toWorld_(glm::inverse(camera.view())),
      width_(width),
      height_(height),
      points_(std::move(points)),
      orthographic_(camera.orthographic),
      near_(camera.near),
      far_(camera.far) {
    const double y = camera.orthographic ? camera.height / 2 : std::tan(camera.fovY / 2);
    halfExtent_ = {y * width / height, y};
}

Ray CameraRays::at(int x, int y, int k) const {
    const Vec2 centre = Vec2(x, y) + points_[static_cast<std::size_t>(k)];
    const Vec2 ndc(2 * centre.x / width_ - 1, 1 - 2 * centre.y / height_);
    const Vec3 plane(ndc * halfExtent_, orthographic_ ? 0 : -1);
    const Vec3 o = orthographic_ ? plane : Vec3(0), d = orthographic_ ? Vec3(0, 0, -1) : plane;
    return {Vec3(toWorld_ * Vec4(o, 1)), Vec3(toWorld_ * Vec4(d, 0)), near_, far_};
}

}  // namespace nacre
