#include "bump/horizon_map.hpp"

#include <gtest/gtest.h>

#include "reference/bump_error.hpp"
#include "tests/bump/relief_fixtures.hpp"

namespace nacre {
namespace {

constexpr double kTolerance = 1.1e-3;  // of slopes, at worst: what horizonSlopes promises, and rounding

void expectExact(const HeightMap& map, const char* what, int azimuths = 16) {
    const HorizonSamples samples = drawHorizonSamples(map, azimuths, 3000);
    const HorizonError error = measureHorizons(samples, makeHorizonMap(map, azimuths));
    EXPECT_LE(error.maxRad, std::atan(kTolerance)) << what;
    EXPECT_GE(error.shareWithinMilliRad, 0.995) << what;
    EXPECT_LE(error.rmseDegAlongAxes, 0.05) << what;
    EXPECT_LE(error.rmseDegWorst, 0.05) << what;
}

TEST(HorizonMap, MatchesTheReferenceOnRoughReliefsOfAnyWrapAndSize) {
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror})
        for (const auto& [width, height] : {std::pair(96, 96), {67, 33}, {1, 40}, {40, 1}, {5, 3}})
            for (const float amplitude : {0.3f, 3.0f, 30.0f})
                expectExact(roughMap(width, height, amplitude, wrap), toString(wrap).c_str());
}

TEST(HorizonMap, MatchesTheReferenceAtAnyAzimuth) { expectExact(roughMap(64, 48, 5), "37 azimuths", 37); }

TEST(HorizonMap, HeightsOfAMillionAndOfAMillionth) {
    for (const float scale : {1e6f, 1e-6f}) {
        HeightMap map = roughMap(48, 48, 1);
        for (float& z : map.heights.data()) z *= scale;
        expectExact(map, scale > 1 ? "1e6" : "1e-6");
    }
}

TEST(HorizonMap, FlatAndSingleTexelHaveNoHorizon) {
    for (const HeightMap& map : {flatMap(40, 20, 7), flatMap(1, 1, -3), flatMap(1, 9)})
        for (const double azimuth : {0.0, 0.3, 2.0, 5.5})
            for (const float slope : horizonSlopes(map, azimuth)) EXPECT_EQ(slope, 0);
}

TEST(HorizonMap, SpikeIsSeenFromAfarAndAcrossTheSeam) {
    HeightMap map = flatMap(64, 8);
    map.heights.at(2, 4, 0) = 10;
    const std::vector<float> slopes = horizonSlopes(map, 0);
    EXPECT_FLOAT_EQ(slopes[4 * 64 + 0], 5);
    EXPECT_FLOAT_EQ(slopes[4 * 64 + 60], 10.0f / 6);
    EXPECT_FLOAT_EQ(slopes[4 * 64 + 2], 0) << "the spike's own: its copy is as high";
    EXPECT_FLOAT_EQ(slopes[6 * 64 + 0], 0) << "a row that the spike's patches don't reach";
}

/// No bound may leave out a chunk for which one corner of a patch is all that matters, at whatever distance.
TEST(HorizonMap, EveryTexelSeesASpikeInItsRowOrDiagonal) {
    constexpr double kStep = 1e-3;  // of slopes: for less, no chunk is looked at
    constexpr int dx[] = {1, 1, 0, -1, -1, -1, 0, 1}, dy[] = {0, 1, 1, 1, 0, -1, -1, -1};
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror}) {
        HeightMap map = flatMap(96, 80);
        map.wrap = wrap;
        map.heights.at(40, 30, 0) = 50;
        for (int k = 0; k < 8; ++k) {
            const std::vector<float> slopes = horizonSlopes(map, k * kPi / 4);
            double worst = 0;
            for (int y = 0; y < map.height(); ++y)
                for (int x = 0; x < map.width(); ++x)
                    for (int t = 1; t < 500; ++t) {
                        const double rise = map.at(x + t * dx[k], y + t * dy[k]) - map.at(x, y);
                        worst = std::max(worst, rise / (t * std::hypot(dx[k], dy[k])) - slopes[y * map.width() + x]);
                    }
            EXPECT_LE(worst, kStep) << toString(wrap) << " towards " << 45 * k << " degrees";
        }
    }
}

TEST(HorizonMap, BlocksWithSharpCorners) {
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror}) {
        HeightMap map = flatMap(160, 128);
        map.wrap = wrap;
        for (int y = 0; y < map.height(); ++y)
            for (int x = 0; x < map.width(); ++x)
                map.heights.at(x, y, 0) = static_cast<float>((x / 16 * 7 % 5) * 9 + (y / 16 * 3 % 5) * 4);
        expectExact(map, toString(wrap).c_str());
    }
}

TEST(HorizonMap, SawToothAtNyquist) {
    HeightMap map = flatMap(32, 32);
    for (int y = 0; y < 32; ++y)
        for (int x = 1; x < 32; x += 2) map.heights.at(x, y, 0) = 1;
    const std::vector<float> slopes = horizonSlopes(map, 0);
    for (int x = 0; x < 32; ++x) EXPECT_FLOAT_EQ(slopes[x], x % 2 == 0 ? 1 : 0);
    expectExact(map, "saw-tooth");
}

TEST(HorizonMap, HolesHideNothing) {
    HeightMap map = roughMap(40, 40, 4);
    for (int k = 0; k < 40; ++k) map.heights.at(k, (7 * k) % 40, 0) = std::nanf("");
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror}) {
        map.wrap = wrap;
        expectExact(map, ("holes, " + toString(wrap)).c_str());
    }
    for (float& z : map.heights.data()) z = std::nanf("");
    for (const float slope : horizonSlopes(map, 1)) EXPECT_EQ(slope, 0);
}

TEST(HorizonMap, ClampedBordersStandBesideHoles) {  // the surface goes on beyond its border rows
    HeightMap map = flatMap(8, 3);
    map.wrap = Wrap::Clamp;
    for (const int row : {0, 2}) map.heights.at(3, row, 0) = 5;
    for (int x = 1; x < 8; ++x) map.heights.at(x, 1, 0) = std::nanf("");
    for (const int row : {0, 2}) {
        EXPECT_FLOAT_EQ(horizonSlopes(map, 0)[row * 8], 5.0f / 3);
        EXPECT_FLOAT_EQ(horizonSlopes(map, kPi)[row * 8 + 7], 5.0f / 4);
    }
}

TEST(HorizonMap, SameBitsForAnyThreadCount) {
    const HeightMap map = roughMap(70, 50, 4);
    EXPECT_EQ(horizonSlopes(map, 0.7, 1), horizonSlopes(map, 0.7, 5));
}

TEST(HorizonMap, BlendsBetweenAzimuths) {
    const HeightMap map = roughMap(16, 16, 4);
    const HorizonMap horizons = makeHorizonMap(map, 8);
    const double a = horizons.elevation[7].at(3, 4, 0), b = horizons.elevation[0].at(3, 4, 0);
    EXPECT_NEAR(horizonElevation(horizons, 3, 4, 2 * kPi * 7.25 / 8), 0.75 * a + 0.25 * b, 1e-9);
    EXPECT_NEAR(horizonElevation(horizons, 3, 4, -2 * kPi * 0.75 / 8), 0.75 * a + 0.25 * b, 1e-9);
}

TEST(HorizonMap, RejectsBadInput) {
    EXPECT_THROW(horizonSlopes({}, 0), std::invalid_argument);
    EXPECT_THROW(horizonSlopes(flatMap(2, 2), std::nan("")), std::invalid_argument);
    EXPECT_THROW(makeHorizonMap(flatMap(2, 2), 0), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
