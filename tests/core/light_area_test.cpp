#include "core/light_area.hpp"

#include <gtest/gtest.h>

namespace nacre {
namespace {

TEST(LightArea, PointsShareTheLightEvenlyAboutItsMiddle) {
    const Light light{false, {1, 2, 3}, Rgb(6), {}};
    const LightArea area{{0.5, 0, 0}, {0, 0, 0.25}};
    for (const int count : {1, 2, 7, 16, 63}) {
        Vec3 middle(0);
        Rgb sum(0);
        for (const Light& p : pointsOfArea(light, area, count)) {
            EXPECT_LE(std::abs(p.position.x - 1), 0.5);
            EXPECT_LE(std::abs(p.position.z - 3), 0.25);
            middle += p.position / double(count);
            sum += p.color;
        }
        EXPECT_LT(glm::length(middle - light.position), 1e-12) << count;
        EXPECT_LT(glm::length(sum - light.color), 1e-12) << count;
    }
    EXPECT_EQ(pointsOfArea(light, area, 1)[0].position, light.position);
}

TEST(LightArea, MovesWithItsNode) {
    SceneDescription scene;
    scene.nodes.resize(1);
    scene.nodes[0].scale = {2, 2, 2};
    SceneLight lamp;
    lamp.node = 0;
    lamp.light.directional = false;
    lamp.area = LightArea{{1, 0, 0}, {0, 1, 0}};
    scene.lights = {lamp, {}};
    const auto areas = areasInWorld(scene, nodeTransforms(scene, 0));
    EXPECT_EQ(areas[0]->u, Vec3(2, 0, 0));
    EXPECT_FALSE(areas[1]);
}

TEST(LightArea, RejectsWhatHasNone) {
    EXPECT_THROW(pointsOfArea({true, {0, 1, 0}}, {}, 4), std::invalid_argument);
    EXPECT_THROW(pointsOfArea({false, {0, 1, 0}}, {}, 0), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
