#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/environment_bars.hpp"
#include "bench/environment_gpu.hpp"
#include "bench/environment_naive.hpp"
#include "bench/environment_report.hpp"
#include "bench/report.hpp"
#include "core/error.hpp"

using namespace nacre;
using namespace nacre::bench;
using ::testing::HasSubstr;

namespace {

/// A chain at the usual tolerance whose levels all have this error.
EnvironmentMeasurement measurement(Chain chain, int size, double rmse, double seconds) {
    EnvironmentMeasurement m;
    m.surrounding = "yard";
    m.chain = chain;
    m.sourceSize = size;
    m.method = "nacre";
    m.setting = "tolerance 0.0006";
    m.usual = true;
    m.cpuSeconds = seconds;
    m.directSeconds = 1000;
    for (const PrefilterLevel& level : chainLevels(chain, size)) {
        m.levels.push_back({level, {}});
        m.levels.back().error.rmse = rmse;
    }
    return m;
}

}  // namespace

TEST(EnvironmentChains, AreThePromisedOnes) {
    const auto phong = chainLevels(Chain::Phong, 256);
    ASSERT_EQ(phong.size(), 8u);
    EXPECT_DOUBLE_EQ(phong[0].lobe.exponent, 2048);
    EXPECT_EQ(phong[7].size, 2);
    EXPECT_NEAR(phong[4].lobe.exponent, 64, 1e-9);
    EXPECT_EQ(chainLevels(Chain::Phong, 512).size(), 9u);
    EXPECT_NEAR(chainLevels(Chain::Phong, 512)[8].lobe.exponent, 2, 1e-9);
    const auto ggx = chainLevels(Chain::Ggx, 256);
    ASSERT_EQ(ggx.size(), 5u);
    EXPECT_EQ(ggx[0].lobe.kind, LobeKind::Mirror);
    EXPECT_NEAR(ggx[1].lobe.alpha, 0.018, 1e-4);
    EXPECT_NEAR(ggx[2].lobe.alpha, 0.0858, 1e-4);
    EXPECT_NEAR(ggx[3].lobe.alpha, 0.25, 1e-12);
    EXPECT_EQ(ggx[4].lobe.alpha, 1);
    EXPECT_EQ(ggx[4].size, 16);
    EXPECT_EQ(chainLevels(Chain::Diffuse, 256)[0].size, 64);
    EXPECT_THROW(chainLevels(Chain::Phong, 8), std::invalid_argument);
}

TEST(EnvironmentBars, RowsAndLimits) {
    const auto bars =
        chainBars({measurement(Chain::Phong, 256, 0.0031, 0.5), measurement(Chain::Phong, 512, 0.001, 3.1),
                   measurement(Chain::Ggx, 256, 0.006, 1), measurement(Chain::Diffuse, 256, 0.0009, 0.1)});
    ASSERT_EQ(bars.size(), 9u);
    const std::vector<double> limits = {0.003, 0.6, 0.003, 3, 0.005, 0.01, 1, 0.001, 0.1};
    const std::vector<bool> passes = {false, true, true, false, false, true, true, true, true};
    for (std::size_t i = 0; i < bars.size(); ++i) {
        EXPECT_TRUE(bars[i].measured) << bars[i].what;
        EXPECT_EQ(bars[i].limit, limits[i]) << bars[i].what;
        EXPECT_EQ(bars[i].pass(), passes[i]) << bars[i].what;
        EXPECT_THAT(bars[i].worst, HasSubstr("yard"));
    }
    EXPECT_THAT(barTable(bars), HasSubstr("GGX chain, 256 -> 16, 5 levels"));
}

TEST(EnvironmentBars, OtherMethodsAndSettingsDontCount) {
    EnvironmentMeasurement other = measurement(Chain::Phong, 256, 0, 0);
    other.method = "importance";
    EnvironmentMeasurement loose = measurement(Chain::Phong, 256, 0, 0);
    loose.usual = false;
    for (const Bar& bar : chainBars({other, loose})) EXPECT_FALSE(bar.measured);
}

// Measured for real, on the smallest map that shows anything.
TEST(EnvironmentSweep, MethodsAgreeWithTheTruth) {
    // Of the worst level; the sharpest lobe, narrower than a texel here, sets the comparators'.
    constexpr double kPrefilter = 1e-3, kSampled = 0.12, kReduced = 0.4;  // measured 1.8e-4, 0.07, 0.28
    constexpr double kGpu = 5e-3;
    EnvironmentGpu gpu;
    EnvMap map(EnvLayout::LatLong, 64);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 128; ++x) {
            const Vec3 d = envTexelDirection(EnvLayout::LatLong, 64, x, y);
            map.image.setRgb(x, y, Rgb(1 + d.y, 2 + std::sin(9 * d.x), d.z > 0.95 ? 40 : 1));
        }
    for (const Chain chain : kChains) {
        const ChainTruth truth = drawChainTruth({"map", map}, chain, 32, 12);
        EXPECT_GT(truth.directSeconds, 0);
        const EnvironmentMeasurement exact = measurePrefilter(truth, 6e-4);
        EXPECT_TRUE(exact.usual);
        EXPECT_LT(exact.worstRmse(), kPrefilter) << toString(chain);
        EXPECT_LT(gpu.measure(truth, 8).worstRmse(), kGpu) << toString(chain);
        EXPECT_LT(measureImportance(truth, 4096, false).worstRmse(), kSampled) << toString(chain);
        EXPECT_LT(measureImportance(truth, 1024, true).worstRmse(), kSampled) << toString(chain);
        EXPECT_LT(measureReducedSums(truth, 16).worstRmse(), kReduced) << toString(chain);
        EXPECT_LT(measureReducedSums(truth, 32).worstRmse(), 1e-6) << toString(chain);  // nothing was reduced
    }
}

TEST(EnvironmentNaive, WhiteStaysWhite) {
    EnvMap white(EnvLayout::Cube, 8);
    for (float& v : white.image.data()) v = 1;
    const CubePyramid pyramid(white);
    for (const Lobe& lobe : {Lobe{LobeKind::Diffuse}, Lobe{LobeKind::Phong, 30}, Lobe{LobeKind::Ggx, 0, 0.3}})
        for (const bool filtered : {false, true})
            EXPECT_NEAR(importanceSampled(pyramid, lobe, {0, 0.6, 0.8}, 32, filtered).g, 1, 1e-12);
    EXPECT_THROW(importanceSampled(pyramid, {}, {0, 0, 1}, 32, true), std::invalid_argument);
}

TEST(EnvironmentMaps, SyntheticIsAlwaysThereAndMissingFilesAreSaid) {
    const SurroundingList list = benchSurroundings({"/no/such/folder"});
    ASSERT_EQ(list.surroundings.size(), 1u);
    EXPECT_EQ(list.notes.size(), 3u);
    const EnvMap map = syntheticSurrounding(64);
    double sum = 0, largest = 0;
    for (const float v : map.image.data()) sum += v, largest = std::max<double>(largest, v);
    EXPECT_GT(largest, 1000 * sum / static_cast<double>(map.image.data().size()));  // a sun
}

TEST(EnvironmentSweep, PlansKeepACurveOfEachMethodAndItsUsualSetting) {
    const auto has = [](const auto& list, auto value) {
        return std::find(list.begin(), list.end(), value) != list.end();
    };
    for (const bool quick : {false, true})
        for (const int size : {128, 256, 512, 1024}) {
            const SweepPlan plan = sweepPlan(size, quick, false);
            EXPECT_GE(plan.samples, 16);
            EXPECT_TRUE(has(plan.tolerances, PrefilterOptions().tolerance) && has(plan.counts, 1024)) << size;
            EXPECT_TRUE(has(plan.details, 8.0)) << size;
            for (const std::size_t settings : {plan.tolerances.size(), plan.counts.size(), plan.reducedSizes.size()})
                EXPECT_GE(settings, quick ? 2u : 3u) << size;
            EXPECT_FALSE(sweepPlan(size, false, true).details.empty()) << size;
        }
    EXPECT_TRUE(sweepPlan(256, false, false).everyMap);
    EXPECT_FALSE(sweepPlan(512, false, false).everyMap);
    const BenchSurrounding synthetic{kSyntheticName, syntheticSurrounding(16)}, yard{"yard", synthetic.map};
    EXPECT_EQ(decidingSurroundings({synthetic}).size(), 1u);
    EXPECT_EQ(decidingSurroundings({synthetic, yard}).at(0).name, "yard");
}

// A map that one method alone was measured on would shift that method's medians against the others'.
TEST(EnvironmentReport, PlotsTheMapsThatMethodsShare) {
    Report report;
    report.environments = {measurement(Chain::Phong, 512, 0.01, 0.5), measurement(Chain::Phong, 512, 0.01, 0.5),
                           measurement(Chain::Phong, 512, 0.9, 0.5)};
    report.environments[1].method = "importance";
    report.environments[2].surrounding = "alone";
    for (EnvironmentMeasurement& m : report.environments)
        for (LevelMeasurement& level : m.levels) level.error.samples = 16;
    EXPECT_THAT(reportPage(report), HasSubstr("512: yard (16 texels a level)"));
    EXPECT_THAT(reportPage(report), HasSubstr("nacre, tolerance 0.0006: 1 %, 0.5 CPU-s"));
}

TEST(EnvironmentReport, PlotsEachChainAndSize) {
    Report report;
    report.environments = {measurement(Chain::Phong, 256, 0.01, 0.5), measurement(Chain::Ggx, 128, 0.02, 0.3)};
    const std::string page = reportPage(report);
    EXPECT_THAT(page, HasSubstr("Phong chain, source 256"));
    EXPECT_THAT(page, HasSubstr("GGX chain, source 128"));
    EXPECT_THAT(page, HasSubstr("sum over every texel"));
    const auto json = reportJson(report);
    EXPECT_EQ(json["environments"][0]["chain"], "Phong chain");
    EXPECT_EQ(json["environments"][0]["levels"].size(), 8u);
    EXPECT_EQ(environmentSection({}), "");
}
