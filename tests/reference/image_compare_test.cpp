#include "reference/image_compare.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "reference/tone.hpp"

using namespace nacre;

namespace {

constexpr double kSinglePrecision = 1e-5;  // pictures hold floats; relative, of decibels absolute

Image flat(const Rgb& value, int width = 4, int height = 3) {
    Image out(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) out.setRgb(x, y, value);
    return out;
}

/// 1 in the left half.
Image leftHalf(int width = 4, int height = 3) {
    Image out(width, height, 1);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width / 2; ++x) out.at(x, y, 0) = 1;
    return out;
}

}  // namespace

TEST(ImageCompare, FlatPicturesHaveClosedForms) {
    const ImageDifference d = compareImages(flat(Rgb(0.5, 1, 1)), flat(Rgb(1)), 2);
    EXPECT_NEAR(d.psnrLinear, -10 * std::log10(sqr(0.25) / 3), kSinglePrecision);
    EXPECT_NEAR(d.psnrSrgb, -10 * std::log10(sqr(srgbEncode(0.25) - srgbEncode(0.5)) / 3), kSinglePrecision);
    EXPECT_NEAR(d.relative, 0.5 / std::sqrt(3), kSinglePrecision);
    EXPECT_NEAR(compareImages(flat(Rgb(1.5, 2, 1)), flat(Rgb(2, 2, 1)), 2).rmsOverMean, 0.5 / std::sqrt(3) / (5.0 / 3),
                kSinglePrecision);
    EXPECT_NEAR(d.maxAbs, 0.5, kSinglePrecision);
    EXPECT_NEAR(d.meanAbs, 0.5 / 3, kSinglePrecision);
    EXPECT_EQ(d.pixels, 12u);
}

TEST(ImageCompare, IdenticalPictures) {
    const ImageDifference d = compareImages(flat(Rgb(0)), flat(Rgb(0)), 1);
    EXPECT_EQ(d.psnrLinear, 200);
    EXPECT_EQ(d.psnrSrgb, 200);
    EXPECT_EQ(d.relative + d.rmsOverMean + d.maxAbs + d.meanAbs, 0);
}

TEST(ImageCompare, OnlyPixelsInsideTheMaskCount) {
    Image a = flat(Rgb(1));
    a.setRgb(3, 1, Rgb(std::nan("")));
    const ImageDifference inside = compareImages(a, flat(Rgb(1)), 1, leftHalf());
    EXPECT_EQ(inside.pixels, 6u);
    EXPECT_EQ(inside.nonFinite, 0u);
    EXPECT_EQ(inside.maxAbs, 0);
    const ImageDifference all = compareImages(a, flat(Rgb(1)), 1);
    EXPECT_EQ(all.nonFinite, 1u);
    EXPECT_EQ(all.psnrSrgb, -std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::isinf(all.relative) && std::isinf(all.maxAbs) && std::isinf(all.psnrLinear));
}

TEST(ImageCompare, WhiteIsOfLitPixelsInsideTheMask) {
    Image truth = flat(Rgb(2));
    truth.setRgb(0, 0, Rgb(0));
    EXPECT_NEAR(pictureWhite(truth), 3, kSinglePrecision);
    EXPECT_NEAR(pictureWhite(flat(Rgb(1e-3))), 0.05, kSinglePrecision);
    EXPECT_NEAR(pictureWhite(flat(Rgb(0))), 0.05, kSinglePrecision);
    Image ramp(4, 3, 3);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 4; ++x) ramp.setRgb(x, y, Rgb(x < 2 ? 1 : 100));
    EXPECT_NEAR(pictureWhite(ramp, leftHalf()), 1.5, kSinglePrecision);
}

TEST(ImageCompare, BrokenInputIsRefused) {
    const Image a = flat(Rgb(1)), small = flat(Rgb(1), 3, 3);
    EXPECT_THROW(compareImages(a, small, 1), std::invalid_argument);
    EXPECT_THROW(compareImages(a, a, 1, leftHalf(3, 3)), std::invalid_argument);
    EXPECT_THROW(compareImages(a, a, 0), std::invalid_argument);
    EXPECT_THROW(compareImages(a, a, 1, Image(4, 3, 1)), std::invalid_argument);  // nothing inside
    EXPECT_THROW(compareImages(a, flat(Rgb(std::nan(""))), 1), std::invalid_argument);
    EXPECT_THROW(differenceImage(a, small, 1, 1), std::invalid_argument);
    EXPECT_THROW(differenceImage(a, a, 1, 0), std::invalid_argument);
    EXPECT_THROW(pictureWhite(a, leftHalf(3, 3)), std::invalid_argument);
}

TEST(ImageCompare, DifferenceColorsRiseInLuminance) {
    EXPECT_EQ(differenceColor(-1), Rgb(0));
    EXPECT_EQ(differenceColor(2), Rgb(1));
    for (int i = 0; i < 100; ++i)
        EXPECT_GT(luminance(differenceColor((i + 1) / 100.)), luminance(differenceColor(i / 100.))) << i;
}

TEST(ImageCompare, DifferencePictureShowsScaleMaskAndBadPixels) {
    Image a = flat(Rgb(1));
    a.setRgb(0, 0, Rgb(1, 0, 1));  // a full difference in one channel
    a.setRgb(1, 0, Rgb(std::numeric_limits<double>::quiet_NaN()));
    const Image d = differenceImage(a, flat(Rgb(1)), 1, 1, leftHalf());
    EXPECT_NEAR(d.at(0, 0, 1), 1, kSinglePrecision);
    EXPECT_EQ(d.rgb(1, 0), Rgb(0, 1, 0));
    EXPECT_EQ(d.rgb(1, 1), Rgb(0));
    EXPECT_NEAR(d.at(3, 0, 0), 0.2, kSinglePrecision);
    EXPECT_LT(differenceImage(a, flat(Rgb(1)), 1, 2).at(0, 0, 1), 0.5);  // half of a scale of 2
}
