// Images, and that sampleBilinear is GL_LINEAR with GL_CLAMP_TO_EDGE.
#include "core/image.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"

namespace nacre {
namespace {

Image plane(int width, int height) {  // value = x + 10 y at texel centres
    Image image(width, height, 1);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image.at(x, y, 0) = static_cast<float>(x) + 10.0f * static_cast<float>(y);
    return image;
}

TEST(Image, RejectsBadSizes) {
    EXPECT_THROW(Image(0, 1, 1), std::invalid_argument);
    EXPECT_THROW(Image(1, -1, 1), std::invalid_argument);
    EXPECT_THROW(Image(1, 1, 0), std::invalid_argument);
    EXPECT_THROW(Image(1, 1, 5), std::invalid_argument);
    EXPECT_TRUE(Image().empty());
}

TEST(Image, StartsBlackAndKeepsChannelsInterleaved) {
    Image image(2, 3, 4);
    EXPECT_EQ(image.data(), std::vector<float>(24, 0.0f));
    image.setRgb(1, 2, {1, 2, 3});
    EXPECT_EQ(image.data()[(2 * 2 + 1) * 4 + 2], 3.0f);
    EXPECT_EQ(image.rgb(1, 2), Rgb(1, 2, 3));
}

TEST(Image, OneChannelRepeatsAsGrey) {
    Image image(1, 1, 1);
    image.setRgb(0, 0, {0.5, 9, 9});
    EXPECT_EQ(image.rgb(0, 0), Rgb(0.5));
}

TEST(SampleBilinear, TexelCentresReturnTexels) {
    const Image image = plane(4, 3);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 4; ++x)
            EXPECT_NEAR(sampleBilinear(image, (static_cast<float>(x) + 0.5f) / 4, (static_cast<float>(y) + 0.5f) / 3).x,
                        image.at(x, y, 0), 1e-5f);  // (y + 0.5)/3 is off by half an ulp, times 10
}

TEST(SampleBilinear, LinearBetweenCentres) {
    const Image image = plane(4, 4);
    for (const float u : {0.2f, 0.5f, 0.8f})
        for (const float v : {0.2f, 0.45f, 0.87f})
            EXPECT_NEAR(sampleBilinear(image, u, v).x, u * 4 - 0.5f + 10 * (v * 4 - 0.5f), 1e-5f);
}

TEST(SampleBilinear, OuterHalfTexelIsClampedToEdge) {
    const Image image = plane(4, 4);
    EXPECT_EQ(sampleBilinear(image, 0, 0).x, 0.0f);
    EXPECT_EQ(sampleBilinear(image, 0.124f, 0.01f).x, 0.0f);
    EXPECT_EQ(sampleBilinear(image, 1, 1).x, 33.0f);
    EXPECT_EQ(sampleBilinear(image, 0.876f, 1).x, 33.0f);
    EXPECT_EQ(sampleBilinear(image, -5, 7).x, 30.0f) << "outside [0, 1] too";
}

TEST(SampleBilinear, SingleTexelIsConstant) {
    Image image(1, 1, 3);
    image.setRgb(0, 0, {1, 2, 3});
    EXPECT_EQ(sampleBilinear(image, 0.1f, 0.9f), glm::vec4(1, 2, 3, 1));
}

TEST(SampleBilinear, MissingChannelsReadAsOpenGLReadsThem) {  // R → (r, 0, 0, 1), RG → (r, g, 0, 1)
    Image one(1, 1, 1), two(1, 1, 2), four(1, 1, 4);
    one.data() = {7};
    two.data() = {7, 8};
    four.data() = {7, 8, 9, 10};
    EXPECT_EQ(sampleBilinear(one, 0, 0), glm::vec4(7, 0, 0, 1));
    EXPECT_EQ(sampleBilinear(two, 0, 0), glm::vec4(7, 8, 0, 1));
    EXPECT_EQ(sampleBilinear(four, 0, 0), glm::vec4(7, 8, 9, 10));
}

TEST(SampleBilinear, ConstantImageIsConstantToTheBit) {
    Image image(5, 7, 2);
    for (float& v : image.data()) v = 0.1f;
    for (int i = 0; i <= 100; ++i) {
        const float u = static_cast<float>(i) / 100;
        EXPECT_EQ(sampleBilinear(image, u, 1 - u), glm::vec4(0.1f, 0.1f, 0, 1));
    }
}

}  // namespace
}  // namespace nacre
