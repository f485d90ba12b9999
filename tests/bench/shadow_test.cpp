#include <gtest/gtest.h>

#include "bench/shadow_sweep.hpp"
#include "shading/context.hpp"

namespace nacre::bench {
namespace {

TEST(ShadowScenes, BoxesAreClosedAndFaceOutwards) {
    const Mesh box = boxMesh({-1, 0, 2}, {1, 3, 2.5}, 3);
    double volume = 0;  // of the tetrahedra from the origin: the divergence theorem
    for (const glm::uvec3& t : box.triangles) {
        const Vec3 a(box.positions[t.x]), b(box.positions[t.y]), c(box.positions[t.z]);
        volume += glm::dot(a, glm::cross(b, c)) / 6;
        EXPECT_GT(glm::dot(glm::cross(b - a, c - a), Vec3(box.normals[t.x])), 0);
    }
    EXPECT_NEAR(volume, 2 * 3 * 0.5, 1e-5);
}

TEST(ShadowScenes, MissingFilesAreNoted) {
    const ShadowSceneList list = shadowScenes({"no/such/folder"});
    EXPECT_EQ(list.scenes.size(), 1u);
    EXPECT_EQ(list.notes.size(), 5u);
}

// Frame times depend on the machine and its load: bench prints them, here they only have to be there.
TEST(ShadowBars, ErrorsHoldOnTheSyntheticScene) {
    const Context context;
    ProgramLoader loader;
    for (const Bar& bar : measureShadowBars({syntheticShadowScene()}, {.loader = &loader})) {
        ASSERT_TRUE(bar.measured) << bar.what;
        const bool timed = bar.figure.rfind("times", 0) == 0;
        EXPECT_TRUE(timed || bar.pass()) << bar.what << ", " << bar.figure << ": " << bar.value << ", " << bar.worst;
        EXPECT_TRUE(!timed || bar.value > 0.5);
    }
}

TEST(ShadowSection, ShowsEveryMeasurementAndItsPlots) {
    ShadowMeasurement m;
    m.scene = "stones & sand", m.light = "spot", m.method = "linear depth, 32 bits", m.setting = "1024², filter 3";
    m.acne = 0.02, m.frame = 1.25;
    ShadowMeasurement code = m;
    code.method = "z-buffer, traced", code.nearToFar = 1e-3, code.bits = 24;
    const std::string html = shadowSection({m, code});
    EXPECT_NE(html.find("stones &amp; sand"), std::string::npos);
    EXPECT_NE(html.find("2 %"), std::string::npos);
    EXPECT_NE(html.find("<svg"), std::string::npos);
    EXPECT_TRUE(shadowSection({}).empty());
    EXPECT_EQ(shadowJson(m)["acne"], 0.02);
}

}  // namespace
}  // namespace nacre::bench
