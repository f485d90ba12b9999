// Lights under the mouse: they follow it, keep their length, and come back through moving nodes.
#include "demos/viewer/light_drag.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "demos/viewer/orbit.hpp"

namespace nacre {
namespace {

constexpr double kRounding = 1e-12;

TEST(LightDrag, ADirectionTurnsWithTheMouse) {
    const Camera camera;  // looks along −z
    const Light light{true, {0, 0, 1}};
    const Light right = dragged(light, camera, {50, 0}, 100), down = dragged(light, camera, {0, 25}, 100);
    EXPECT_LT(glm::length(right.position - Vec3(1, 0, 0)), kRounding);  // half a turn for the picture's height
    EXPECT_LT(glm::length(down.position - Vec3(0, -1, 1) / std::sqrt(2.0)), kRounding);
}

TEST(LightDrag, APointStaysUnderTheMouse) {
    Camera camera;
    camera.eye = {2, 1, 3};
    const Vec2 size(200, 100), by(13, -21);
    const Light light{false, {0.3, 0.4, 0.5}};
    const Vec3 before = inPicture(camera, light.position, size);
    const Vec3 after = inPicture(camera, dragged(light, camera, by, 100).position, size);
    EXPECT_NEAR(after.x - before.x, by.x, 1e-9);
    EXPECT_NEAR(after.y - before.y, by.y, 1e-9);
    EXPECT_NEAR(after.z, before.z, kRounding);
}

TEST(LightDrag, AnObjectStaysUnderTheMouseInAMovedParentToo) {
    Camera camera;
    camera.eye = {2, 1, 3};
    SceneDescription scene;
    SceneMesh mesh;
    mesh.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5f}};
    mesh.mesh.triangles = {{0, 1, 2}};
    scene.meshes.push_back(mesh);
    SceneNode parent, child;
    parent.scale = {2, 3, 1};
    parent.rotation = glm::angleAxis(0.7, glm::normalize(Vec3(1, 2, 0)));
    child.parent = 0;
    child.mesh = 0;
    scene.nodes = {parent, child};
    const Vec2 size(200, 100), by(13, -21);
    const auto middle = [&] {
        return inPicture(camera, Vec3(nodeTransforms(scene, 0)[1] * Vec4(0.5, 0.5, 0.25, 1)), size);
    };
    const Vec3 before = middle();
    scene.nodes[1].translation = draggedNode(scene, nodeTransforms(scene, 0), 1, camera, by, 100);
    const Vec3 after = middle();
    EXPECT_NEAR(after.x - before.x, by.x, 1e-9);
    EXPECT_NEAR(after.y - before.y, by.y, 1e-9);
    EXPECT_NEAR(after.z, before.z, kRounding);
}

TEST(LightDrag, ALightBehindTheEyeMovesToo) {
    const Camera camera;
    const Light light{false, {0, 0, 10}};
    const Light moved = dragged(light, camera, {10, 0}, 100);
    EXPECT_GT(moved.position.x, 0);
    EXPECT_EQ(moved.position.z, 10);
}

TEST(LightDrag, PullsTowardsTheEye) {
    const Camera camera;
    const Light light{false, {1, 0, 0}};
    const double before = glm::length(light.position - camera.eye);
    EXPECT_NEAR(glm::length(pulled(light, camera, 1).position - camera.eye), 0.9 * before, kRounding);
    const Light sun{true, {0, 0, 1}};
    EXPECT_EQ(pulled(sun, camera, 1).position, sun.position);
}

TEST(LightDrag, AimsASpotAlone) {
    const Camera camera;
    const Light spot{false, {0, 1, 0}, Rgb(1), SpotCone{{0, 0, -1}, 0.2, 0.4}}, lamp{false, {0, 1, 0}};
    const Light turned = aimed(spot, camera, {20, 10}, 100);
    EXPECT_EQ(turned.position, spot.position);
    EXPECT_NEAR(glm::length(turned.cone->axis), 1, kRounding);
    EXPECT_LT(glm::dot(turned.cone->axis, spot.cone->axis), 0.9);
    EXPECT_FALSE(aimed(lamp, camera, {20, 10}, 100).cone);
}

TEST(LightDrag, PlacedInTheWorldUnderATurnedAndScaledNode) {
    SceneDescription scene;
    SceneNode node;
    node.translation = {1, 2, 3};
    node.scale = Vec3(2);
    node.rotation = glm::angleAxis(0.7, glm::normalize(Vec3(1, 2, -1)));
    scene.nodes.push_back(node);
    const Light spot{false, {3, -1, 2}, Rgb(5), SpotCone{glm::normalize(Vec3(1, 1, 0)), 0.1, 0.2}};
    const Light sun{true, glm::normalize(Vec3(1, -2, 0.5))};
    const auto nodes = nodeTransforms(scene, 0);
    for (const Light& world : {spot, sun}) {
        SceneLight light;
        light.node = 0;
        scene.lights = {placedInWorld(light, world, nodes)};
        const Light back = lightsInWorld(scene, nodes)[0];
        EXPECT_LT(glm::length(back.position - world.position), 1e-9);
        EXPECT_EQ(back.color, world.color);
        if (world.cone) {
            EXPECT_LT(glm::length(back.cone->axis - world.cone->axis), 1e-9);
        }
    }
}

}  // namespace
}  // namespace nacre
