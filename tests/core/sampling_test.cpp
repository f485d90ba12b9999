// Low-discrepancy points and the maps from the square.
#include "core/sampling.hpp"

#include <gtest/gtest.h>

namespace nacre {
namespace {

TEST(RadicalInverse, KnownValues) {
    EXPECT_EQ(radicalInverse(0, 2), 0);
    EXPECT_EQ(radicalInverse(1, 2), 0.5);
    EXPECT_EQ(radicalInverse(6, 2), 0.375);           // 110 → .011
    EXPECT_DOUBLE_EQ(radicalInverse(5, 3), 7.0 / 9);  // 12 → .21
}

TEST(RadicalInverse, FirstPowerOfTheBaseFillsEachStratumOnce) {
    for (const unsigned base : {2u, 3u, 5u}) {
        const unsigned count = base * base * base;
        std::vector<int> hits(count);
        for (unsigned i = 0; i < count; ++i)  // + tiny: 1/3 + 1/9 + … rounds below the exact fraction
            ++hits[static_cast<unsigned>(radicalInverse(i, base) * count + 1e-9)];
        EXPECT_EQ(hits, std::vector<int>(count, 1)) << base;
    }
}

TEST(RadicalInverse, LargestIndexStaysBelowOne) { EXPECT_LT(radicalInverse(~std::uint64_t{0}, 3), 1.0); }

TEST(ConcentricDisk, StaysInTheDiskAndKeepsArea) {
    constexpr int kEdge = 256;
    int inside = 0;
    for (int i = 0; i < kEdge * kEdge; ++i) {
        const Vec2 d = concentricDisk({(i % kEdge + 0.5) / kEdge, (i / kEdge + 0.5) / kEdge});
        EXPECT_LE(glm::length(d), 1.0 + 1e-15);
        inside += glm::length(d) < 0.5;
    }
    EXPECT_NEAR(static_cast<double>(inside) / (kEdge * kEdge), 0.25, 2.0 / kEdge);  // edge cells of the inner disk
}

TEST(ConcentricDisk, CentreAndCorners) {
    EXPECT_EQ(concentricDisk({0.5, 0.5}), Vec2(0, 0));
    for (const Vec2 corner : {Vec2(0, 0), Vec2(0, 1), Vec2(1, 0), Vec2(1, 1)})
        EXPECT_NEAR(glm::length(concentricDisk(corner)), 1, 1e-15);
}

TEST(CosineHemisphere, MomentsOfTheCosineDensity) {  // E[cosθ] = 2/3, E[cos²θ] = 1/2, E[x] = E[y] = 0
    constexpr int kCount = 1 << 14;
    double c1 = 0, c2 = 0, x = 0, y = 0;
    for (std::uint64_t i = 0; i < kCount; ++i) {
        const Vec3 p = halton3(i), w = cosineHemisphere({p.x, p.y});
        EXPECT_NEAR(glm::length(w), 1, 1e-14);
        EXPECT_GE(w.z, 0);
        c1 += w.z, c2 += w.z * w.z, x += w.x, y += w.y;
    }
    constexpr double kHalton = 1e-3;  // 16384 points; measured below 3e-4
    EXPECT_NEAR(c1 / kCount, 2.0 / 3, kHalton);
    EXPECT_NEAR(c2 / kCount, 0.5, kHalton);
    EXPECT_NEAR(x / kCount, 0, kHalton);
    EXPECT_NEAR(y / kCount, 0, kHalton);
}

}  // namespace
}  // namespace nacre
