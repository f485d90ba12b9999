// Horizons of reliefs against closed forms and against marching in small steps.
#include <gtest/gtest.h>

#include "reference/relief_rays.hpp"
#include "tests/reference/relief_maps.hpp"

namespace nacre {
namespace {

TEST(HorizonSlope, OfAFlatFieldIsZeroAndAllLightIsSeen) {
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror}) {
        const Relief flat(makeMap(5, 3, wrap, [](int, int) { return 7; }));
        for (int k = 0; k < 8; ++k) EXPECT_EQ(horizonSlope(flat, centre(2, 1), k * kPi / 4), 0);
        EXPECT_TRUE(isLit(flat, centre(2, 1), {1, 0, 0}));  // in the plane: grazing
        EXPECT_FALSE(isLit(flat, centre(2, 1), {1, 0, -1e-9}));
        EXPECT_TRUE(isLit(flat, centre(2, 1), {0, 0, 1}));
        EXPECT_FALSE(firstHit(flat, {2.5, 1.5, 7}, {1, 0, 0}));
    }
}

TEST(HorizonSlope, OfARampIsItsOwnSlope) {
    const Relief ramp(makeMap(40, 40, Wrap::Clamp, [](int x, int y) { return 0.5 * x + 0.25 * y; }));
    for (double turn = 0; turn < kPi / 2; turn += 0.1) {  // elsewhere the plains beyond the borders stand out
        const double expected = 0.5 * std::cos(turn) + 0.25 * std::sin(turn);
        EXPECT_NEAR(horizonSlope(ramp, centre(20, 20), turn), expected, kExact) << turn;
        EXPECT_NEAR(horizonSlope(ramp, {20.1, 20.7}, turn), expected, kExact) << turn;
        EXPECT_EQ(horizonSlope(ramp, centre(20, 20), turn + kPi), 0) << turn;
    }
}

TEST(HorizonSlope, OfAStep) {  // 0 up to x = 8, 3 from x = 9 on: the bilinear wall ends at texel 9's centre
    const HeightMap map = makeMap(16, 16, Wrap::Clamp, [](int x, int) { return x >= 9 ? 3 : 0; });
    for (const double azimuth : {0.0, 0.3, -0.7, 1.2})
        EXPECT_NEAR(horizonSlope(map, centre(5, 8), azimuth), 3 / (4 / std::cos(azimuth)), kExact) << azimuth;
    EXPECT_EQ(horizonSlope(map, centre(5, 8), kPi), 0);
    EXPECT_NEAR(horizonSlope(map, centre(8, 8), 0), 3, kExact);  // the own patch's slope
    EXPECT_TRUE(isLit(map, centre(5, 8), {4, 0, 3}));            // grazing
    EXPECT_FALSE(isLit(map, centre(5, 8), {4, 0, 3 - 1e-9}));
    EXPECT_FALSE(isLit(map, centre(5, 8), {-4, 0, -3}));
}

TEST(HorizonSlope, OfOneSpikeHasItsMaximumInsideAPatch) {
    // From (0, 0) past the spike S at (4, 4) off its top: along (cos, sin) the patch is S·s·t, a parabola.
    const HeightMap map = makeMap(9, 9, Wrap::Clamp, [](int x, int y) { return x == 4 && y == 4 ? 2 : 0; });
    const double azimuth = std::atan2(3.5, 4.0);
    const Vec2 d(std::cos(azimuth), std::sin(azimuth));
    double expected = 0;
    for (double t = 1e-3; t < 12; t += 1e-4) expected = std::max(expected, heightAt(map, centre(0, 0) + t * d) / t);
    EXPECT_NEAR(horizonSlope(map, centre(0, 0), azimuth), expected, 1e-8);
    EXPECT_NEAR(horizonSlope(map, centre(0, 4), 0), 0.5, kExact);
    EXPECT_NEAR(horizonSlope(map, centre(0, 0), kPi / 4), 2 / std::sqrt(32.), kExact);
    EXPECT_EQ(horizonSlope(map, centre(0, 0), kPi), 0);
}

TEST(HorizonSlope, OfASawToothAtNyquist) {  // −1, 1, −1, 1 …: from a low texel the next one is 2 higher
    const Relief saw(makeMap(8, 4, Wrap::Repeat, [](int x, int) { return x % 2 ? 1 : -1; }));
    for (int x = 0; x < 8; ++x)
        for (const double azimuth : {0.0, kPi, 0.4})
            EXPECT_NEAR(horizonSlope(saw, centre(x, 1), azimuth), x % 2 ? 0 : 2 * std::abs(std::cos(azimuth)), kExact);
}

TEST(HorizonSlope, CrossesTheSeamOfARepeatedMap) {
    const HeightMap map = makeMap(10, 6, Wrap::Repeat, [](int x, int y) { return x == 1 && y == 0 ? 3 : 0; });
    EXPECT_NEAR(horizonSlope(map, centre(8, 0), 0), 1, kExact);
    EXPECT_NEAR(horizonSlope(map, centre(1, 4), kPi / 2), 1.5, kExact);
    EXPECT_NEAR(horizonSlope(map, centre(8, 3), kPi / 4), 3 / std::sqrt(18.), kExact);
    EXPECT_EQ(horizonSlope(HeightMap{map.heights, Wrap::Clamp}, centre(8, 0), 0), 0);
}

TEST(HorizonSlope, OfAMirroredMapIsThatOfTheMapMirroredByHand) {
    const HeightMap map = roughMap(5, 7, Wrap::Mirror, 2);
    const HeightMap unfolded = makeMap(10, 14, Wrap::Repeat, [&](int x, int y) { return map.at(x, y); });
    Random random(2);
    for (int i = 0; i < 500; ++i) {
        const Vec2 p(random(-20, 20), random(-20, 20));
        const double azimuth = random(-7, 7);
        EXPECT_NEAR(horizonSlope(map, p, azimuth), horizonSlope(unfolded, p, azimuth), 1e-9);
    }
}

TEST(HorizonSlope, OfATinyMap) {
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror}) {
        EXPECT_EQ(horizonSlope(makeMap(1, 1, wrap, [](int, int) { return 4; }), centre(0, 0), 0.3), 0);
        const HeightMap line = makeMap(6, 1, wrap, [](int x, int) { return x == 4 ? 2 : 0; });
        EXPECT_NEAR(horizonSlope(line, centre(2, 0), 0.9), std::cos(0.9), kExact);
        EXPECT_EQ(horizonSlope(line, centre(2, 0), kPi / 2), 0);
    }
}

TEST(HorizonSlope, SkipsHoles) {
    // The only wall has a hole at one corner of each of its patches: nothing is left that blocks.
    HeightMap map = makeMap(9, 9, Wrap::Clamp, [](int x, int y) { return x == 5 && y == 4 ? 5 : 0; });
    const Relief whole(map);
    map.heights.at(5, 3, 0) = map.heights.at(5, 5, 0) = kHole;
    const Relief holed(map);
    EXPECT_NEAR(horizonSlope(whole, centre(2, 4), 0), 5. / 3, kExact);
    EXPECT_EQ(horizonSlope(holed, centre(2, 4), 0), 0);
    EXPECT_EQ(horizonSlope(holed, centre(5, 3), 0), 0);
    EXPECT_TRUE(isLit(holed, centre(5, 3), {1, 0, 0.01}));
    EXPECT_EQ(horizonSlope(holed, centre(5, 4), kPi), 0);
    // A hole on one side only: along the border the patch on the other side blocks, whichever side that is.
    for (const int side : {3, 5})
        for (const bool column : {false, true}) {
            HeightMap half = makeMap(9, 9, Wrap::Clamp, [](int x, int y) { return x == 4 && y == 4 ? 5 : 0; });
            half.heights.at(column ? side : 4, column ? 4 : side, 0) = kHole;
            const double turn = column ? kPi / 2 : 0;
            EXPECT_NEAR(horizonSlope(half, column ? centre(4, 1) : centre(1, 4), turn), 5. / 3, kExact) << side;
            EXPECT_NEAR(horizonSlope(half, column ? centre(4, 6) : centre(6, 4), turn + kPi), 2.5, kExact) << side;
        }
}

TEST(HorizonSlope, JustBeforeABorderIsThatAtTheBorder) {  // rise / distance there is a ratio of rounding errors
    const HeightMap map = makeMap(12, 12, Wrap::Clamp, [](int x, int y) {
        return 100 + (1 + 0.013 * y) * 0.31 * std::min(x, 5);  // one slope on both sides, then a plain
    });
    for (int i = 0; i < 200; ++i) {
        const Vec2 p(4.5, 5.5 + 0.005 * i);
        const double azimuth = 0.004 * i, before = 7e-15 * i;
        EXPECT_NEAR(horizonSlope(map, {p.x - before, p.y}, azimuth), horizonSlope(map, p, azimuth), 1e-6) << before;
    }
}

TEST(HorizonSlope, ScalesWithTheHeights) {
    for (const double scale : {1e6, 1e-6}) {
        const HeightMap map = roughMap(17, 13, Wrap::Repeat, 1),
                        scaled = makeMap(17, 13, Wrap::Repeat, [&](int x, int y) { return scale * map.at(x, y); });
        Random random(3);
        for (int i = 0; i < 200; ++i) {
            const Vec2 p = centre(static_cast<int>(random(0, 17)), static_cast<int>(random(0, 13)));
            const double azimuth = random(0, 7), expected = scale * horizonSlope(map, p, azimuth);
            EXPECT_NEAR(horizonSlope(scaled, p, azimuth), expected, 1e-6 * scale);  // heights are rounded to float
        }
    }
}

TEST(HorizonSlope, AgreesWithMarching) {
    constexpr double kStep = 1. / 64;
    const HeightMap map = roughMap(32, 27, Wrap::Repeat, 3);
    const Relief relief(map);
    Random random(4);
    for (int i = 0; i < 300; ++i) {
        const Vec2 p = i % 2 ? centre(static_cast<int>(random(0, 32)), static_cast<int>(random(0, 27)))
                             : Vec2(random(-40, 40), random(-40, 40));
        const double azimuth = random(0, 2 * kPi), own = heightAt(map, p), slope = horizonSlope(relief, p, azimuth);
        const Vec2 d(std::cos(azimuth), std::sin(azimuth));
        double marched = 0;
        for (double t = 1e-6; t < kStep; t *= 1.05)  // the own patch's slope may last less than a step
            marched = std::max(marched, (heightAt(map, p + t * d) - own) / t);
        for (int k = 1; k < 64 * 60; ++k)
            marched = std::max(marched, (heightAt(map, p + k * kStep * d) - own) / (k * kStep));
        EXPECT_GE(slope, marched - 1e-6);
        EXPECT_LE(slope, marched + 0.12) << "curvature 12 a texel² near the start, over one step";
        EXPECT_TRUE(isLit(relief, p, {d.x, d.y, slope + 1e-6}));
        EXPECT_EQ(isLit(relief, p, {d.x, d.y, std::max(0.0, slope - 1e-6)}), slope == 0);
    }
}

}  // namespace
}  // namespace nacre
