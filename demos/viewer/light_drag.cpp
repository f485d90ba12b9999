#include "demos/viewer/light_drag.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include "core/error.hpp"
#include "core/shadow_view.hpp"
#include "demos/viewer/orbit.hpp"

namespace nacre {
namespace {

/// Of what is before the eye; lights behind it move as those at the target.
double depthOf(const Vec3& point, const Camera& camera) {
    const double depth = -(camera.view() * Vec4(point, 1)).z;
    return depth > camera.near ? depth : glm::length(camera.target - camera.eye);
}

/// In the world, of what stands there.
Vec3 acrossView(const Vec3& point, const Camera& camera, Vec2 pixels, int height) {
    const double size = pixelSize(camera, depthOf(point, camera), height);
    return glm::transpose(Mat3(camera.view())) * Vec3(pixels.x * size, -pixels.y * size, 0);
}

/// What points at the viewer goes where the mouse goes.
Vec3 turned(const Vec3& v, const Camera& camera, Vec2 pixels, int height) {
    require(height >= 1, "light drag: height must be >= 1");
    const Mat3 toView(camera.view());
    const double angle = kPi / height;
    const glm::dmat4 turn =
        glm::rotate(glm::rotate(glm::dmat4(1), angle * pixels.y, Vec3(1, 0, 0)), angle * pixels.x, Vec3(0, 1, 0));
    return glm::normalize(glm::transpose(toView) * (Mat3(turn) * (toView * v)));
}

}  // namespace

Light dragged(const Light& light, const Camera& camera, Vec2 pixels, int height) {
    Light out = light;
    if (light.directional) {
        out.position = turned(light.position, camera, pixels, height);
        return out;
    }
    out.position += acrossView(light.position, camera, pixels, height);
    return out;
}

Vec3 draggedNode(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes, std::size_t node,
                 const Camera& camera, Vec2 pixels, int height) {
    const SceneNode& moved = scene.nodes.at(node);
    Vec3 middle(0);
    if (moved.mesh >= 0) {
        const Bounds box = boundsOf(scene.meshes[static_cast<std::size_t>(moved.mesh)].mesh);
        if (!box.empty()) middle = 0.5 * (box.low + box.high);
    }
    const Vec3 by = acrossView(Vec3(nodes.at(node) * Vec4(middle, 1)), camera, pixels, height);
    const Mat3 parent = moved.parent < 0 ? Mat3(1) : Mat3(nodes.at(static_cast<std::size_t>(moved.parent)));
    return moved.translation + glm::inverse(parent) * by;
}

Light pulled(const Light& light, const Camera& camera, double steps) {
    Light out = light;
    if (!light.directional) out.position = camera.eye + std::pow(0.9, steps) * (light.position - camera.eye);
    return out;
}

Light aimed(const Light& light, const Camera& camera, Vec2 pixels, int height) {
    Light out = light;
    if (out.cone) out.cone->axis = turned(out.cone->axis, camera, pixels, height);
    return out;
}

SceneLight placedInWorld(const SceneLight& light, const Light& world, const std::vector<glm::dmat4>& nodes) {
    SceneLight out = light;
    out.light = world;
    if (light.node < 0) return out;
    const glm::dmat4 toNode = glm::inverse(nodes.at(static_cast<std::size_t>(light.node)));
    const Mat3 linear(toNode);
    out.light.position =
        world.directional ? glm::normalize(linear * world.position) : Vec3(toNode * Vec4(world.position, 1));
    if (world.cone) out.light.cone->axis = glm::normalize(linear * world.cone->axis);
    return out;
}

}  // namespace nacre
