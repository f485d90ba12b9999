#include "factorize/measured/grid_warp.hpp"

#include <gtest/gtest.h>

#include "core/sampling.hpp"

namespace nacre {
namespace {

/// Two slices: density (1 + x)(1 + 2y), and a rough one with an empty corner.
GridWarp twoSlices() {
    SlicedGrid grid{9, 17, {}};
    for (int slice = 0; slice < 2; ++slice)
        for (int y = 0; y < 17; ++y)
            for (int x = 0; x < 9; ++x) {
                const double px = x / 8.0, py = y / 16.0;
                const double rough = x + y < 8 ? 0 : radicalInverse(static_cast<unsigned>(1 + x + 9 * y), 3);
                grid.values.push_back(static_cast<float>(slice == 0 ? (1 + px) * (1 + 2 * py) : rough));
            }
    GridWarp warp = makeGridWarp(grid);
    EXPECT_FALSE(warp.emptySlice);
    return warp;
}

constexpr double kSingle = 2e-6;  // the cumulative sums are stored in single precision

TEST(GridWarp, BilinearDensityHasClosedForm) {
    const GridWarp warp = twoSlices();
    SliceBlend first;
    first.count = 1;
    first.weight[0] = 1;
    for (double x = 0; x <= 1; x += 0.03125)
        for (double y = 0; y <= 1; y += 0.0390625) {
            const Vec2 u = toUniform(warp, first, {x, y});
            EXPECT_NEAR(u.x, (x + x * x / 2) / 1.5, kSingle) << x << ' ' << y;
            EXPECT_NEAR(u.y, (y + y * y) / 2, kSingle) << x << ' ' << y;
        }
}

TEST(GridWarp, BlendedDensityBecomesUniform) {  // ∫ g(u(x)) p(x) dx = ∫ g(u) du for the blended density p
    const GridWarp warp = twoSlices();
    SliceBlend blend;
    blend.count = 2;
    blend.slice = {0, 1, 0, 0};
    blend.weight = {0.3f, 0.7f, 0, 0};
    constexpr int kSteps = 512;
    std::array<double, 6> moments{};
    double total = 0;
    for (int j = 0; j < kSteps; ++j)
        for (int i = 0; i < kSteps; ++i) {
            const Vec2 at((i + 0.5) / kSteps, (j + 0.5) / kSteps);
            const Vec2 u = toUniform(warp, blend, at);
            const double p = 0.3 * interpolate(warp.density, 0, at) + 0.7 * interpolate(warp.density, 1, at);
            const std::array<double, 6> g = {u.x,       u.y,       u.x * u.y,
                                             u.x * u.x, u.y * u.y, u.x > 0.5 && u.y < 0.25 ? 1.0 : 0.0};
            for (std::size_t k = 0; k < g.size(); ++k) moments[k] += p * g[k];
            total += p;
        }
    const std::array<double, 6> expected = {1.0 / 2, 1.0 / 2, 1.0 / 4, 1.0 / 3, 1.0 / 3, 1.0 / 8};
    constexpr double kMidpoint = 1e-3;  // 512² points; the indicator's edge is the worst
    for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_NEAR(moments[k] / total, expected[k], kMidpoint) << k;
}

TEST(GridWarp, EmptySlicesAreNamedAndEmptyRowsStayFinite) {
    EXPECT_EQ(makeGridWarp({2, 2, {1, 1, 1, 1, 0, 0, 0, 0}}).emptySlice.value(), 1u);
    const GridWarp warp = makeGridWarp({2, 3, {0, 0, 0, 0, 1, 1}});  // nothing below the middle row
    SliceBlend only;
    only.count = 1;
    only.weight[0] = 1;
    EXPECT_EQ(toUniform(warp, only, {0.7, 0.2}), Vec2(0, 0));
    EXPECT_NEAR(toUniform(warp, only, {0.7, 0.9}).x, 0.7, kSingle);
}

TEST(GridWarp, BlendIsLinearBetweenAndConstantBeyond) {
    const std::vector<float> one = {0}, four = {0, 1, 2, 4};
    SliceBlend blend = blendSlices(one, four, 99, 3);
    EXPECT_EQ(blend.count, 2);
    EXPECT_EQ(blend.slice[0], 2u);
    EXPECT_EQ(blend.slice[1], 3u);
    EXPECT_FLOAT_EQ(blend.weight[0], 0.5f);
    EXPECT_EQ(blendSlices(four, four, -1, 9).slice[0], 3u);
    EXPECT_EQ(blendSlices(four, four, -1, 9).count, 1);
    blend = blendSlices(four, four, 0.25, 3);
    EXPECT_EQ(blend.count, 4);
    EXPECT_FLOAT_EQ(blend.weight[0] + blend.weight[1] + blend.weight[2] + blend.weight[3], 1.0f);
    EXPECT_FLOAT_EQ(blend.weight[0], 0.75f * 0.5f);
}

}  // namespace
}  // namespace nacre
