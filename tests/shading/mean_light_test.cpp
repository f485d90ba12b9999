#include "shading/mean_light.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "shading/primitives.hpp"

namespace nacre {
namespace {

TEST(MeanLight, DirectionalLightOverAPlaneIsItsLocalDirection) {
    const Vec3 light = glm::normalize(Vec3(1, 2, 3));
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1), 0.7, glm::normalize(Vec3(1, 1, 0)));
    const Vec3 world = glm::dmat3(turn) * light;
    const Vec3 found = meanLightDirection(makeQuad(2, 3), turn, {true, world, Rgb(1), {}});
    EXPECT_LT(glm::length(found - light), 1e-6);
    // mirrored along x: the relief's x turns over with it
    const glm::dmat4 mirror = glm::scale(glm::dmat4(1), Vec3(-1, 1, 1));
    const Vec3 seen = meanLightDirection(makeQuad(2, 3), mirror, {true, light, Rgb(1), {}});
    EXPECT_LT(glm::length(seen - Vec3(-light.x, light.y, light.z)), 1e-6);
}

TEST(MeanLight, PointAboveTheMiddleIsStraightUp) {
    const Vec3 found = meanLightDirection(makeQuad(2, 4), glm::dmat4(1), {false, {0, 0, 0.5}, Rgb(1), {}}, 20000);
    EXPECT_LT(glm::length(found - Vec3(0, 0, 1)), 5e-3);
}

TEST(MeanLight, SpotCountsWhereItShines) {  // on the corner (1, 1), from above it
    Light spot{false, {1, 1, 1}, Rgb(1), SpotCone{{0, 0, -1}, 0.05, 0.1}};
    EXPECT_GT(meanLightDirection(makeQuad(2, 8), glm::dmat4(1), spot).z, 0.99);
    spot.cone.reset();
    EXPECT_LT(meanLightDirection(makeQuad(2, 8), glm::dmat4(1), spot).z, 0.95);
}

TEST(MeanLight, WithoutLightOrMeshItIsTheNormal) {
    EXPECT_EQ(meanLightDirection(makeQuad(), glm::dmat4(1), {true, {0, 0, -1}, Rgb(1), {}}), Vec3(0, 0, 1));
    EXPECT_EQ(meanLightDirection(Mesh(), glm::dmat4(1), Light()), Vec3(0, 0, 1));
    EXPECT_THROW(meanLightDirection(makeQuad(), glm::dmat4(1), Light(), 0), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
