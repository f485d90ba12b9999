#include "bump/height_map.hpp"

#include <gtest/gtest.h>

namespace nacre {
namespace {

HeightMap ramp(int width, int height, Wrap wrap) {
    HeightMap map{Image(width, height, 1), wrap};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) map.heights.at(x, y, 0) = static_cast<float>(x + 10 * y);
    return map;
}

TEST(HeightMap, WrapsAnyIndex) {
    const int repeat[] = {0, 1, 2, 0, 1, 2, 0}, clamp[] = {0, 0, 0, 0, 1, 2, 2}, mirror[] = {2, 1, 0, 0, 1, 2, 2};
    for (int i = -3; i <= 3; ++i) {
        EXPECT_EQ(wrapIndex(i, 3, Wrap::Repeat), repeat[i + 3]) << i;
        EXPECT_EQ(wrapIndex(i, 3, Wrap::Clamp), clamp[i + 3]) << i;
        EXPECT_EQ(wrapIndex(i, 3, Wrap::Mirror), mirror[i + 3]) << i;
    }
    EXPECT_EQ(wrapIndex(3 * 7 + 1, 3, Wrap::Repeat), 1);
    EXPECT_EQ(wrapIndex(6 * 7 + 4, 3, Wrap::Mirror), 1);
}

TEST(HeightMap, HeightIsBilinearBetweenTexelCentres) {
    const HeightMap map = ramp(4, 3, Wrap::Clamp);
    EXPECT_DOUBLE_EQ(heightAt(map, {0.5, 0.5}), 0);
    EXPECT_DOUBLE_EQ(heightAt(map, {1.75, 1.25}), 1.25 + 7.5);
    EXPECT_DOUBLE_EQ(heightAt(map, {-5, 0.5}), 0);
    EXPECT_DOUBLE_EQ(heightAt(ramp(4, 3, Wrap::Repeat), {4.0, 0.5}), 1.5) << "half-way from column 3 to column 0";
}

TEST(HeightMap, HolesHaveNoSurface) {
    HeightMap map = ramp(4, 3, Wrap::Clamp);
    map.heights.at(1, 1, 0) = std::nanf("");
    EXPECT_TRUE(std::isnan(heightAt(map, {1.2, 1.2})));
    EXPECT_DOUBLE_EQ(heightAt(map, {2.5, 1.5}), 12);
    EXPECT_DOUBLE_EQ(heightRange(map).high, 23);
}

TEST(HeightMap, NamesAndValidation) {
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror}) EXPECT_EQ(wrapFromString(toString(wrap)), wrap);
    EXPECT_THROW(wrapFromString("tile"), std::invalid_argument);
    EXPECT_THROW(validateHeightMap({}), std::invalid_argument);
    EXPECT_THROW(validateHeightMap({Image(2, 2, 3)}), std::invalid_argument);
    HeightMap map = ramp(2, 2, Wrap::Repeat);
    map.heights.at(1, 0, 0) = std::numeric_limits<float>::infinity();
    EXPECT_THROW(validateHeightMap(map), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
