// Whole scenes with shadow volumes: against the traced scene, and what is made again when.
#include "shading/multipass/scene_shadow_volumes.hpp"

#include <gtest/gtest.h>

#include "../gpu_evaluate.hpp"
#include "../scene_fixture.hpp"
#include "core/error.hpp"
#include "reference/image_compare.hpp"
#include "reference/scene_trace.hpp"
#include "shading/primitives.hpp"
#include "shading/scene_file.hpp"
#include "shading/scene_renderer.hpp"

namespace nacre {
namespace {

constexpr int kWidth = 160, kHeight = 120;

class SceneShadowVolumesTest : public ::testing::Test {
protected:
    void SetUp() override { test::context(); }

    Image draw(SceneRenderer& renderer, ShadowMethod method, double time = 0) {
        renderer.switches.shadowMethod = method;
        const RenderTarget to({.width = kWidth, .height = kHeight});
        renderer.render(to, time);
        return to.read();
    }
    Image draw(const SceneDescription& scene, ShadowMethod method = ShadowMethod::Volumes) {
        SceneRenderer renderer(loader_, scene);
        return draw(renderer, method);
    }
    ProgramLoader loader_;
};

double relative(const Image& a, const Image& b) { return compareImages(a, b, pictureWhite(b)).relative; }

TEST_F(SceneShadowVolumesTest, NearerToTheTracedSceneThanMaps) {
    const SceneDescription scene = test::fullScene();
    const SceneTruths truths = openTruths(scene, 0, {});
    const Image truth =
        traceScene(scene, scene.camera, truths, {SceneParts()}, {.width = kWidth, .height = kHeight, .supersample = 1})
            .front();
    const double volumes = relative(draw(scene), truth), maps = relative(draw(scene, ShadowMethod::Maps), truth);
    EXPECT_LT(volumes, maps);
    EXPECT_LT(volumes, 0.15);  // one ray a pixel: edges of shapes, noise of bounced light
}

TEST_F(SceneShadowVolumesTest, OnlyWhatMovedIsMadeAgain) {
    SceneDescription scene = test::fullScene();
    SceneRenderer renderer(loader_, scene);
    draw(renderer, ShadowMethod::Volumes, 0);
    EXPECT_EQ(renderer.shadowVolumes().made, 8);  // two lights, four nodes
    draw(renderer, ShadowMethod::Volumes, 0);
    EXPECT_EQ(renderer.shadowVolumes().made, 0);
    EXPECT_EQ(renderer.shadowVolumes().kept, 8);
    const Image moved = draw(renderer, ShadowMethod::Volumes, 0.6);  // one node turns
    EXPECT_EQ(renderer.shadowVolumes().made, 2);
    SceneRenderer fresh(loader_, scene);
    EXPECT_EQ(draw(fresh, ShadowMethod::Volumes, 0.6).data(), moved.data()) << "a volume that is out of date";
    SceneLight spot = scene.lights[1];
    spot.light.color *= 2.0;
    renderer.setLight(1, spot);
    draw(renderer, ShadowMethod::Volumes, 0.6);
    EXPECT_EQ(renderer.shadowVolumes().made, 0) << "a brighter light casts the same volumes";
    spot.light.position.x += 0.1;
    renderer.setLight(1, spot);
    draw(renderer, ShadowMethod::Volumes, 0.6);
    EXPECT_EQ(renderer.shadowVolumes().made, 4);
}

TEST_F(SceneShadowVolumesTest, StoredVolumesTakeAnEighthOfAVolumeAPolygon) {
    for (const SceneDescription& scene :
         {test::fullScene(), readScene(NACRE_SOURCE_DIR "/demos/scenes/cornell-box.json")}) {
        SceneRenderer renderer(loader_, scene);
        draw(renderer, ShadowMethod::Volumes);
        const ShadowVolumeCounts counts = renderer.shadowVolumes();
        EXPECT_GE(counts.bytesAPolygon, 8 * counts.bytes);
        EXPECT_GT(counts.pointBytes, 0u);
    }
}

TEST_F(SceneShadowVolumesTest, WithoutCastersTheLightIsTheSame) {
    SceneDescription scene = test::fullScene();
    for (SceneNode& node : scene.nodes) node.castsShadow = false;
    SceneDescription plain = scene;
    for (SceneLight& light : plain.lights) light.shadow.reset();
    EXPECT_LT(relative(draw(scene), draw(plain)), 1e-6);
    EXPECT_EQ(draw(plain).data(), draw(plain, ShadowMethod::Maps).data());
    scene = test::fullScene();
    for (SceneNode& node : scene.nodes) node.receivesShadow = false;
    EXPECT_LT(relative(draw(scene), draw(plain)), 1e-6) << "nobody receives";
}

TEST_F(SceneShadowVolumesTest, SceneWithoutLights) {
    SceneDescription scene = test::fullScene();
    scene.lights.clear();
    for (SceneMaterial& m : scene.materials)
        if (m.relief) m.relief->indirectLight = -1;
    EXPECT_EQ(draw(scene).data(), draw(scene, ShadowMethod::Maps).data());
}

TEST_F(SceneShadowVolumesTest, DuplicatedNodesAreLitOnce) {
    SceneDescription scene = test::fullScene();
    const Image once = draw(scene);
    scene.nodes.push_back(scene.nodes[2]);
    scene.nodes.push_back(scene.nodes[0]);
    EXPECT_LT(relative(draw(scene), once), 1e-6);
}

/// A ball above a floor, under a lamp with an area.
SceneDescription softScene(double size) {
    SceneDescription scene;
    scene.meshes = {{"floor", makeQuad(6, 2)}, {"ball", makeSphere(0.5f, 48, 24)}};
    SceneMaterial matt;
    matt.model = "lambert:kd=0.7";
    scene.materials = {matt};
    scene.nodes.resize(2);
    for (std::size_t i = 0; i < 2; ++i) scene.nodes[i].mesh = static_cast<int>(i), scene.nodes[i].material = 0;
    scene.nodes[0].rotation = glm::angleAxis(-kPi / 2, Vec3(1, 0, 0));
    scene.nodes[1].translation = {0, 0.9, 0};
    SceneLight lamp;
    lamp.light = {false, {0.6, 3, 0.5}, Rgb(20), {}};
    lamp.shadow = SceneShadow{};
    lamp.area = LightArea{{size, 0, 0}, {0, 0, size}};
    scene.lights = {lamp};
    scene.camera.eye = {0.5, 2.2, 4};
    scene.camera.target = {0, 0.3, 0};
    return scene;
}

Image traced(const SceneDescription& scene) {
    const SceneTruths truths = openTruths(scene, 0, {});
    SceneTraceOptions options{.width = kWidth, .height = kHeight, .supersample = 1};
    options.lightPoints = 256;
    return traceScene(scene, scene.camera, truths, {SceneParts()}, options).front();
}

TEST_F(SceneShadowVolumesTest, SoftShadowsNearTheTruthWithTheirPoints) {
    const SceneDescription scene = softScene(0.25);
    const Image truth = traced(scene);
    SceneRenderer renderer(loader_, scene);
    double last = 1;
    for (const int points : {1, 4, 16, 63}) {
        renderer.switches.lightPoints = points;
        const double error = relative(draw(renderer, ShadowMethod::Volumes), truth);
        EXPECT_LT(error, 0.8 * last) << points;
        last = error;
    }
    EXPECT_LT(last, 0.02);
}

TEST_F(SceneShadowVolumesTest, PivotTakesOneVolumeAndErrsWithTheLightsSize) {
    double small = 0;
    for (const double size : {0.05, 0.4}) {
        SceneRenderer renderer(loader_, softScene(size));
        const Image regenerated = draw(renderer, ShadowMethod::Volumes);
        const ShadowVolumeCounts each = renderer.shadowVolumes();
        EXPECT_EQ(each.made, 32);
        renderer.switches.softShadows = SoftShadows::Pivot;
        const Image pivot = draw(renderer, ShadowMethod::Volumes);
        const ShadowVolumeCounts one = renderer.shadowVolumes();
        EXPECT_EQ(one.made + one.kept, 2);
        EXPECT_LT(10 * one.bytes, each.bytes);
        const double error = relative(pivot, regenerated);
        EXPECT_GT(error, small);
        EXPECT_LT(error, 0.1);
        small = error;
    }
}

TEST_F(SceneShadowVolumesTest, LevelsDarkenLikeSumsWhereVolumesDontOverlap) {
    SceneRenderer renderer(loader_, softScene(0.1));
    const Image sum = draw(renderer, ShadowMethod::Volumes);
    renderer.switches.softShadows = SoftShadows::Levels;
    EXPECT_LT(relative(draw(renderer, ShadowMethod::Volumes), sum), 0.02);
}

TEST_F(SceneShadowVolumesTest, RejectsTooManyPoints) {
    SceneRenderer renderer(loader_, softScene(0.1));
    renderer.switches.lightPoints = 64;
    EXPECT_THROW(draw(renderer, ShadowMethod::Volumes), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
