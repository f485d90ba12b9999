#include "reference/traced_samples.hpp"

#include <gtest/gtest.h>

#include "reference/traced_relief.hpp"

namespace nacre {
namespace {

TEST(TracedSamples, SequencesFillAPixelBetterThanRandomNumbers) {
    constexpr int kPoints = 256, kPixels = 200;
    double even = 0, random = 0;  // squared errors of the mean of x y, which is 1/4
    for (std::uint64_t pixel = 0; pixel < kPixels; ++pixel) {
        PixelSequence sequence(1, pixel, 0, 0), rest(1, pixel, 0, kPoints / 2);
        PixelRandom numbers(1, pixel, 0);
        double a = 0, b = 0;
        for (int i = 0; i < kPoints; ++i) {
            const Vec2 p = sequence(), q = numbers.pair();
            EXPECT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
            a += p.x * p.y / kPoints, b += q.x * q.y / kPoints;
            if (i >= kPoints / 2) {
                EXPECT_LT(glm::length(p - rest()), 1e-12) << "a sequence goes on where it was left";
            }
        }
        even += sqr(a - 0.25), random += sqr(b - 0.25);
    }
    EXPECT_LT(even, 0.05 * random);
    EXPECT_NEAR(random / kPixels, (1 / 9.0 - 1 / 16.0) / kPoints, 1e-4) << "independent ones: variance / points";
}

TEST(TracedSamples, FramesKeepAngles) {
    for (const Vec3& n : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), glm::normalize(Vec3(0.5, -0.4, 0.2))}) {
        const Vec3 d = glm::normalize(Vec3(0.3, -0.5, 0.4));
        EXPECT_NEAR(glm::dot(turnedTo(n, d), n), d.z, 1e-12);
        EXPECT_NEAR(glm::length(turnedTo(n, d)), 1, 1e-12);
    }
}

TEST(TracedSamples, LobesHaveTheirMeanCosine) {
    Lobe phong;
    phong.kind = LobeKind::Phong;
    phong.exponent = 20;
    PixelSequence next(1, 3, 0, 0);
    double sum = 0;
    for (int i = 0; i < 4000; ++i) sum += lobeSample(phong, {0, 0, 1}, next()).first.z / 4000;
    EXPECT_NEAR(sum, 21 / 22.0, 1e-3);  // (n + 1) / (n + 2)
    EXPECT_EQ(lobeSample(Lobe{.kind = LobeKind::Mirror}, {0, 1, 0}, {0.3, 0.7}).first, Vec3(0, 1, 0));
}

TEST(TracedRelief, NormalsOfASlopeAndOfMissingHeights) {
    HeightMap map{Image(4, 4, 1), Wrap::Clamp};
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) map.heights.at(x, y, 0) = static_cast<float>(x);
    EXPECT_LT(glm::length(patchNormal(map, {2, 2}) - glm::normalize(Vec3(-1, 0, 1))), 1e-6);
    map.heights.at(1, 1, 0) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(patchNormal(map, {2, 2}), Vec3(0, 0, 1));
}

/// A flat field reflects nothing to itself.
TEST(TracedRelief, AFlatFieldHasNoBounces) {
    const ReliefTruth flat(HeightMap{Image(8, 8, 1), Wrap::Repeat});
    EXPECT_EQ(bounced(flat, {}, {3, 3}, {0, 0, 1}, {0, 0, 1}, 64, {1, 0, 0, 0}, {1, 0, 0}), Rgb(0));
}

}  // namespace
}  // namespace nacre
