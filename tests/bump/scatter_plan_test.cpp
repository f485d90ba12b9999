#include "bump/scatter_plan.hpp"

#include <gtest/gtest.h>

#include <set>

#include "reference/relief_light.hpp"
#include "reference/relief_rays.hpp"
#include "tests/bump/relief_fixtures.hpp"

namespace nacre {
namespace {

TEST(ScatterPlan, RefinedReliefIsTheSameSurface) {
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror}) {
        const HeightMap map = roughMap(9, 6, 3, wrap), fine = refinedRelief(map, 3);
        for (const Vec2& p : {Vec2(0.1, 0.2), {4.3, 3.9}, {8.9, 5.8}, {-2.3, 7.1}})
            EXPECT_NEAR(heightAt(fine, p * 3.0), 3 * heightAt(map, p), 1e-4) << toString(wrap) << p.x;
        for (int y = 0; y < 6; ++y)
            for (int x = 0; x < 9; ++x) EXPECT_EQ(fine.at(3 * x + 1, 3 * y + 1), 3 * map.at(x, y));
    }
}

TEST(ScatterPlan, NormalsAreTheReferences) {
    HeightMap map = roughMap(9, 7, 3, Wrap::Clamp);
    map.heights.at(4, 4, 0) = std::nanf("");
    for (int y = 0; y < 7; ++y)
        for (int x = 0; x < 9; ++x)
            if (x != 4 || y != 4) {
                EXPECT_LT(glm::length(reliefNormal(map, x, y) - texelNormal(map, x, y)), 1e-12);
            }
    EXPECT_EQ(reliefNormal(map, 4, 4), Vec3(0, 0, 1));
    EXPECT_EQ(ownSlopes(map, 3, 4).y, 0) << "beside the hole";
    EXPECT_EQ(ownSlopes(map, 2, 2).y, map.at(3, 2) - map.at(2, 2));
}

TEST(ScatterPlan, LitMaskIsTheReferences) {
    const HeightMap map = roughMap(32, 32, 6);
    int dark = 0;
    for (const Vec3& light : {glm::normalize(Vec3(1, 0.3, 0.4)), glm::normalize(Vec3(-0.2, 1, 0.9)), Vec3(0, 0, -1)}) {
        const Image mask = litMask(map, light);
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 32; ++x) {
                EXPECT_EQ(mask.at(x, y, 0) > 0, isLit(map, {x + 0.5, y + 0.5}, light)) << x << ' ' << y;
                dark += mask.at(x, y, 0) == 0;
            }
    }
    EXPECT_GT(dark, 1024);
    HeightMap cliff = flatMap(8, 2);  // nothing is before it, but a light below the plane is dark by definition
    cliff.wrap = Wrap::Clamp;
    for (int x = 0; x < 4; ++x) cliff.heights.at(x, 0, 0) = cliff.heights.at(x, 1, 0) = 100;
    EXPECT_EQ(litMask(cliff, glm::normalize(Vec3(1, 0, -0.001))).at(3, 0, 0), 0);
    EXPECT_EQ(litMask(cliff, glm::normalize(Vec3(1, 0, 0.001))).at(3, 0, 0), 1);
}

TEST(ScatterPlan, StepsGoToTheBouncesInHalvesAndNoneToTheSky) {
    const HeightMap map = roughMap(32, 32, 2);
    const ScatterMap scatter = makeScatterMap(map, {.directions = 512});
    const ScatterPlan plan = planScatter(map, scatter);
    ASSERT_EQ(plan.bounces.size(), 3u);
    double all = 0;  // weight of the directions that bring light
    for (int k = 0; k < scatter.count(); ++k) {
        bool brings = false;
        for (int i = 0; i < 1024; ++i)
            brings = brings || (scatter.distance[k].data()[i] >= 0 &&
                                lambertWeight(plan.normals.rgb(i % 32, i / 32), scatter.directions[k], 1) > 0);
        if (brings) all += scatter.weights[k];
        for (const ScatterBounce& bounce : plan.bounces)
            EXPECT_TRUE(brings || std::count(bounce.directions.begin(), bounce.directions.end(), k) == 0);
    }
    std::size_t steps = 0;
    for (const ScatterBounce& bounce : plan.bounces) {
        double sum = 0;
        for (const double w : bounce.weights) sum += w;
        EXPECT_NEAR(sum, all, 1e-9);
        EXPECT_EQ(std::set<int>(bounce.directions.begin(), bounce.directions.end()).size(), bounce.directions.size());
        steps += bounce.directions.size();
    }
    EXPECT_EQ(steps, 300u);
    EXPECT_EQ(plan.bounces[0].directions.size(), 171u);
}

TEST(ScatterPlan, HitsAreTheShareOfTheCosine) {  // the groove of slope 1: half of what its bottom sees is wall
    HeightMap map{Image(64, 1, 1), Wrap::Repeat};
    for (int x = 0; x < 64; ++x) map.heights.at(x, 0, 0) = static_cast<float>(std::abs(x - 32));
    const ScatterPlan plan = planScatter(map, makeScatterMap(map, {.directions = 1024}));
    EXPECT_NEAR(plan.hits.at(32, 0, 0), 1 - std::sqrt(0.5), 0.02) << "1 - sin 45 degrees of the strip above";
    EXPECT_NEAR(plan.hits.at(0, 0, 0), 0, 0.02) << "a crest that sees sky";
}

TEST(ScatterPlan, PathsUseDirectionsEvenly) {
    for (const int paths : {64, 192}) {
        const std::vector<int> indices = scatterPaths(64, paths, 4);
        ASSERT_EQ(indices.size(), static_cast<std::size_t>(paths) * 4);
        std::vector<int> first(64, 0), second(64, 0);
        std::set<std::pair<int, int>> quarters;  // of pairs of segments
        for (int p = 0; p < paths; ++p) {
            ++first[indices[4 * p]], ++second[indices[4 * p + 1]];
            quarters.insert({indices[4 * p] / 16, indices[4 * p + 1] / 16});
            for (int b = 0; b < 4; ++b) EXPECT_TRUE(indices[4 * p + b] >= 0 && indices[4 * p + b] < 64);
        }
        for (int k = 0; k < 64; ++k) {
            EXPECT_EQ(first[k], paths / 64);
            EXPECT_LE(second[k], paths / 64 + 3);
        }
        EXPECT_EQ(quarters.size(), 16u);
    }
    EXPECT_EQ(scatterPaths(3, 1, 1).size(), 1u);
}

TEST(ScatterPlan, SameBitsForAnyThreadCount) {
    const HeightMap map = roughMap(21, 17, 4);
    const ScatterMap scatter = makeScatterMap(map, {.directions = 40});
    const ScatterPlan one = planScatter(map, scatter, {.paths = 9, .threads = 1}),
                      many = planScatter(map, scatter, {.paths = 9, .threads = 5});
    EXPECT_EQ(one.hits.data(), many.hits.data());
    for (int b = 0; b < 3; ++b) {
        EXPECT_EQ(one.bounces[b].directions, many.bounces[b].directions);
        EXPECT_EQ(one.bounces[b].weights, many.bounces[b].weights);
    }
    EXPECT_EQ(litMask(map, Vec3(1, 0, 0), 1).data(), litMask(map, Vec3(1, 0, 0), 5).data());
}

}  // namespace
}  // namespace nacre
