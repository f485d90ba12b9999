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

constexpr int kWidth = 200, kHeight = 150;

void keep(const Image& image, const std::string& name, double white) {
    if (const char* folder = std::getenv("NACRE_TEST_PICTURES"))
        writePng(image, std::filesystem::path(folder) / (name + ".png"), {white});
}

class SceneReference : public ::testing::Test {
protected:
    void SetUp() override { test::context(); }

    ImageDifference compare(const SceneDescription& scene, const SceneParts& parts, const SceneSwitches& on,
                            const std::string& name) {
        SceneRenderer renderer(loader_, scene);
        renderer.switches = on;
        const RenderTarget target({.width = kWidth, .height = kHeight, .samples = 4});
        renderer.render(target, 0.5);
        const Image picture = target.read();
        const SceneTruths truths = openTruths(scene);
        EXPECT_TRUE(truths.notes.empty()) << truths.notes.front();
        const Image truth = traceScene(scene, scene.camera, truths, {parts},
                                       {.width = kWidth, .height = kHeight, .supersample = 3, .time = 0.5})
                                .front();
        const double white = pictureWhite(truth);
        keep(picture, name + "-drawn", white);
        keep(truth, name + "-traced", white);
        keep(differenceImage(picture, truth, white, 0.2), name + "-difference", 1);
        return compareImages(picture, truth, white);
    }
    ProgramLoader loader_;
};

TEST_F(SceneReference, PartsAreNear) {
    struct Case {
        const char* words;
        SceneParts parts;
        SceneSwitches on;
    };
    std::vector<Case> cases(8);
    cases[0] = {"all", {}, {}};
    cases[1] = {"no relief", {}, {}};
    cases[1].parts.relief = cases[1].on.relief = false;
    cases[2] = {"no relief, no surrounding", {}, {}};
    cases[2].parts.relief = cases[2].on.relief = cases[2].parts.surrounding = cases[2].on.surrounding = false;
    cases[3] = {"no indirect", {}, {}};
    cases[3].parts.indirect = cases[3].on.indirect = false;
    cases[4] = {"no indirect, no relief shadow", {}, {}};
    cases[4].parts.indirect = cases[4].on.indirect = cases[4].parts.reliefShadow = false;
    cases[4].on.reliefShadow = BumpShadow::None;
    cases[5] = {"no lamps", {}, {}};
    cases[5].parts.lamps = cases[5].on.lamps = false;
    cases[6] = {"no surrounding", {}, {}};
    cases[6].parts.surrounding = cases[6].on.surrounding = false;
    cases[7] = {"no surrounding, no indirect", {}, {}};
    cases[7].parts.surrounding = cases[7].on.surrounding = cases[7].parts.indirect = cases[7].on.indirect = false;
    for (const Case& c : cases) {
        const ImageDifference d = compare(test::fullScene(), c.parts, c.on, c.words);
        EXPECT_GT(d.psnrSrgb, 30) << c.words;
        std::printf("%-30s psnr %.2f relative %.4f\n", c.words, d.psnrSrgb, d.relative);
    }
}

}  // namespace
}  // namespace nacre
