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

TEST_F(SceneReference, FullSceneIsNear) {
    const ImageDifference d = compare(test::fullScene(), {}, {}, "full");
    EXPECT_GT(d.psnrSrgb, 30);
    std::printf("psnr %.2f relative %.4f\n", d.psnrSrgb, d.relative);
}

}  // namespace
}  // namespace nacre
