#include "bump/scatter_map.hpp"

#include <gtest/gtest.h>

#include "reference/bump_error.hpp"
#include "tests/bump/relief_fixtures.hpp"

namespace nacre {
namespace {

TEST(ScatterMap, MatchesTheReferenceOnRoughReliefsOfAnyWrapAndSize) {
    constexpr double kGrazing = 1e-3;  // of the rays: so close to an edge that single precision decides
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror})
        for (const auto& [width, height] : {std::pair(96, 96), {67, 33}, {1, 40}, {5, 3}})
            for (const float amplitude : {0.3f, 3.0f, 30.0f}) {
                const HeightMap map = roughMap(width, height, amplitude, wrap);
                const ScatterMap scatter = makeScatterMap(map, {.directions = 24});
                const SeenError error = measureSeen(drawSeenSamples(map, scatter.directions, 6000), scatter);
                EXPECT_LE(error.hitMismatch, kGrazing) << toString(wrap) << ' ' << width << ' ' << amplitude;
                EXPECT_LE(error.beyondOneTexel, kGrazing) << toString(wrap) << ' ' << width << ' ' << amplitude;
            }
}

TEST(ScatterMap, FlatReliefHasCosineDirectionsThatMiss) {
    const ScatterMap scatter = makeScatterMap(flatMap(8, 8), {.directions = 256});
    double sum = 0, cosine = 0;
    for (int i = 0; i < scatter.count(); ++i) {
        EXPECT_GT(scatter.directions[i].z, 0);
        sum += scatter.weights[i];
        cosine += scatter.weights[i] * scatter.directions[i].z;
        for (const float d : scatter.distance[i].data()) EXPECT_EQ(d, -1);
    }
    EXPECT_NEAR(cosine, kPi, 0.02) << "the integral of the cosine";
    EXPECT_GT(sum, kPi);
}

TEST(ScatterMap, WeightsIntegrateTheCosineAboutATiltedNormal) {
    HeightMap map = roughMap(64, 64, 8);
    const ScatterMap scatter = makeScatterMap(map, {.directions = 512});
    for (const Vec3& normal : {Vec3(0, 0, 1), glm::normalize(Vec3(1, 0, 1)), glm::normalize(Vec3(-1, 2, 2))}) {
        double sum = 0;
        for (int i = 0; i < scatter.count(); ++i)
            sum += scatter.weights[i] * std::max(0.0, glm::dot(normal, scatter.directions[i]));
        EXPECT_NEAR(sum, kPi, 0.05 * kPi) << normal.x;
    }
}

TEST(ScatterMap, RayHitsAWallWhereItStands) {
    HeightMap map = flatMap(64, 4);
    for (int y = 0; y < 4; ++y)
        for (int x = 20; x < 30; ++x) map.heights.at(x, y, 0) = 5;
    const Vec3 level = glm::normalize(Vec3(1, 0, 0.1));
    const std::vector<float> d = rayDistances(map, level);
    EXPECT_NEAR(d[10], 9 + 0.9 / 4.9, 1e-5) << "between columns 19 and 20, where the wall is as high as the ray";
    EXPECT_NEAR(d[62], 21 + 2.1 / 4.9, 1e-5) << "across the seam";
    EXPECT_EQ(rayDistances(map, glm::normalize(Vec3(1, 0, 1)))[10], -1);
    const Vec2 seen = seenPoint(10, 2, level, d[10]);
    EXPECT_NEAR(seen.x, 10.5 + d[10], 1e-9);
    EXPECT_NEAR(seen.y, 2.5, 1e-9);
}

TEST(ScatterMap, RaysBelowTheOwnPatchHitAtOnceAndVerticalOnesAreClear) {
    const HeightMap map = flatMap(8, 8);
    EXPECT_EQ(rayDistances(map, glm::normalize(Vec3(1, 1, -0.5)))[9], 0);
    EXPECT_EQ(rayDistances(map, Vec3(0, 0, 1))[9], -1);
    EXPECT_EQ(rayDistances(map, Vec3(0, 0, -1))[9], 0);
}

TEST(ScatterMap, RampExactlyParallelToTheRayIsMissed) {
    HeightMap map = flatMap(32, 4);
    map.wrap = Wrap::Clamp;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 32; ++x) map.heights.at(x, y, 0) = static_cast<float>(x) * 0.5f;
    const std::vector<float> d = rayDistances(map, glm::normalize(Vec3(1, 0, 0.5)));
    for (int x = 0; x < 31; ++x) EXPECT_EQ(d[x], -1) << x;
}

TEST(ScatterMap, SameBitsForAnyThreadCount) {
    const HeightMap map = roughMap(70, 50, 4);
    const Vec3 d = glm::normalize(Vec3(0.3, -0.8, 0.2));
    EXPECT_EQ(rayDistances(map, d, 1), rayDistances(map, d, 5));
}

TEST(ScatterMap, RejectsBadInput) {
    EXPECT_THROW(makeScatterMap(flatMap(2, 2), {.directions = 0}), std::invalid_argument);
    EXPECT_THROW(rayDistances(flatMap(2, 2), Vec3(1, 1, 0)), std::invalid_argument);
    EXPECT_THROW(rayDistances({}, Vec3(0, 0, 1)), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
