#include "bump/bump_levels.hpp"

#include <gtest/gtest.h>

#include "core/directions.hpp"

namespace nacre {
namespace {

HeightMap bumpy(int width, int height) {
    HeightMap map{Image(width, height, 1), Wrap::Repeat};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            map.heights.at(x, y, 0) = static_cast<float>(
                4 * std::sin(2 * kPi * 3 * x / width) * std::cos(2 * kPi * 2 * y / height) + 2 * ((x / 5 + y / 7) % 2));
    return map;
}

double meanShare(const EllipseLevel& level, const Vec3& light) {
    double sum = 0;
    for (int y = 0; y < level.shape.height(); ++y)
        for (int x = 0; x < level.shape.width(); ++x) {
            const Image &s = level.shape, &o = level.offset;
            const HorizonEllipse e{s.at(x, y, 0), s.at(x, y, 1), s.at(x, y, 2), o.at(x, y, 0), o.at(x, y, 1)};
            sum += litShare(ellipseValue(e, light), s.at(x, y, 3));
        }
    return sum / static_cast<double>(level.shape.texelCount());
}

TEST(BumpLevels, LitShareAndAlpha) {
    EXPECT_EQ(litShare(0, 0), 1);
    EXPECT_EQ(litShare(-1e-9, 0), 0);
    EXPECT_EQ(litShare(0, 0.5), 0.5);
    EXPECT_EQ(litShare(0.5, 0.5), 1);
    EXPECT_EQ(litShare(-0.5, 0.5), 0);
    EXPECT_DOUBLE_EQ(bumpedAlpha(0.3, 0.4), 0.5);
    EXPECT_EQ(bumpedAlpha(0.3, 0), 0.3);
}

// From afar a relief is as light as it is on average. The mean of M and o alone would be all or nothing.
TEST(BumpLevels, CoarseEllipsesKeepTheShareOfLight) {
    constexpr double kShare =
        0.15;  // one ellipse and its spread stand for many: measured 0.07, and 0.133 in the last texel
    const EllipseMap map = fitEllipses(bumpy(48, 36), {.directions = 32});
    const std::vector<EllipseLevel> levels = ellipseLevels(map);
    ASSERT_EQ(levels.size(), 6u);
    EXPECT_EQ(levels.back().shape.width(), 1);
    EXPECT_EQ(levels.back().shape.height(), 1);
    double worst = 0;
    for (const double elevation : {0.15, 0.4, 0.8, 1.4})
        for (const double azimuth : {0.1, 1.3, 2.9, 4.4}) {
            const Vec3 light = sphericalDirection(kPi / 2 - elevation, azimuth);
            for (const EllipseLevel& level : levels)
                worst = std::max(worst, std::abs(meanShare(level, light) - meanShare(levels[0], light)));
        }
    RecordProperty("worst", std::to_string(worst));
    EXPECT_LT(worst, kShare);
}

TEST(BumpLevels, FinestIsTheMapAndThreadsDontMatter) {
    const EllipseMap map = fitEllipses(bumpy(17, 6), {.directions = 16});
    const auto levels = ellipseLevels(map, 1), again = ellipseLevels(map, 7);
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 17; ++x) {
            EXPECT_EQ(levels[0].shape.rgb(x, y), map.shape.rgb(x, y));
            EXPECT_EQ(levels[0].shape.at(x, y, 3), 0);
            EXPECT_EQ(levels[0].offset.rgb(x, y), map.offset.rgb(x, y));
        }
    ASSERT_EQ(levels.size(), again.size());
    for (std::size_t i = 0; i < levels.size(); ++i) {
        EXPECT_EQ(levels[i].shape.data(), again[i].shape.data());
        EXPECT_EQ(levels[i].offset.data(), again[i].offset.data());
    }
}

TEST(BumpLevels, AllLitAllDarkAndHalfAndHalf) {
    EllipseMap map{Image(4, 4, 3), Image(4, 4, 3)};
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) map.offset.setRgb(x, y, {0, 0, 1});
    for (const EllipseLevel& level : ellipseLevels(map)) EXPECT_EQ(meanShare(level, {0.6, 0, 0.8}), 1);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) map.offset.setRgb(x, y, {2, 0, 0});
    for (const EllipseLevel& level : ellipseLevels(map)) EXPECT_EQ(meanShare(level, {0.6, 0, 0.8}), 0);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 2; ++x) map.offset.setRgb(x, y, {0, 0, 1});
    for (const EllipseLevel& level : ellipseLevels(map)) EXPECT_NEAR(meanShare(level, {0.6, 0, 0.8}), 0.5, 1e-5);
}

TEST(BumpLevels, HorizonsAreMeansWithTheirSpread) {
    HorizonMap map;
    for (int k = 0; k < 5; ++k) {
        map.elevation.emplace_back(6, 5, 1);
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 6; ++x) map.elevation.back().at(x, y, 0) = x % 2 == 0 ? 0.2f : 0.8f;
    }
    const std::vector<HorizonLevel> levels = horizonLevels(map, 2);
    ASSERT_EQ(levels.size(), 3u);
    EXPECT_EQ(levels[0].elevation[3].data(), map.elevation[3].data());
    EXPECT_EQ(levels[0].spread.at(2, 2, 0), 0);
    for (std::size_t level = 1; level < 3; ++level)
        for (std::size_t i = 0; i < levels[level].spread.data().size(); ++i) {
            EXPECT_NEAR(levels[level].elevation[4].data()[i], 0.5, 1e-6);
            EXPECT_NEAR(levels[level].spread.data()[i], std::sqrt(3.0) * 0.3, 1e-5);
        }
}

TEST(BumpLevels, RejectsBadMaps) {
    EXPECT_THROW(ellipseLevels(EllipseMap{}), std::invalid_argument);
    EXPECT_THROW(ellipseLevels({Image(2, 2, 3), Image(3, 2, 3)}), std::invalid_argument);
    EXPECT_THROW(horizonLevels(HorizonMap{}), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
