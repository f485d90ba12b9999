// Normals against closed forms, levels against the mean slope that they must keep.
#include "bump/normals.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace nacre {
namespace {

HeightMap reliefOf(int width, int height, Wrap wrap, const std::function<double(int, int)>& z) {
    HeightMap map{Image(width, height, 1), wrap};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) map.heights.at(x, y, 0) = static_cast<float>(z(x, y));
    return map;
}

Vec2 slopeOf(const Image& normals, int x, int y) {
    const Vec3 n = normals.rgb(x, y);
    return {-n.x / n.z, -n.y / n.z};
}

Vec2 meanSlope(const Image& normals) {
    Vec2 sum(0);
    for (int y = 0; y < normals.height(); ++y)
        for (int x = 0; x < normals.width(); ++x) sum += slopeOf(normals, x, y);
    return sum / static_cast<double>(normals.texelCount());
}

double rough(int x, int y) { return std::sin(1.3 * x + 0.4 * y * y) + 0.7 * std::cos(0.9 * x * y); }

TEST(Normals, FlatFieldIsUpAndSmoothAtEveryLevelAndSize) {
    for (const auto& [width, height] : {std::pair{8, 8}, {1, 1}, {1, 7}, {9, 1}, {5, 3}}) {
        const NormalMap map =
            makeNormals(reliefOf(width, height, Wrap::Repeat, [](int, int) { return 3; }), {.roughness = true});
        EXPECT_EQ(map.levels.back().texelCount(), 1u);
        for (const Image& level : map.levels)
            for (int y = 0; y < level.height(); ++y)
                for (int x = 0; x < level.width(); ++x) {
                    EXPECT_EQ(level.rgb(x, y), Vec3(0, 0, 1));
                    EXPECT_EQ(level.at(x, y, 3), 0);
                }
    }
}

TEST(Normals, RampHasItsSlopeAndNoRoughnessInside) {
    const HeightMap map = reliefOf(16, 16, Wrap::Clamp, [](int x, int y) { return 0.5 * x - 2.0 * y; });
    const NormalMap normals = makeNormals(map, {.roughness = true});
    const Vec3 expected = glm::normalize(Vec3(-0.5, 2, 1));
    for (const int level : {0, 1, 2})  // clamped borders are half as steep
        for (int k = 1; k < (16 >> level) - 1; ++k) {
            EXPECT_NEAR(glm::length(normals.levels[static_cast<std::size_t>(level)].rgb(k, k) - expected), 0, 1e-6);
            EXPECT_NEAR(normals.levels[static_cast<std::size_t>(level)].at(k, k, 3), 0, 1e-3);
        }
    EXPECT_NEAR(slopeOf(normals.levels[0], 0, 5).x, 0.25, 1e-6) << "a level patch on one side";
}

TEST(Normals, SineHasCentralDifferencesAndItsVarianceAsRoughness) {
    const double k = 2 * kPi / 16, amplitude = 2;
    const NormalMap map = makeNormals(
        reliefOf(64, 4, Wrap::Repeat, [&](int x, int) { return amplitude * std::sin(k * x); }), {.roughness = true});
    for (int x = 0; x < 64; ++x)
        EXPECT_NEAR(slopeOf(map.levels[0], x, 1).x, amplitude * std::sin(k) * std::cos(k * x), 1e-5) << x;
    // Over whole periods: mean 0, variance along x (A sin k)²/2, along y 0; alpha² is their sum.
    EXPECT_NEAR(map.levels.back().at(0, 0, 3), amplitude * std::sin(k) / std::sqrt(2), 1e-5);
    EXPECT_NEAR(map.levels.back().rgb(0, 0).z, 1, 1e-9);
    EXPECT_EQ(map.levels[0].at(3, 1, 3), 0) << "the finest level has lost nothing";
}

TEST(Normals, EveryLevelKeepsTheMeanSlopeAtOddSizesToo) {
    for (const auto& [width, height] : {std::pair{64, 64}, {37, 23}, {1, 31}, {45, 1}, {7, 64}}) {
        const NormalMap map = makeNormals(reliefOf(width, height, Wrap::Clamp, rough));
        const Vec2 expected = meanSlope(map.levels[0]);
        for (const Image& level : map.levels)
            EXPECT_NEAR(glm::length(meanSlope(level) - expected), 0, 1e-5)
                << width << " x " << height << " at " << level.width() << " x " << level.height();
    }
}

TEST(Normals, WrapDecidesTheBorder) {
    const auto ramp = [](int x, int) { return x; };
    EXPECT_NEAR(slopeOf(makeNormals(reliefOf(4, 1, Wrap::Repeat, ramp)).levels[0], 0, 0).x, -1, 1e-6);
    EXPECT_NEAR(slopeOf(makeNormals(reliefOf(4, 1, Wrap::Clamp, ramp)).levels[0], 0, 0).x, 0.5, 1e-6);
    EXPECT_NEAR(slopeOf(makeNormals(reliefOf(4, 1, Wrap::Mirror, ramp)).levels[0], 0, 0).x, 0.5, 1e-6);
}

TEST(Normals, BesideHolesSlopesAreOneSidedAndHolesCountNothing) {
    HeightMap map = reliefOf(8, 8, Wrap::Clamp, [](int x, int y) { return x * x + y; });
    for (int y = 0; y < 8; ++y) map.heights.at(4, y, 0) = std::nanf("");
    const NormalMap normals = makeNormals(map);
    EXPECT_NEAR(slopeOf(normals.levels[0], 3, 3).x, 5, 1e-5) << "9 − 4";
    EXPECT_NEAR(slopeOf(normals.levels[0], 5, 3).x, 11, 1e-5) << "36 − 25";
    EXPECT_EQ(normals.levels[0].rgb(4, 3), Vec3(0, 0, 1));
    EXPECT_NEAR(slopeOf(normals.levels[1], 2, 1).x, 11, 1e-5) << "texels 4 and 5: the hole does not flatten it";
    HeightMap lonely = reliefOf(3, 3, Wrap::Clamp, [](int, int) { return NAN; });
    lonely.heights.at(1, 1, 0) = 5;
    for (const Image& level : makeNormals(lonely).levels) EXPECT_EQ(level.rgb(0, 0), Vec3(0, 0, 1));
}

TEST(Normals, SpikeAndStepAndHugeAndTinyHeightsAreUnitAndFinite) {
    for (const double size : {1e-6, 1.0, 1e6}) {
        const auto spike = [&](int x, int y) { return x == 5 && y == 5 ? size : 0; };
        const auto step = [&](int x, int) { return x < 5 ? size : 0; };
        for (const HeightMap& map : {reliefOf(11, 11, Wrap::Repeat, spike), reliefOf(11, 11, Wrap::Mirror, step)})
            for (const Image& level : makeNormals(map, {.roughness = true}).levels)
                for (int y = 0; y < level.height(); ++y)
                    for (int x = 0; x < level.width(); ++x) {
                        EXPECT_NEAR(glm::length(level.rgb(x, y)), 1, 1e-6);
                        EXPECT_TRUE(std::isfinite(level.at(x, y, 3)));
                    }
    }
}

TEST(Normals, SameBitsForAnyThreadCount) {
    const HeightMap map = reliefOf(33, 47, Wrap::Mirror, rough);
    const NormalMap one = makeNormals(map, {.roughness = true, .threads = 1});
    const NormalMap many = makeNormals(map, {.roughness = true, .threads = 7});
    for (std::size_t i = 0; i < one.levels.size(); ++i) EXPECT_EQ(one.levels[i].data(), many.levels[i].data());
    EXPECT_EQ(makeNormals(map, {.levels = false}).levels.size(), 1u);
    EXPECT_THROW(makeNormals({}), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
