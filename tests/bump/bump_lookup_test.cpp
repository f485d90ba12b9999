// The lookups of a shader: filters with every wrap, lit or not, what is seen.
#include "bump/bump_lookup.hpp"

#include <gtest/gtest.h>

namespace nacre {
namespace {

Image row(std::vector<float> values) {
    Image out(static_cast<int>(values.size()), 1, 1);
    out.data() = std::move(values);
    return out;
}

BumpMaps mapsOf(int width, int height, Wrap wrap = Wrap::Repeat) {
    BumpMaps maps;
    maps.width = width;
    maps.height = height;
    maps.wrap = wrap;
    return maps;
}

TEST(SampleWrapped, IsTheGpusFilterWithItsWrap) {
    const Image image = row({1, 2, 4, 8});
    const auto at = [&](double u, Wrap wrap) { return sampleWrapped(image, u, 0.3, wrap)[0]; };
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror}) {
        for (int x = 0; x < 4; ++x) EXPECT_EQ(at((x + 0.5) / 4, wrap), image.at(x, 0, 0));
        EXPECT_EQ(at(0.5, wrap), 3);
    }
    EXPECT_EQ(at(0, Wrap::Repeat), 4.5f);
    EXPECT_EQ(at(-0.125, Wrap::Repeat), 8);
    EXPECT_EQ(at(7.125, Wrap::Repeat), 1);
    EXPECT_EQ(at(-3, Wrap::Clamp), 1);
    EXPECT_EQ(at(1e30, Wrap::Clamp), 8);
    EXPECT_EQ(at(1, Wrap::Mirror), 8);
    EXPECT_EQ(at(1.375, Wrap::Mirror), 4);
    EXPECT_EQ(at(-0.375, Wrap::Mirror), 2);
    EXPECT_EQ(sampleWrapped(row({7}), 0.9, -5, Wrap::Repeat)[0], 7) << "one texel";
}

TEST(LitMargin, EllipsesAreBlendedBeforeTheTest) {
    BumpMaps maps = mapsOf(2, 1, Wrap::Clamp);
    maps.ellipses = EllipseMap{Image(2, 1, 3), Image(2, 1, 3)};  // all lit
    maps.ellipses->offset.at(1, 0, 0) = 2;                       // all dark
    const Vec3 light = glm::normalize(Vec3(0.3, -0.2, 1));
    EXPECT_GE(litMargin(maps, 0.25, 0.5, light), 0);
    EXPECT_LT(litMargin(maps, 0.75, 0.5, light), 0);
    EXPECT_NEAR(litMargin(maps, 0.5, 0.5, light), 0, 1e-6) << "half-way: |o| = 1";
    EXPECT_LT(litMargin(maps, 0.25, 0.5, {0.6, 0, -0.8}), 0) << "from below";
}

TEST(LitMargin, HorizonsAreLinearBetweenAzimuths) {
    BumpMaps maps = mapsOf(1, 1);
    maps.horizons = HorizonMap{};
    for (int k = 0; k < 4; ++k) maps.horizons->elevation.push_back(row({k == 0 ? 0.8f : 0.0f}));
    const auto light = [](double azimuth, double elevation) {
        return Vec3(std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
                    std::sin(elevation));
    };
    EXPECT_NEAR(litMargin(maps, 0.5, 0.5, light(0, 0.5)), -0.3, 1e-6);
    EXPECT_NEAR(litMargin(maps, 0.5, 0.5, light(kPi / 4, 0.5)), 0.1, 1e-6);
    EXPECT_NEAR(litMargin(maps, 0.5, 0.5, light(-kPi / 8, 0.5)), -0.1, 1e-6) << "round to the last azimuth";
    EXPECT_NEAR(litMargin(maps, 0.5, 0.5, light(kPi, 0.5)), 0.5, 1e-6);
    EXPECT_EQ(litMargin(maps, 0.5, 0.5, {-1, 0, 0}), 0) << "a light in the horizon plane";
    EXPECT_THROW(litMargin(mapsOf(1, 1), 0, 0, {0, 0, 1}), std::invalid_argument);
}

TEST(SeenFrom, NearestTexelAndDirection) {
    BumpMaps maps = mapsOf(4, 2);
    maps.scatter = ScatterMap{{Vec3(0.6, 0, 0.8), Vec3(0, 1, 0)}, {1, 1}, {Image(4, 2, 1), Image(4, 2, 1)}};
    for (float& d : maps.scatter->distance[0].data()) d = -1;
    maps.scatter->distance[0].at(3, 0, 0) = 2;
    const Seen seen = seenFrom(maps, 0.8, 0.3, glm::normalize(Vec3(0.6, 0.1, 0.8)));
    EXPECT_TRUE(seen.hit);
    EXPECT_EQ(seen.direction, 0u);
    EXPECT_NEAR(seen.uv.x, 5.5 / 4, 1e-12) << "beyond the border";
    EXPECT_NEAR(seen.uv.y, 0.25, 1e-12);
    EXPECT_FALSE(seenFrom(maps, 0.1, 0.3, {0.6, 0, 0.8}).hit);
    EXPECT_EQ(nearestDirection(*maps.scatter, {0, 0.8, 0.6}), 1u);
    EXPECT_TRUE(seenFrom(maps, -0.01, 1.3, {0.6, 0, 0.8}).hit) << "repeats";
    EXPECT_THROW(seenFrom(mapsOf(1, 1), 0, 0, {0, 0, 1}), std::invalid_argument);
}

TEST(NormalAt, IsUnitBetweenTexels) {
    BumpMaps maps = mapsOf(4, 4);
    HeightMap map{Image(4, 4, 1)};
    map.heights.at(1, 2, 0) = 3;
    maps.normals = makeNormals(map);
    for (const double u : {0.1, 0.3, 0.9}) EXPECT_NEAR(glm::length(normalAt(maps, u, 0.6)), 1, 1e-9);
    EXPECT_NEAR(glm::length(normalAt(maps, 0.625, 0.625) - maps.normals->levels[0].rgb(2, 2)), 0, 1e-6);
    EXPECT_THROW(normalAt(mapsOf(1, 1), 0, 0), std::invalid_argument);
}

TEST(BumpLookup, MirroredTilesAreTurnedOver) {
    BumpMaps maps = mapsOf(4, 4, Wrap::Mirror);
    HeightMap map{Image(4, 4, 1), Wrap::Mirror};
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) map.heights.at(x, y, 0) = static_cast<float>(0.3 * x * x + 0.2 * y);
    maps.normals = makeNormals(map, {.levels = false});
    maps.horizons = makeHorizonMap(map, 4);
    maps.scatter = ScatterMap{{Vec3(0.6, 0, 0.8), Vec3(-0.6, 0, 0.8)}, {1, 1}, {Image(4, 4, 1), Image(4, 4, 1)}};
    for (float& d : maps.scatter->distance[0].data()) d = -1;
    const double u = 1.5 / 4, v = 1.5 / 4;
    const Vec3 own = normalAt(maps, u, v), light = glm::normalize(Vec3(1, 0, 0.8));
    EXPECT_LT(own.x, -0.3);
    EXPECT_LT(litMargin(maps, u, v, light), -0.1);
    EXPECT_GT(litMargin(maps, u, v, light * Vec3(-1, 1, 1)), 0.1);
    EXPECT_FALSE(seenFrom(maps, u, v, {0.6, 0, 0.8}).hit);
    for (const int tilesX : {-2, -1, 0, 1, 2})
        for (const int tilesY : {-1, 0, 3}) {
            const bool overX = tilesX % 2 != 0, overY = tilesY % 2 != 0;
            const double there = tilesX + (overX ? 1 - u : u), below = tilesY + (overY ? 1 - v : v);
            const Vec3 side(overX ? -1 : 1, overY ? -1 : 1, 1);
            EXPECT_LT(glm::length(normalAt(maps, there, below) - own * side), 1e-6) << tilesX << ' ' << tilesY;
            EXPECT_NEAR(litMargin(maps, there, below, light * side), litMargin(maps, u, v, light), 1e-6) << tilesX;
            EXPECT_FALSE(seenFrom(maps, there, below, Vec3(0.6, 0, 0.8) * side).hit) << tilesX;
        }
}

}  // namespace
}  // namespace nacre
