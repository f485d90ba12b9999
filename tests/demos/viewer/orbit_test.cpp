// The camera under the mouse: what it keeps, where it stops, and that its text reads back.
#include "demos/viewer/orbit.hpp"

#include <gtest/gtest.h>

#include "core/file.hpp"
#include "shading/scene_file.hpp"
#include "tests/core/scratch.hpp"

namespace nacre {
namespace {

constexpr double kRounding = 1e-12;

Camera someCamera() {
    Camera camera;
    camera.eye = {1, 2, 3};
    camera.target = {0.2, 0.1, -0.3};
    camera.up = glm::normalize(Vec3(0.1, 1, 0.2));
    return camera;
}

double distanceOf(const Camera& camera) { return glm::length(camera.eye - camera.target); }

TEST(Orbit, KeepsTargetAndDistanceAndComesBack) {
    const Camera camera = someCamera();
    const Camera there = orbited(camera, {37, -12}, 100);
    EXPECT_EQ(there.target, camera.target);
    EXPECT_NEAR(distanceOf(there), distanceOf(camera), kRounding);
    EXPECT_GT(glm::length(there.eye - camera.eye), 0.5);
    EXPECT_LT(glm::length(orbited(there, {-37, 12}, 100).eye - camera.eye), kRounding);
    EXPECT_LT(glm::length(orbited(camera, {200, 0}, 100).eye - camera.eye), 10 * kRounding);  // a whole turn
}

TEST(Orbit, TurnsTheSceneWithTheMouse) {
    const Camera camera;
    const Vec2 size(100, 100);
    const Vec3 front(0, 0, 0.5);  // before the target
    const Vec3 before = inPicture(camera, front, size), after = inPicture(orbited(camera, {5, 4}, 100), front, size);
    EXPECT_GT(after.x, before.x + 1);
    EXPECT_GT(after.y, before.y + 1);
}

TEST(Orbit, StopsAtThePoles) {
    for (const double way : {-1e4, 1e4}) {
        const Camera camera = orbited(someCamera(), {0, way}, 100);
        const double cosine = glm::dot(glm::normalize(camera.eye - camera.target), camera.up);
        EXPECT_NEAR(std::acos(std::abs(cosine)), 0.5 * kPi / 180, 1e-9);
        EXPECT_TRUE(isFinite(Vec3(camera.view()[0])));
    }
}

TEST(Pan, TheTargetFollowsTheMouse) {
    for (const bool orthographic : {false, true}) {
        Camera camera = someCamera();
        camera.orthographic = orthographic;
        const Vec2 size(300, 200), by(31, -17);
        const Vec3 before = inPicture(camera, camera.target, size);
        const Vec3 after = inPicture(panned(camera, by, 200), camera.target, size);
        EXPECT_NEAR(after.x - before.x, by.x, 1e-9);
        EXPECT_NEAR(after.y - before.y, by.y, 1e-9);
    }
}

TEST(Zoom, TenPercentAStep) {
    const Camera camera = someCamera();
    EXPECT_NEAR(distanceOf(zoomed(camera, 2)), 0.81 * distanceOf(camera), kRounding);
    EXPECT_NEAR(distanceOf(zoomed(zoomed(camera, 3), -3)), distanceOf(camera), kRounding);
    Camera flat = camera;
    flat.orthographic = true;
    EXPECT_EQ(zoomed(flat, 1).eye, flat.eye);
    EXPECT_NEAR(zoomed(flat, 1).height, 0.9 * flat.height, kRounding);
}

TEST(CameraText, ReadsBackToTheSameCamera) {
    const tests::Scratch scratch;
    for (const bool orthographic : {false, true}) {
        Camera camera = someCamera();
        camera.orthographic = orthographic;
        writeFile(scratch / "scene.json", "{\"nacre_scene\": 1, " + cameraText(camera) + "}");
        const Camera read = readScene(scratch / "scene.json").camera;
        EXPECT_EQ(read.eye, camera.eye);
        EXPECT_EQ(read.target, camera.target);
        EXPECT_LT(glm::length(read.up - camera.up), kRounding);
        EXPECT_EQ(read.orthographic, orthographic);
        EXPECT_EQ(read.height, orthographic ? camera.height : Camera{}.height);
        EXPECT_NEAR(read.fovY, camera.fovY, kRounding);
        EXPECT_EQ(read.near, camera.near);
        EXPECT_EQ(read.far, camera.far);
    }
}

}  // namespace
}  // namespace nacre
