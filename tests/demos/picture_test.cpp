#include "demos/picture.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "reference/tone.hpp"

namespace nacre {
namespace {

Image ramp(int width, int height, int channels) {
    Image image(width, height, channels);
    for (std::size_t i = 0; i < image.data().size(); ++i) image.data()[i] = static_cast<float>(i);
    return image;
}

TEST(Picture, HalvedIsTheMeanOfFour) {
    const Image half = halved(ramp(4, 2, 2));
    ASSERT_EQ(half.width(), 2);
    ASSERT_EQ(half.height(), 1);
    EXPECT_FLOAT_EQ(half.at(0, 0, 0), (0 + 2 + 8 + 10) / 4.0f);
    EXPECT_FLOAT_EQ(half.at(1, 0, 1), (5 + 7 + 13 + 15) / 4.0f);
    EXPECT_THROW(halved(ramp(3, 2, 1)), std::invalid_argument);
}

TEST(Picture, OverFillsWhatIsNotCovered) {
    Image image(2, 1, 3), coverage(2, 1, 1);
    image.setRgb(0, 0, {1, 2, 3});
    coverage.at(0, 0, 0) = 1;
    image.setRgb(1, 0, {0.5, 0, 0});
    coverage.at(1, 0, 0) = 0.25f;
    const Image out = over(image, coverage, 2);
    EXPECT_EQ(out.rgb(0, 0), Rgb(1, 2, 3));
    EXPECT_EQ(out.rgb(1, 0), Rgb(2, 1.5, 1.5));
    EXPECT_THROW(over(image, Image(1, 1, 1), 0), std::invalid_argument);
}

TEST(Picture, QuantileLeavesTheMaskOutAndCountsFromTheTop) {
    Image a(10, 1, 3), b(10, 1, 3), mask(10, 1, 1);
    for (int x = 0; x < 10; ++x) mask.at(x, 0, 0) = x < 9 ? 1 : 0.5f;
    for (int x = 0; x < 10; ++x) a.setRgb(x, 0, {0, x == 4 ? 2 : 0, 0});
    a.setRgb(9, 0, {9, 9, 9});
    EXPECT_DOUBLE_EQ(differenceQuantile(a, b, 2, mask, 0), 1);
    EXPECT_DOUBLE_EQ(differenceQuantile(a, b, 4, mask, 0), srgbEncode(0.5));
    EXPECT_DOUBLE_EQ(differenceQuantile(a, b, 2, mask, 0.5), 0);
    EXPECT_DOUBLE_EQ(differenceQuantile(a, b, 2, Image(10, 1, 1), 0), 0);
}

TEST(Picture, ScalesAreRoundNumbers) {
    EXPECT_DOUBLE_EQ(roundUpScale(0.0011), 0.002);
    EXPECT_DOUBLE_EQ(roundUpScale(0.3), 0.5);
    EXPECT_DOUBLE_EQ(roundUpScale(0.7), 1);
    EXPECT_DOUBLE_EQ(roundUpScale(5), 5);
    EXPECT_DOUBLE_EQ(roundUpScale(1e-3), 1e-3);
    EXPECT_THROW(roundUpScale(0), std::invalid_argument);
    EXPECT_THROW(roundUpScale(std::numeric_limits<double>::infinity()), std::invalid_argument);
}

TEST(Picture, EncodesPng) {
    const Picture picture = encodePicture("a.png", ramp(2, 2, 3), 1);
    EXPECT_EQ(picture.file, "a.png");
    ASSERT_GT(picture.png.size(), 8u);
    EXPECT_EQ(std::string(picture.png.begin() + 1, picture.png.begin() + 4), "PNG");
}

}  // namespace
}  // namespace nacre
