#include "transfer/front_facing.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace nacre {
namespace {

/// A cube's eight corners, bit by bit x, y, z; two triangles a side, counter-clockwise from outside.
WeldedMesh cube() {
    WeldedMesh mesh;
    for (std::uint32_t i = 0; i < 8; ++i) mesh.firstOf.push_back(i), mesh.weldOf.push_back(i);
    const auto side = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    };
    side(0, 4, 6, 2), side(1, 3, 7, 5), side(0, 1, 5, 4), side(2, 6, 7, 3), side(0, 2, 3, 1), side(4, 5, 7, 6);
    return mesh;
}

std::vector<glm::vec3> corners() {
    std::vector<glm::vec3> out;
    for (int i = 0; i < 8; ++i) out.emplace_back(i & 1, (i >> 1) & 1, (i >> 2) & 1);
    return out;
}

using Wanted = std::vector<std::uint8_t>;

TEST(FrontFacing, OneSideOfACubeTwoAndThree) {
    EXPECT_EQ(frontFacing(cube(), corners(), {9, 0.5, 0.5}), Wanted({0, 1, 0, 1, 0, 1, 0, 1}));
    EXPECT_EQ(frontFacing(cube(), corners(), {9, 9, 0.5}), Wanted({0, 1, 1, 1, 0, 1, 1, 1}));
    EXPECT_EQ(frontFacing(cube(), corners(), {9, 9, 9}), Wanted({0, 1, 1, 1, 1, 1, 1, 1}));
}

TEST(FrontFacing, NothingFromInside) { EXPECT_EQ(frontFacing(cube(), corners(), Vec3(0.5)), Wanted(8, 0)); }

TEST(FrontFacing, NoTriangleWithoutNumbersOrArea) {
    std::vector<glm::vec3> positions = corners();
    positions[7].x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(frontFacing(cube(), positions, {9, 0.5, 0.5}), Wanted(8, 0));  // both triangles have corner 7
    EXPECT_EQ(frontFacing(cube(), std::vector<glm::vec3>(8, glm::vec3(1)), {9, 9, 9}), Wanted(8, 0));
    EXPECT_THROW(frontFacing(cube(), std::vector<glm::vec3>(7), Vec3(9)), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
