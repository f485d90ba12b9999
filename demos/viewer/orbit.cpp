#include "demos/viewer/orbit.hpp"

#include <fmt/format.h>

#include <glm/gtc/matrix_transform.hpp>

#include "core/error.hpp"

namespace nacre {
namespace {

constexpr double kPole = 0.5 * kPi / 180;  ///< "up" along the line of sight would leave the picture's turn undefined
constexpr double kStep = 0.9;

Vec3 turned(const Vec3& v, double angle, const Vec3& axis) { return Mat3(glm::rotate(glm::dmat4(1), angle, axis)) * v; }

std::string text(const Vec3& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

}  // namespace

Camera orbited(const Camera& camera, Vec2 pixels, int height) {
    require(height >= 1, "orbited: height must be >= 1");
    const Vec3 up = glm::normalize(camera.up), back = camera.eye - camera.target;
    const double angle = kPi / height, distance = glm::length(back);
    const Vec3 around = turned(back, -angle * pixels.x, up);
    const double from = std::acos(std::clamp(glm::dot(around, up) / distance, -1.0, 1.0));
    const double to = std::clamp(from - angle * pixels.y, kPole, kPi - kPole);
    const Vec3 side = glm::cross(up, around);  // zero only for a camera that looks along its own up
    Camera out = camera;
    out.eye = camera.target + (glm::length(side) > 0 ? turned(around, to - from, glm::normalize(side)) : around);
    return out;
}

double pixelSize(const Camera& camera, double depth, int height) {
    return (camera.orthographic ? camera.height : 2 * depth * std::tan(camera.fovY / 2)) / height;
}

Camera panned(const Camera& camera, Vec2 pixels, int height) {
    require(height >= 1, "panned: height must be >= 1");
    const Mat3 toWorld = glm::transpose(Mat3(camera.view()));
    const double size = pixelSize(camera, glm::length(camera.eye - camera.target), height);
    const Vec3 move = toWorld * Vec3(-pixels.x * size, pixels.y * size, 0);
    Camera out = camera;
    out.eye += move;
    out.target += move;
    return out;
}

Camera zoomed(const Camera& camera, double steps) {
    const double factor = std::pow(kStep, steps);
    Camera out = camera;
    if (camera.orthographic)
        out.height *= factor;
    else
        out.eye = camera.target + factor * (camera.eye - camera.target);
    return out;
}

Vec3 inPicture(const Camera& camera, const Vec3& point, Vec2 size) {
    const Vec4 inView = camera.view() * Vec4(point, 1), clip = camera.projection(size.x / size.y) * inView;
    return {0.5 * (1 + clip.x / clip.w) * size.x, 0.5 * (1 - clip.y / clip.w) * size.y, -inView.z};
}

std::string cameraText(const Camera& camera) {
    const std::string extent = camera.orthographic ? fmt::format("\"orthographicHeight\": {}", camera.height)
                                                   : fmt::format("\"fovYDeg\": {}", camera.fovY * 180 / kPi);
    return fmt::format("\"camera\": {{\"eye\": {}, \"target\": {}, \"up\": {}, {}, \"near\": {}, \"far\": {}}}",
                       text(camera.eye), text(camera.target), text(camera.up), extent, camera.near, camera.far);
}

}  // namespace nacre
