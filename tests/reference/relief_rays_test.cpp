// First hits on reliefs against closed forms, marching in small steps and Embree.
#include "reference/relief_rays.hpp"

#include <gtest/gtest.h>

#include "reference/embree_scene.hpp"
#include "tests/reference/relief_maps.hpp"

namespace nacre {
namespace {

TEST(FirstHit, ARampParallelToTheRayIsNotHit) {
    const Relief ramp(makeMap(64, 8, Wrap::Clamp, [](int x, int) { return 0.5 * x; }));
    const Vec3 along = glm::normalize(Vec3(1, 0, 0.5));
    EXPECT_FALSE(firstHit(ramp, {3.5, 4.5, 1.5}, along));
    EXPECT_TRUE(isLit(ramp, centre(3, 4), along));
    const auto below = firstHit(ramp, {3.5, 4.5, 1.5}, glm::normalize(Vec3(1, 0, 0.49)));
    ASSERT_TRUE(below);
    EXPECT_EQ(below->planeDistance, 0);
    EXPECT_NEAR(below->normal.x / below->normal.z, -0.5, kExact);
    // Down the slope, parallel: ends where the plain before the ramp begins (texel 0's centre).
    const auto down = firstHit(ramp, {3.5, 4.5, 1.5}, -along);
    ASSERT_TRUE(down);
    EXPECT_NEAR(down->planeDistance, 3, 1e-9);
}

TEST(FirstHit, MeetsAWallWhereTheClosedFormSays) {  // height 3(x − 8.5) between 8.5 and 9.5
    const Relief step(makeMap(16, 16, Wrap::Clamp, [](int x, int) { return x >= 9 ? 3 : 0; }));
    const Vec3 d = glm::normalize(Vec3(4, 1, 1));
    const auto hit = firstHit(step, {5.5, 8.5, 0}, d);  // z = (x − 5.5)/4 meets the wall at x = 8.5 + 0.75/2.75
    ASSERT_TRUE(hit);
    const double x = 8.5 + 0.75 / 2.75;
    EXPECT_NEAR(hit->point.x, x, kExact);
    EXPECT_NEAR(hit->point.y, 8.5 + (x - 5.5) / 4, kExact);
    EXPECT_NEAR(hit->point.z, (x - 5.5) / 4, kExact);
    EXPECT_NEAR(hit->planeDistance, (x - 5.5) * std::sqrt(17.) / 4, kExact);
    EXPECT_NEAR(hit->rayDistance, (x - 5.5) * std::sqrt(18.) / 4, kExact);
    EXPECT_NEAR(glm::length(hit->normal - glm::normalize(Vec3(-3, 0, 1))), 0, kExact);
    EXPECT_FALSE(firstHit(step, {5.5, 8.5, 0}, glm::normalize(Vec3(4, 0, 3))));  // touches the edge at 9.5
    EXPECT_TRUE(firstHit(step, {5.5, 8.5, 0}, glm::normalize(Vec3(4, 0, 3 - 1e-6))));
}

TEST(FirstHit, VerticalRays) {
    const HeightMap map = roughMap(6, 5, Wrap::Repeat, 1);
    for (const Vec2& p : {centre(2, 3), Vec2(2.5, 1.1), Vec2(-7.3, 22.9)}) {
        const auto hit = firstHit(map, {p.x, p.y, 5}, {0, 0, -1});
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->rayDistance, 5 - heightAt(map, p), kExact);
        EXPECT_EQ(hit->planeDistance, 0);
        EXPECT_FALSE(firstHit(map, onSurface(map, p), {0, 0, 1}));
        EXPECT_EQ(firstHit(map, onSurface(map, p), {0, 0, -1})->rayDistance, 0);
    }
}

TEST(FirstHit, AtATexelCentreTheDirectionChoosesThePatch) {  // a tent: both sides of the ridge fall by 1 a texel
    const Relief tent(makeMap(9, 9, Wrap::Clamp, [](int x, int) { return -std::abs(x - 4); }));
    for (const double side : {1., -1.}) {
        const auto inside = firstHit(tent, {4.5, 4.5, 0}, glm::normalize(Vec3(side, 0, -1.01)));
        ASSERT_TRUE(inside);
        EXPECT_EQ(inside->planeDistance, 0);
        EXPECT_GT(side * inside->normal.x, 0);
        const auto outside = firstHit(tent, {4.5, 4.5, 0}, glm::normalize(Vec3(side, 0.5, -0.99)));
        ASSERT_TRUE(outside);  // flat beyond the border texel, 4 below
        EXPECT_NEAR(outside->planeDistance, 4 / 0.99 * std::hypot(1, 0.5), 1e-9);
        EXPECT_NEAR(outside->normal.z, 1, kExact);
    }
    // A valley: what rises from the point is hit at once, what is steeper is not.
    const Relief valley(makeMap(9, 9, Wrap::Clamp, [](int x, int) { return std::abs(x - 4); }));
    EXPECT_EQ(firstHit(valley, {4.5, 4.5, 0}, glm::normalize(Vec3(-1, 0, 0.9)))->planeDistance, 0);
    EXPECT_FALSE(firstHit(valley, {4.5, 4.5, 0}, glm::normalize(Vec3(-1, 0, 1.1))));
}

TEST(FirstHit, ASaddleThatCurvesUpIsHitAtOnce) {  // height x·y in the patch: level along x and y, up between
    const Relief saddle(makeMap(2, 2, Wrap::Clamp, [](int x, int y) { return x * y; }));
    const auto hit = firstHit(saddle, {0.5, 0.5, 0}, glm::normalize(Vec3(1, 1, 0)));
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->rayDistance, 0);
    EXPECT_FALSE(firstHit(saddle, {0.5, 0.5, 0}, {1, 0, 0}));
}

TEST(FirstHit, OutOfAHoleBelowTheNextPatchIsAHitAtItsBorder) {
    const HeightMap map = makeMap(12, 5, Wrap::Clamp, [](int x, int) { return x == 5 ? kHole : x > 5 ? 2 : 0; });
    const auto hit = firstHit(map, {2.5, 2.3, 0}, glm::normalize(Vec3(4, 0, 1)));
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->planeDistance, 4, kExact);
    EXPECT_EQ(hit->point.z, 2);
    EXPECT_NEAR(horizonSlope(map, {2.5, 2.3}, 0), 0.5, kExact);
    EXPECT_FALSE(firstHit(map, {5.5, 2.3, 3}, {0, 0, -1}));
    EXPECT_EQ(firstHit(map, {4.5, 2.5, 3}, {0, 0, -1})->rayDistance, 3) << "the border of the last patch";
}

TEST(FirstHit, HasTheHorizonAsItsLimit) {
    for (const double scale : {2., 1e6, 1e-6}) {
        const HeightMap map = roughMap(23, 31, Wrap::Mirror, scale);
        const Relief relief(map);
        Random random(5);
        int hits = 0;
        for (int i = 0; i < 1000; ++i) {
            const Vec2 p = centre(static_cast<int>(random(0, 23)), static_cast<int>(random(0, 31)));
            const double azimuth = random(0, 7), slope = horizonSlope(relief, p, azimuth), x = std::cos(azimuth);
            const Vec3 d(x, std::sin(azimuth), slope + 1e-6 * scale), e(d.x, d.y, slope - 1e-6 * scale);
            EXPECT_FALSE(firstHit(relief, onSurface(map, p), glm::normalize(d)));
            if (slope == 0) continue;
            ++hits;
            const auto hit = firstHit(relief, onSurface(map, p), glm::normalize(e));
            ASSERT_TRUE(hit);
            const double z = heightAt(map, p) + hit->planeDistance * e.z;
            EXPECT_NEAR(z, hit->point.z, 1e-9 * scale);
            EXPECT_NEAR(heightAt(map, Vec2(hit->point)), hit->point.z, 1e-9 * scale);
        }
        EXPECT_GT(hits, 500);
    }
}

TEST(FirstHit, AgreesWithMarchingInEveryDirection) {
    constexpr double kStep = 1. / 64;
    const HeightMap map = roughMap(16, 19, Wrap::Repeat, 2);
    const Relief relief(map);
    Random random(6);
    int found = 0, far = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec2 p(random(0, 16), random(0, 19));
        const Vec3 d = random.direction(), from = onSurface(map, p) + Vec3(0, 0, i % 3 ? 0 : random(0, 3));
        const auto hit = firstHit(relief, from, d);
        double marched = -1;
        for (int k = 1; k < 64 * 40 && marched < 0; ++k) {
            const Vec3 q = from + k * kStep * d;
            if (q.z < heightAt(map, Vec2(q))) marched = k * kStep;
        }
        if (marched < 0) continue;  // a hit may still be farther away
        ++found;
        ASSERT_TRUE(hit);
        EXPECT_LE(hit->rayDistance, marched + 1e-9);
        if (hit->rayDistance < marched - kStep - 1e-9) ++far;  // marching stepped over a crest
        EXPECT_LE(glm::dot(hit->normal, d), 1e-9) << "seen from above";
    }
    EXPECT_GT(found, 1000);
    EXPECT_LT(far, 20);
}

TEST(FirstHit, RejectsWhatIsNoDirection) {
    const HeightMap map = roughMap(4, 4, Wrap::Repeat, 1);
    EXPECT_THROW(firstHit(map, {1, 1, 1}, {1, 1, 0}), std::invalid_argument);
    EXPECT_THROW(firstHit(map, {kHole, 1, 1}, {1, 0, 0}), std::invalid_argument);
    EXPECT_THROW(horizonSlope(map, {1, 1}, kHole), std::invalid_argument);
    EXPECT_THROW(isLit(map, {1, 1}, {1, 0, kHole}), std::invalid_argument);
    EXPECT_THROW(Relief(HeightMap{}), std::invalid_argument);
}

// ---- another ray tracer

/// Patches over 3 × 3 tiles about the map, each cut into kCuts² squares.
Mesh tessellate(const HeightMap& map) {
    constexpr int kCuts = 16;
    const int w = 3 * map.width() * kCuts, h = 3 * map.height() * kCuts;
    Mesh mesh;
    for (int j = 0; j <= h; ++j)
        for (int i = 0; i <= w; ++i) {
            const Vec2 p(i / double{kCuts} - map.width(), j / double{kCuts} - map.height());
            mesh.positions.emplace_back(p.x, p.y, heightAt(map, p));
        }
    const auto index = [&](int i, int j) { return static_cast<unsigned>(j * (w + 1) + i); };
    for (int j = 0; j < h; ++j)
        for (int i = 0; i < w; ++i) {
            mesh.triangles.emplace_back(index(i, j), index(i + 1, j), index(i, j + 1));
            mesh.triangles.emplace_back(index(i + 1, j), index(i + 1, j + 1), index(i, j + 1));
        }
    return mesh;
}

TEST(FirstHit, AgreesWithEmbree) {
    const HeightMap map = roughMap(8, 7, Wrap::Repeat, 2);
    const Relief relief(map);
    const EmbreeScene scene(tessellate(map));
    constexpr double kCutError = 4e-3;  // triangles of 1/16 texel leave a patch of twist ≤ 4 at most 4 / 4 / 16² away
    Random random(7);
    int mismatches = 0, apart = 0, hits = 0, count = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec2 p(random(0, 8), random(0, 7));
        const Vec3 from = onSurface(map, p) + Vec3(0, 0, random(0.02, 2)), d = random.direction();
        const auto hit = firstHit(relief, from, d);
        const double flat = std::hypot(d.x, d.y), end = 6.5 / flat;  // stay on the 3 × 3 tiles
        const RayHit other = scene.firstHit({from, d, 0, end});
        const bool seen = hit && hit->rayDistance < end;
        ++count;
        if (seen != other.found) ++mismatches;
        if (!seen || !other.found) continue;
        ++hits;
        if (std::abs(hit->rayDistance - other.t) > 5 * kCutError) ++apart;
    }
    EXPECT_GT(hits, count / 3);
    EXPECT_LT(mismatches, count / 2000);  // rays that graze a crest
    EXPECT_LT(apart, count / 2000);
}

}  // namespace
}  // namespace nacre
