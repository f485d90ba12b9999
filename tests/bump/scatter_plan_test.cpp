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
    map.heights.at(4, 4, 0) = map.heights.at(2, 4, 0) = std::nanf("");
    const Image normals = planScatter(map, makeScatterMap(map, {.directions = 4})).normals;
    for (int y = 0; y < 7; ++y)
        for (int x = 0; x < 9; ++x)
            if (!std::isnan(map.at(x, y))) {
                EXPECT_LT(glm::length(normals.rgb(x, y) - texelNormal(map, x, y)), 1e-6) << x << ' ' << y;
            }
    EXPECT_EQ(ownSlopes(map, 3, 4).y, 0) << "beside the hole";
    EXPECT_EQ(ownSlopes(map, 2, 2).y, map.at(3, 2) - map.at(2, 2));
}

TEST(ScatterPlan, PeriodOfAMirroredReliefRepeats) {
    const HeightMap map = roughMap(5, 4, 3, Wrap::Mirror), whole = reliefPeriod(map);
    EXPECT_EQ(whole.wrap, Wrap::Repeat);
    for (int y = -9; y < 17; ++y)
        for (int x = -11; x < 21; ++x) EXPECT_EQ(whole.at(x, y), map.at(x, y));
    EXPECT_EQ(reliefPeriod(roughMap(5, 4, 3, Wrap::Clamp)).width(), 5);
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

TEST(ScatterPlan, StepsAreSharedByTheBounces) {
    const HeightMap map = roughMap(8, 8, 2);
    const ScatterMap scatter = makeScatterMap(map, {.directions = 16});
    for (const auto& [paths, bounces] : {std::pair(100, 3), {7, 2}, {50, 1}, {1, 4}, {9, 0}}) {
        const ScatterPlan plan = planScatter(map, scatter, {.bounces = bounces, .paths = paths});
        const int steps = plan.viewed.count + 4 * std::max(0, bounces - 1) * plan.patches[3].count;
        if (paths > 1)
            EXPECT_EQ(steps, paths * bounces);
        else
            EXPECT_GE(plan.patches[0].count, 1);
        EXPECT_EQ(plan.viewed.count > 0, bounces > 0);
    }
}

TEST(ScatterPlan, PointsAreWhatIsSeenAsTheCosineWeighsIt) {
    const HeightMap map = roughMap(16, 16, 4);
    const ScatterMap scatter = makeScatterMap(map, {.directions = 128});
    const ScatterPlan plan = planScatter(map, scatter, {.paths = 2000});
    for (const std::size_t i : {0u, 77u, 255u}) {
        const int x = static_cast<int>(i % 16), y = static_cast<int>(i / 16);
        double all = 0, away = 0, own = 0;
        Vec2 mean(0);
        for (int k = 0; k < scatter.count(); ++k) {
            const double w = lambertWeight(plan.normals.rgb(x, y), scatter.directions[k], scatter.weights[k]);
            const double distance = scatter.distance[k].data()[i];
            all += w;
            if (distance == 0) own += w;
            if (distance <= 0) continue;
            away += w;
            mean += w * (seenPoint(x, y, scatter.directions[k], distance) - Vec2(x + 0.5, y + 0.5));
        }
        EXPECT_NEAR(plan.viewed.share[i], away / all, 1e-5);
        EXPECT_NEAR(plan.viewed.own[i].x + plan.viewed.own[i].y + plan.viewed.own[i].z + plan.viewed.own[i].w,
                    own / all, 1e-5);
        Vec2 found(0);
        for (int n = 0; n < plan.viewed.count; ++n) found += Vec2(plan.viewed.offset(i, n));
        ASSERT_GT(away, 0);
        EXPECT_NEAR(glm::length(found / static_cast<double>(plan.viewed.count) - mean / away), 0, 0.02) << i;
    }
}

TEST(ScatterPlan, OwnPatchHidesNothingFromItsOwnNormal) {
    const HeightMap map = roughMap(16, 16, 6);
    const ScatterPlan plan = planScatter(map, makeScatterMap(map, {.directions = 128}));
    double others = 0;
    for (std::size_t q = 0; q < 4; ++q)
        for (const glm::vec4& own : plan.patches[q].own) {
            EXPECT_LT(own[static_cast<int>(q)], 1e-3) << "it is flat enough to see above itself";
            others += own[3 - static_cast<int>(q)];
        }
    EXPECT_GT(others, 1) << "but the patch across the corner is in the way at times";
}

TEST(ScatterPlan, HitsAreTheShareOfTheCosine) {  // the groove of slope 1: half of what its bottom sees is wall
    HeightMap map{Image(64, 1, 1), Wrap::Repeat};
    for (int x = 0; x < 64; ++x) map.heights.at(x, 0, 0) = static_cast<float>(std::abs(x - 32));
    const SeenPoints seen = planScatter(map, makeScatterMap(map, {.directions = 1024})).viewed;
    const auto hits = [&](std::size_t i) {
        return seen.share[i] + seen.own[i].x + seen.own[i].y + seen.own[i].z + seen.own[i].w;
    };
    EXPECT_NEAR(hits(32), 1 - std::sqrt(0.5), 0.02) << "1 - sin 45 degrees of the strip above";
    EXPECT_NEAR(hits(0), 0, 0.02) << "a crest that sees sky";
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
    EXPECT_EQ(one.viewed.offsets, many.viewed.offsets);
    EXPECT_EQ(one.viewed.share, many.viewed.share);
    for (std::size_t q = 0; q < 4; ++q) {
        EXPECT_EQ(one.patches[q].offsets, many.patches[q].offsets);
        EXPECT_EQ(one.patches[q].own, many.patches[q].own);
    }
    EXPECT_EQ(litMask(map, Vec3(1, 0, 0), 1).data(), litMask(map, Vec3(1, 0, 0), 5).data());
}

}  // namespace
}  // namespace nacre
