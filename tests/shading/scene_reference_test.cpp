// Scenes as drawn against the same scenes traced.
#include <gtest/gtest.h>

#include "gpu_evaluate.hpp"
#include "reference/image_compare.hpp"
#include "reference/scene_trace.hpp"
#include "scene_fixture.hpp"
#include "shading/image_output.hpp"
#include "shading/scene_renderer.hpp"

namespace nacre {
namespace {

constexpr int kWidth = 160, kHeight = 120;

void keep(const Image& image, const std::string& name, double white) {
    if (const char* folder = std::getenv("NACRE_TEST_PICTURES"))
        writePng(image, std::filesystem::path(folder) / (name + ".png"), {white});
}

// The fixture's maps are coarse on purpose: a sky of 32² texels a face, a relief of 32² whose bumps are 8 texels wide,
// shadow maps of 256². Measured 28.2 (without lamps: the sky that the relief hides) to 33 dB; a part with a
// wrong sign, frame or factor is below 25.
constexpr double kNear = 27.5;

struct Case {
    const char* words;
    SceneParts parts;
    SceneSwitches on;
};

std::vector<Case> cases() {
    std::vector<Case> out(6);
    out[0].words = "all";
    out[1].words = "no relief";
    out[1].parts.relief = out[1].on.relief = false;
    out[2].words = "no surrounding, no sky";
    out[2].parts.surrounding = out[2].on.surrounding = out[2].parts.sky = out[2].on.sky = false;
    out[3].words = "no lamps";
    out[3].parts.lamps = out[3].on.lamps = false;
    out[4].words = "no bounced light, no relief's shadows";
    out[4].parts.indirect = out[4].on.indirect = out[4].parts.reliefShadow = false;
    out[4].on.reliefShadow = BumpShadow::None;
    out[5].words = "no shadow maps, baked BRDF";
    out[5].parts.shadows = out[5].on.shadows = false;
    out[5].parts.bakedBrdf = true;
    return out;
}

TEST(SceneReference, EveryPartIsNear) {
    test::context();
    ProgramLoader loader;
    const SceneDescription scene = test::fullScene();
    SceneRenderer renderer(loader, scene);
    std::vector<SceneParts> parts;
    for (const Case& c : cases()) parts.push_back(c.parts);
    const SceneTruths truths = openTruths(scene);
    EXPECT_TRUE(truths.notes.empty()) << truths.notes.front();
    const std::vector<Image> traced = traceScene(scene, scene.camera, truths, parts,
                                                 {.width = kWidth, .height = kHeight, .supersample = 2, .time = 0.5});
    const double white = pictureWhite(traced[0]);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Case c = cases()[i];
        renderer.switches = c.on;
        const RenderTarget target({.width = kWidth, .height = kHeight, .samples = 4});
        renderer.render(target, 0.5);
        const Image picture = target.read();
        keep(picture, std::string(c.words) + "-drawn", white);
        keep(traced[i], std::string(c.words) + "-traced", white);
        keep(differenceImage(picture, traced[i], white, 0.2), std::string(c.words) + "-difference", 1);
        EXPECT_GT(compareImages(picture, traced[i], white).psnrSrgb, kNear) << c.words;
        if (i == 0) continue;
        EXPECT_LT(compareImages(traced[i], traced[0], white).psnrSrgb, 45) << c.words << ": no difference";
    }
}

}  // namespace
}  // namespace nacre
