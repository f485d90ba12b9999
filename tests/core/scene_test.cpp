// Camera matrices: OpenGL clip space, y up, the image's edges where the angles say.
#include "core/scene.hpp"

#include <gtest/gtest.h>

#include "core/progress.hpp"
#include "core/version.hpp"

namespace nacre {
namespace {

glm::dvec3 project(const Camera& camera, double aspect, const glm::dvec3& world) {
    const glm::dvec4 clip = camera.projection(aspect) * camera.view() * glm::dvec4(world, 1);
    return glm::dvec3(clip) / clip.w;
}

TEST(Camera, PerspectiveEdges) {
    Camera camera;
    camera.eye = {0, 0, 3};
    const double top = 3 * std::tan(camera.fovY / 2);
    EXPECT_NEAR(project(camera, 2, {0, 0, 0}).x, 0, 1e-15);
    EXPECT_NEAR(project(camera, 2, {0, top, 0}).y, 1, 1e-12);
    EXPECT_NEAR(project(camera, 2, {2 * top, 0, 0}).x, 1, 1e-12);
    EXPECT_NEAR(project(camera, 1, {0, 0, 3 - camera.near}).z, -1, 1e-12);
    EXPECT_NEAR(project(camera, 1, {0, 0, 3 - camera.far}).z, 1, 1e-12);
}

TEST(Camera, OrthographicEdges) {
    Camera camera;
    camera.orthographic = true;
    camera.height = 4;
    EXPECT_NEAR(project(camera, 1.5, {0, 2, 0}).y, 1, 1e-12);
    EXPECT_NEAR(project(camera, 1.5, {3, 0, -7}).x, 1, 1e-12) << "no foreshortening";
}

TEST(Progress, SilentWithoutListener) {
    report({}, "baking", 0.5);
    double heard = 0;
    report([&](const std::string&, double share) { heard = share; }, "baking", 0.5);
    EXPECT_EQ(heard, 0.5);
}

TEST(Version, IsThreeNumbers) {
    const std::string version = nacreVersion();
    EXPECT_EQ(std::count(version.begin(), version.end(), '.'), 2) << version;
}

}  // namespace
}  // namespace nacre
