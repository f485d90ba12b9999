#include <gtest/gtest.h>

#include "bench/bump_sweep.hpp"

namespace nacre::bench {
namespace {

TEST(BenchReliefs, SyntheticReliefRepeats) {
    const HeightMap map = syntheticRelief(128);
    double across = 0, inside = 0;
    for (int y = 0; y < 128; ++y) {
        across += std::abs(map.at(127, y) - map.at(128, y));
        inside += std::abs(map.at(63, y) - map.at(64, y));
    }
    EXPECT_LT(across, 3 * inside + 128) << "no wall at the seam";
    EXPECT_THROW(syntheticRelief(32), std::invalid_argument);
}

TEST(BenchReliefs, MissingFilesAreNoted) {
    const ReliefList list = benchReliefs({"no/such/folder"});
    EXPECT_EQ(list.reliefs.size(), 1u);
    EXPECT_EQ(list.notes.size(), 2u);
}

TEST(BumpBars, ErrorsHoldOnASmallSyntheticRelief) {
    for (const Bar& bar : measureBumpBars({{"synthetic", syntheticRelief(64)}}, {.large = false})) {
        if (!bar.measured) continue;
        // Known to miss its bar (bump/README.md); it must not get worse.
        const double limit = bar.what == "the same, without the direct light" ? 0.25 : bar.limit;
        EXPECT_LE(bar.value, limit) << bar.what << ", " << bar.figure;
    }
}

TEST(BumpSection, ShowsEveryMeasurementAndAPlotARelief) {
    BumpMeasurement m;
    m.relief = "stones & sand";
    m.method = "ellipses";
    m.setting = "128 directions";
    m.bytesATexel = 12, m.cpuSeconds = 0.5, m.misjudged = 0.02, m.texels = 65536;
    const std::string html = bumpSection({m});
    EXPECT_NE(html.find("stones &amp; sand"), std::string::npos);
    EXPECT_NE(html.find("2 %"), std::string::npos);
    EXPECT_NE(html.find("<svg"), std::string::npos);
    EXPECT_TRUE(bumpSection({}).empty());
    EXPECT_EQ(bumpJson(m)["misjudged"], 0.02);
}

}  // namespace
}  // namespace nacre::bench
