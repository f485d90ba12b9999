#include "shading/texture_matrix.hpp"

#include <gtest/gtest.h>

#include "core/directions.hpp"
#include "core/sampling.hpp"

namespace nacre {
namespace {

Vec3 direction(std::uint64_t i) {
    const Vec3 p = halton3(i);
    return sphericalDirection(kPi * p.x, 2 * kPi * p.y);
}

// The products are the cosines of HSE figure 1, whatever the normal.
TEST(TextureMatrix, GivesTheCosines) {
    for (std::uint64_t i = 1; i < 200; ++i) {
        const Vec3 l = direction(i), v = direction(i + 1000), n = direction(i + 2000), h = halfVector(l, v);
        const Vec4 half = textureMatrixHalf(l, v) * Vec4(n, 1), pair = textureMatrixLightView(l, v) * Vec4(n, 1);
        EXPECT_NEAR(half.x, std::cos(angleBetween(h, l)), 1e-12);
        EXPECT_NEAR(half.y, std::cos(angleBetween(h, n)), 1e-12);
        EXPECT_NEAR(pair.x, std::cos(angleBetween(l, n)), 1e-12);
        EXPECT_NEAR(pair.y, std::cos(angleBetween(v, n)), 1e-12);
        EXPECT_EQ(Vec2(half.z, half.w), Vec2(0, 1));
        EXPECT_EQ(Vec2(pair.z, pair.w), Vec2(0, 1));
    }
}

TEST(TextureMatrix, RejectsWhatHasNoMeaning) {
    EXPECT_THROW(textureMatrixHalf({0, 0, 2}, {0, 0, 1}), std::invalid_argument);
    EXPECT_THROW(textureMatrixLightView({0, 0, 1}, {0, 0, 0}), std::invalid_argument);
    EXPECT_THROW(textureMatrixHalf({0, 0, 1}, {0, 0, -1}), std::invalid_argument);
    EXPECT_NO_THROW(textureMatrixLightView({0, 0, 1}, {0, 0, -1}));
}

}  // namespace
}  // namespace nacre
