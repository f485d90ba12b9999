// The errors of environments and tables, on maps whose error is known.
#include "reference/environment_error.hpp"

#include <gtest/gtest.h>

#include "reference/fresnel_error.hpp"

namespace nacre {
namespace {

EnvMap constant(int size, double value) {
    EnvMap map(EnvLayout::Cube, size);
    for (float& v : map.image.data()) v = static_cast<float>(value);
    return map;
}

TEST(MeasureEnvironment, OnePercentTooBrightIsOnePercent) {
    const EnvMap source = constant(8, 2);
    const EnvironmentTruth truth(source);
    const EnvironmentError e = measureEnvironment(constant(4, 2.02), truth, {LobeKind::Diffuse}, 50);
    for (const double figure : {e.rmse, e.p95, e.max, e.filteredRmse, e.filteredP95, e.filteredMax})
        EXPECT_NEAR(figure, 0.01, 1e-6);
    EXPECT_NEAR(e.mean, 2, 1e-6);
    EXPECT_EQ(e.samples, 50);
    EXPECT_EQ(measureEnvironment(constant(4, 2), truth, {LobeKind::Diffuse}, 50).max, 0);
}

TEST(MeasureEnvironment, BlackTruthCountsAbsolutely) {
    const EnvMap source = constant(4, 0);
    const EnvironmentTruth truth(source);
    EXPECT_NEAR(measureEnvironment(constant(4, 0.5), truth, {LobeKind::Phong, 3}, 20).rmse, 0.5, 1e-9);
}

TEST(EnvironmentTruth, LobeThatMissesEveryCentreTakesTheNearestTexel) {
    EnvMap source = constant(2, 1);
    source.image.setRgb(0, 0, Rgb(7));
    const EnvironmentTruth truth(source);
    const Vec3 r = glm::normalize(envTexelDirection(EnvLayout::Cube, 2, 0, 0) + Vec3(0.02, 0.01, 0));
    EXPECT_EQ(truth({LobeKind::Phong, 1e300}, r), Rgb(7));
}

TEST(MeasureFresnel, SeesAShiftedTable) {
    const FresnelIndex index{Rgb(1.5), Rgb(0)};
    AssetTexture table = bakeFresnelTable(index, 256, TexelFormat::Float);
    const double before = measureFresnel(table, index).maxAbs;
    for (float& v : table.image.data()) v += 0.1f;
    EXPECT_LT(before, 1e-3);
    EXPECT_NEAR(measureFresnel(table, index).rms, 0.1, 1e-3);
}

TEST(MeasureScaleBias, SeesAWrongTable) {
    AssetTexture table = bakeScaleBias(64, TexelFormat::Float);
    EXPECT_LT(measureScaleBias(table).maxAbs, 2e-3);
    for (float& v : table.image.data()) v += 0.05f;
    EXPECT_NEAR(measureScaleBias(table).rms, 0.05, 2e-3);
}

}  // namespace
}  // namespace nacre
