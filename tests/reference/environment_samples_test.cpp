// The truth of an environment drawn once, for many maps.
#include <gtest/gtest.h>

#include "reference/environment_error.hpp"

namespace nacre {
namespace {

EnvMap waves(EnvLayout layout, int size, double shift) {
    EnvMap map(layout, size);
    for (int y = 0; y < map.image.height(); ++y)
        for (int x = 0; x < map.image.width(); ++x) {
            const Vec3 d = envTexelDirection(layout, size, x, y);
            map.image.setRgb(x, y, Rgb(2 + std::sin(5 * d.x + shift), 1 + d.y, 1.5 + d.z));
        }
    return map;
}

TEST(EnvironmentSamples, GiveTheErrorThatIsMeasuredAtOnce) {
    const EnvironmentTruth truth(waves(EnvLayout::Cube, 8, 0));
    const Lobe lobe{LobeKind::Phong, 20};
    for (const EnvLayout layout : {EnvLayout::Cube, EnvLayout::DualParaboloid}) {
        const EnvironmentSamples samples = drawEnvironmentSamples(layout, 6, truth, lobe, 40, 7);
        ASSERT_EQ(samples.texels.size(), 40u);
        ASSERT_EQ(samples.directions.size(), 80u);
        for (std::size_t i = 0; i < 40; ++i)
            EXPECT_EQ(samples.directions[i], envTexelDirection(layout, 6, samples.texels[i].x, samples.texels[i].y));
        for (const double shift : {0.0, 0.4}) {
            const EnvMap map = waves(layout, 6, shift);
            const EnvironmentError a = measureEnvironment(map, samples);
            const EnvironmentError b = measureEnvironment(map, truth, lobe, 40, 7);
            EXPECT_GT(a.rmse, 0.01);
            EXPECT_EQ(a.rmse, b.rmse);
            EXPECT_EQ(a.filteredRmse, b.filteredRmse);
            EXPECT_EQ(a.mean, b.mean);
            EXPECT_EQ(a.samples, 40);
        }
    }
}

TEST(EnvironmentSamples, BelongToOneLayoutAndSize) {
    const EnvironmentTruth truth(waves(EnvLayout::Cube, 4, 0));
    const EnvironmentSamples samples = drawEnvironmentSamples(EnvLayout::Cube, 4, truth, {LobeKind::Diffuse}, 3);
    EXPECT_THROW(measureEnvironment(EnvMap(EnvLayout::Cube, 5), samples), std::invalid_argument);
    EXPECT_THROW(measureEnvironment(EnvMap(EnvLayout::Octahedral, 4), samples), std::invalid_argument);
    EXPECT_THROW(drawEnvironmentSamples(EnvLayout::Cube, 4, truth, {LobeKind::Diffuse}, 0), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
