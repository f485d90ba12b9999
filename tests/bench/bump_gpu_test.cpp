#include "bench/bump_gpu.hpp"

#include <gtest/gtest.h>

#include "shading/context.hpp"

namespace nacre::bench {
namespace {

TEST(BumpGpu, ShadowsCostAShareOfAFrame) {
    const Context context;
    HeightMap map{Image(64, 64, 1), Wrap::Repeat};
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            map.heights.at(x, y, 0) = static_cast<float>(3 * std::sin(0.4 * x) * std::cos(0.3 * y));
    BumpMaps maps;
    maps.width = maps.height = 64;
    maps.normals = makeNormals(map);
    maps.ellipses = fitEllipses(map, {.directions = 16});
    ProgramLoader loader;
    BumpCost cost = bumpCost(loader, GpuBump(maps), {.pixels = 128, .repeats = 5});
    EXPECT_GT(cost.plainMs, 0);
    EXPECT_EQ(cost.horizon, 0) << "no horizons";
    EXPECT_EQ(cost.hardHorizon, 0);
    // Far apart: a loaded machine must not fail this. The bar itself, 1.6, is for the bench.
    for (const double ratio : {cost.smooth, cost.hardEllipse, cost.ellipse}) {
        EXPECT_GT(ratio, 0.1);
        EXPECT_LT(ratio, 10);
    }
    maps.horizons = makeHorizonMap(map, 8);
    cost = bumpCost(loader, GpuBump(maps), {.pixels = 128, .lights = 2, .repeats = 3});
    EXPECT_GT(cost.hardHorizon, 0.1);
    EXPECT_GT(cost.horizon, 0.1);
}

}  // namespace
}  // namespace nacre::bench
