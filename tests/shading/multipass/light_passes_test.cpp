// Light that mirrors and panes send on, and shadow volumes in scenes that have them, against the traced scenes.
#include "shading/multipass/light_passes.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "../gpu_evaluate.hpp"
#include "reference/image_compare.hpp"
#include "reference/scene_trace.hpp"
#include "shading/image_output.hpp"
#include "shading/primitives.hpp"
#include "shading/scene_file.hpp"
#include "shading/scene_renderer.hpp"
#include "tests/shading/multipass/specular_fixture.hpp"

namespace nacre {
namespace {

constexpr int kSize = 160;

void keep(const Image& image, const std::string& name, double white) {
    if (const char* folder = std::getenv("NACRE_TEST_PICTURES"))
        writePng(image, std::filesystem::path(folder) / (name + ".png"), {white});
}

/// Means of 8 × 8 pixels: little of random rays' noise is left.
Image blockMeans(const Image& fine) {
    constexpr int kBlock = 8;
    Image out(fine.width() / kBlock, fine.height() / kBlock, 3);
    for (int y = 0; y < out.height() * kBlock; ++y)
        for (int x = 0; x < out.width() * kBlock; ++x)
            out.setRgb(x / kBlock, y / kBlock,
                       out.rgb(x / kBlock, y / kBlock) + fine.rgb(x, y) / double(kBlock * kBlock));
    return out;
}

class LightPassesTest : public ::testing::Test {
protected:
    void SetUp() override { test::context(); }

    /// Shaded once a pixel, in its middle, as the reference is.
    Image draw(SceneRenderer& renderer, double time = 0) {
        const RenderTarget target({.width = kSize, .height = kSize});
        renderer.render(target, time);
        return target.read();
    }
    /// Share of the pixels that are off by more than `tolerance` of the picture's white.
    double wrong(const SceneDescription& scene, const SceneSwitches& on, const std::string& name,
                 double tolerance = 0.01) {
        SceneRenderer renderer(loader_, scene);
        renderer.switches = on;
        const Image drawn = draw(renderer);
        SceneTraceOptions options{.width = kSize, .height = kSize, .supersample = 1};
        options.specularDepth = on.specular.depth;
        options.lightDepth = on.specular.lightDepth;
        options.lightPoints = 256;
        options.facePoints = facePoints_;
        const Image traced = traceScene(scene, scene.camera, openTruths(scene), {{}}, options).front();
        const double white = pictureWhite(traced);
        keep(drawn, name + "-drawn", white);
        keep(traced, name + "-traced", white);
        relative_ = compareImages(drawn, traced, white).relative;
        smoothed_ = compareImages(blockMeans(drawn), blockMeans(traced), white).relative;
        int off = 0;
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x)
                off += maxComponent(glm::abs(drawn.rgb(x, y) - traced.rgb(x, y))) > tolerance * white;
        const double share = off / double(kSize * kSize);
        std::printf("%s: %.3f %% of pixels are off\n", name.c_str(), 100 * share);
        return share;
    }
    ProgramLoader loader_;
    double relative_ = 0, smoothed_ = 0;  ///< of the last pair, and of its blocks' means
    int facePoints_ = 16;
};

SceneSwitches withLights(int depth, ShadowMethod method = ShadowMethod::Volumes) {
    SceneSwitches out;
    out.shadowMethod = method;
    out.specular.lightDepth = depth;
    return out;
}

/// A floor, two balls and a leaning square under a lamp, all matt, with a mirror.
test::SpecularScene mirrorScene() {
    test::SpecularScene s;
    s.face("mirror", {.reflection = Rgb(0.9)}, {0, 0, -1}, 0.25);
    s.ball(Rgb(0.02), {0.3, 0, 0.2});
    s.ball(Rgb(0.02), {-0.5, -0.4, 0.6}, 0.2);
    s.square(Rgb(0.02), {0, -0.8, 0}, -kPi / 2, {1, 0, 0}, Vec3(3));
    s.square(Rgb(0.02), {0.9, -0.2, 0.4}, -0.9, {0, 1, 0}, Vec3(0.3));
    for (SceneMaterial& m : s.scene.materials)
        if (!m.specular) m.model = "lambert:kd=0.7";
    SceneLight lamp;
    lamp.light = {false, {0.6, 1.2, 1.5}, Rgb(8), {}};
    lamp.shadow = SceneShadow{};
    s.scene.lights = {lamp};
    s.scene.camera.eye = {0.2, 0.6, 4};
    return s;
}

/// Pixels of outlines and of shadows' edges, which fall to one side or the other by rounding.
constexpr double kEdges = 2e-3;

TEST_F(LightPassesTest, ShadowVolumesInsideMirrors) {
    const SceneDescription scene = mirrorScene().scene;
    EXPECT_LE(wrong(scene, withLights(0), "volumes"), kEdges);
    SceneDescription sun = scene;
    sun.lights[0].light = {true, glm::normalize(Vec3(0.6, 1.2, 0.8)), Rgb(2), {}};
    EXPECT_LE(wrong(sun, withLights(0), "volumes-sun"), kEdges);
}

TEST_F(LightPassesTest, ALampInAMirror) {
    SceneDescription scene = mirrorScene().scene;
    EXPECT_LE(wrong(scene, withLights(1), "mirror"), kEdges);
    scene.lights[0].light.cone = SpotCone{glm::normalize(Vec3(-0.5, -1.1, -2)), 0.3, 0.9};
    EXPECT_LE(wrong(scene, withLights(1), "mirror-spot"), kEdges);
    scene.lights[0].light = {true, glm::normalize(Vec3(0.6, 1.2, 0.8)), Rgb(2), {}};
    EXPECT_LE(wrong(scene, withLights(1), "mirror-sun"), kEdges);
}

TEST_F(LightPassesTest, LightPathsGoWithShadowMaps) {
    SceneRenderer renderer(loader_, mirrorScene().scene);
    renderer.switches = withLights(1, ShadowMethod::Maps);
    const Image maps = draw(renderer);
    renderer.switches = withLights(1);
    EXPECT_GT(compareImages(maps, draw(renderer), pictureWhite(maps)).psnrSrgb, 30);
}

TEST_F(LightPassesTest, TwoMirrorsHandLightOn) {
    test::SpecularScene s = mirrorScene();
    s.face("second", {.reflection = Rgb(0.8)}, {1.6, 0, 0.6}, -1.3, {0, 1, 0}, Vec3(0.7));
    EXPECT_LE(wrong(s.scene, withLights(2), "two"), 2 * kEdges);
}

/// The mirror's plane goes through the ball: what of it is before the plane blocks, what is behind doesn't.
TEST_F(LightPassesTest, ObjectsAcrossAMirrorsPlaneAreCut) {
    test::SpecularScene s = mirrorScene();
    s.ball(Rgb(0.02), {0.75, -0.3, -1.2}, 0.3);
    s.scene.materials.back().model = "lambert:kd=0.7";
    s.square(Rgb(0.02), {-0.7, 0, -0.85}, 1.3, {0, 1, 0}, Vec3(0.35));
    s.scene.materials.back().model = "lambert:kd=0.7";
    EXPECT_LE(wrong(s.scene, withLights(1), "across"), kEdges);
}

TEST_F(LightPassesTest, ALightInTheMirrorsPlaneOrBehindIt) {
    SceneDescription scene = mirrorScene().scene;
    const double angle = 0.25;
    scene.lights[0].light.position = Vec3(0, 0, -1) + Vec3(std::cos(angle), 0, -std::sin(angle)) * 2.0 + Vec3(0, 1, 0);
    EXPECT_LE(wrong(scene, withLights(1), "plane"), kEdges);
    scene.lights[0].light.position = {0.5, 1.5, -2};
    EXPECT_LE(wrong(scene, withLights(1), "behind"), kEdges);
}

TEST_F(LightPassesTest, NodesThatReceiveNoShadowsAreLitInTheWholeLightVolume) {
    SceneDescription scene = mirrorScene().scene;
    scene.nodes[3].receivesShadow = false;
    EXPECT_LE(wrong(scene, withLights(1), "receivers"), kEdges);
}

TEST_F(LightPassesTest, AMovingObjectCostsNoOtherObjectsVolumes) {
    SceneDescription scene = mirrorScene().scene;
    SceneTrack track;
    track.node = 1;
    track.times = {0, 1};
    track.values = {{0.3, 0, 0.2, 0}, {0.1, 0.2, 0.3, 0}};
    scene.tracks = {track};
    scene.duration = 1;
    SceneRenderer renderer(loader_, scene);
    renderer.switches = withLights(1);
    draw(renderer, 0);
    const ShadowVolumeCounts first = renderer.shadowVolumes();
    draw(renderer, 0);
    EXPECT_EQ(renderer.shadowVolumes().made, 0);
    const Image moved = draw(renderer, 0.5);
    // From the lamp, and from its image. Before the face the lamp's own volume serves.
    EXPECT_EQ(renderer.shadowVolumes().made, 2);
    EXPECT_EQ(renderer.shadowVolumes().kept, first.made - 2);
    SceneRenderer fresh(loader_, scene);
    fresh.switches = withLights(1);
    EXPECT_EQ(draw(fresh, 0.5).data(), moved.data());
}

/// PR94 figure 2: light from a sun, at 45°, with and by way of a pane; what falls in each region is known.
TEST_F(LightPassesTest, TheEightRegions) {
    const SceneDescription scene = readScene(NACRE_SOURCE_DIR "/demos/scenes/light-regions.json");
    const double cosine = std::sqrt(0.5), beyond = std::sqrt(1 - 0.125);
    const double s = (cosine - 2 * beyond) / (cosine + 2 * beyond), p = (2 * cosine - beyond) / (2 * cosine + beyond);
    const double primary = 0.8 / kPi * 3 * cosine, refracted = primary * (1 - 0.5 * (s * s + p * p));
    struct Region {
        const char* name;
        double x, z, radiance;
    };
    const Region regions[] = {{"1: primary light", -0.9, 0.3, primary},
                              {"2: primary and refracted light", 0.2, -0.5, primary + refracted},
                              {"3: the cube's refracted shadow and primary light", 0.3, 0.3, primary},
                              {"4: the cube's refracted shadow", 0.65, 0.3, 0},
                              {"5: the cube's refracted shadow and the sphere's", 0.83, 0.3, 0},
                              {"6: the sphere's shadow from refracted light", 1.1, 0.3, 0},
                              {"7: refracted light", 1.2, -0.5, refracted},
                              {"8: the refracting surface's shadow", 2, 0, 0}};
    SceneRenderer renderer(loader_, scene);
    renderer.switches = withLights(1);
    const Image drawn = draw(renderer);
    keep(drawn, "regions", pictureWhite(drawn));
    for (const Region& r : regions) {
        const int x = int((0.5 + (r.x - 0.7) / 3.6) * kSize), y = int((0.5 + r.z / 3.6) * kSize);
        EXPECT_NEAR(drawn.rgb(x, y).r, r.radiance, 0.01 * primary) << r.name;
    }
    EXPECT_LE(wrong(scene, withLights(1), "regions"), 2 * kEdges);
}

/// A lamp through a pane: virtual lights are made for the ray through its middle (MPR section 4.2: paraxial rays).
TEST_F(LightPassesTest, ALampThroughAPaneIsNearestWhenItIsFar) {
    SceneDescription scene = readScene(NACRE_SOURCE_DIR "/demos/scenes/light-regions.json");
    double last = 0.3;
    for (const double distance : {3.0, 10.0, 100.0}) {
        scene.lights[0].light = {
            false, distance * glm::normalize(Vec3(-0.3, 1, 0.1)), Rgb(3 * distance * distance), {}};
        wrong(scene, withLights(1), "pane-" + std::to_string(int(distance)));
        std::printf("  relative error %.4f\n", relative_);
        EXPECT_LT(relative_, last);
        last = relative_;
    }
    EXPECT_LT(last, 0.02);
}

/// Lines of sight that never leave a volume: its far cap has no place in a parallel projection.
TEST_F(LightPassesTest, AnOrthographicViewAllInShadow) {
    SceneDescription scene = mirrorScene().scene;
    scene.camera.orthographic = true;
    scene.camera.height = 1;
    scene.camera.eye = {0.3, -0.5, 0.2};
    scene.camera.target = {0.3, -1, 0.2};
    scene.camera.up = {0, 0, -1};
    scene.camera.near = 0.01;
    scene.lights[0].light.position = {0.3, 0.5, 0.2};
    EXPECT_LE(wrong(scene, withLights(0), "ortho"), kEdges);
}

TEST_F(LightPassesTest, InRefractedAndWeighedViews) {
    test::SpecularScene s = mirrorScene();
    SceneSpecular glass;
    glass.ior = 1.5;
    s.face("pane", glass, {-0.3, 0.1, 1.2}, 0.4, {0, 1, 0}, Vec3(0.5));
    s.scene.camera.orthographic = true;
    s.scene.camera.height = 3;
    s.scene.lights[0].light = {true, glm::normalize(Vec3(0.6, 1.2, 0.8)), Rgb(2), {}};
    EXPECT_LE(wrong(s.scene, withLights(1), "weighed"), 2 * kEdges);
}

TEST_F(LightPassesTest, FogBehindAFaceIsAddedOnce) {
    SceneDescription scene = mirrorScene().scene;
    scene.materials[0].specular->fog = {0.3, 0.3, 0.5};
    scene.materials[0].specular->fogDistance = 3;
    EXPECT_LE(wrong(scene, withLights(0), "fog"), kEdges);
}

/// Coloured patches, some dark, and in alpha some that keep all back.
std::shared_ptr<Image> patches(int size = 6) {
    auto out = std::make_shared<Image>(size, size + 1, 4);
    for (int y = 0; y <= size; ++y)
        for (int x = 0; x < size; ++x) {
            out->setRgb(x, y, {x % 3 == 0 ? 0.9 : 0.1, y % 2 == 0 ? 0.8 : 0.05, (x + y) % 4 == 0 ? 1 : 0.2});
            out->at(x, y, 3) = (x + 2 * y) % 3 == 0 ? 1 : 0;
        }
    return out;
}

/// A lamp through leaning stained glass, seen through it too and in a mirror; both send its pattern on.
TEST_F(LightPassesTest, StainedGlass) {
    test::SpecularScene s = mirrorScene();
    SceneSpecular glass;
    glass.ior = 1;
    glass.filter = patches();
    s.face("stained", glass, {0.25, 0.3, 0.9}, 0.5, {1, 1, 0.2}, {0.5, 0.4, 1});
    EXPECT_LE(wrong(s.scene, withLights(2), "stained"), 2 * kEdges);
    s.scene.lights[0].light.cone = SpotCone{glm::normalize(Vec3(-0.5, -1.1, -1)), 0.3, 0.9};
    EXPECT_LE(wrong(s.scene, withLights(1), "stained-spot"), 2 * kEdges);
    s.scene.lights[0].light = {true, glm::normalize(Vec3(0.4, 1.2, 0.9)), Rgb(2), {}};
    EXPECT_LE(wrong(s.scene, withLights(2), "stained-sun"), 2 * kEdges);
}

TEST_F(LightPassesTest, TwoStainedPanesInARow) {
    test::SpecularScene s = mirrorScene();
    SceneSpecular glass;
    glass.ior = 1;
    glass.filter = patches();
    s.face("first", glass, {0.25, 0.3, 0.9}, 0.5, {1, 1, 0.2}, {0.5, 0.4, 1});
    glass.filter = patches(3);
    s.face("second", glass, {0.1, 0, 0.65}, 0.9, {1, 1, 0.2}, {0.6, 0.5, 1});
    EXPECT_LE(wrong(s.scene, withLights(2), "stained-two"), 3 * kEdges);
}

/// A mirror's filter is of what it reflects; a texture's alpha and fog dim what it sends on.
TEST_F(LightPassesTest, FilteredAndFoggedMirrors) {
    SceneDescription scene = mirrorScene().scene;
    SceneSpecular& mirror = *scene.materials[0].specular;
    mirror.filter = patches();
    EXPECT_LE(wrong(scene, withLights(1), "filtered-mirror"), 2 * kEdges);
    mirror.texture = patches();
    mirror.surface = 0.7;
    EXPECT_LE(wrong(scene, withLights(1), "textured-mirror"), 2 * kEdges);
    mirror.fog = {0.1, 0.2, 0.3};
    mirror.fogDistance = 1.5;
    EXPECT_LE(wrong(scene, withLights(1), "fogged-mirror"), 2 * kEdges);
}

/// Fresnel's shares, bent light, fog between two faces: a slab of coloured glass in the sun.
TEST_F(LightPassesTest, AColouredSlabInTheSun) {
    test::SpecularScene s = mirrorScene();
    SceneSpecular glass;
    glass.ior = 1.5;
    glass.filter = patches();
    glass.fogDistance = 0.8;
    s.face("front", glass, {0.25, 0.3, 0.9}, 0.5, {1, 1, 0.2}, {0.5, 0.4, 1});
    const glm::dmat4 front = nodeTransforms(s.scene, 0).back();
    glass.fogDistance = 0;
    SceneNode& back = s.face("back", glass, Vec3(front * Vec4(0, 0, -0.2, 1)), 0, {0, 1, 0}, {0.5, 0.4, 1});
    back.rotation = s.scene.nodes[s.scene.nodes.size() - 2].rotation * glm::angleAxis(kPi, glm::dvec3(0, 1, 0));
    s.scene.lights[0].light = {true, glm::normalize(Vec3(0.4, 1.2, 0.9)), Rgb(2), {}};
    s.scene.camera.orthographic = true;
    s.scene.camera.height = 3;
    EXPECT_LE(wrong(s.scene, withLights(2), "slab"), 4 * kEdges);
}

/// A frosted pane and a glossy mirror light what is behind and before them; each sample is a light of its own.
TEST_F(LightPassesTest, FrostedAndGlossyFacesScatterLight) {
    test::SpecularScene s = mirrorScene();
    SceneSpecular glass;
    glass.ior = 1;
    glass.spread = 0.2;
    s.face("frosted", glass, {0.25, 0.3, 0.9}, 0.5, {1, 1, 0.2}, {0.5, 0.4, 1});
    s.scene.materials[0].specular->spread = 0.15;
    facePoints_ = 600;
    SceneSwitches on = withLights(1);
    on.specular.depth = 0;  // as they light, not as they look
    double last = 1;
    for (const int shears : {4, 16, 64}) {
        on.specular.shears = shears;
        wrong(s.scene, on, "frosted-" + std::to_string(shears), 0.02);
        std::printf("  relative error %.4f, of blocks %.4f\n", relative_, smoothed_);
        EXPECT_LT(smoothed_, last);
        last = smoothed_;
    }
    EXPECT_LT(last, 0.02);
}

/// The lamp is behind the camera, and a ball close before it: eye, mirror and its near plane are in the ball's shadow.
TEST_F(LightPassesTest, VolumesAcrossTheNearPlaneInsideAMirror) {
    test::SpecularScene s = mirrorScene();
    s.scene.lights[0].light.position = {0.25, 0.75, 6};
    s.scene.lights[0].light.color = Rgb(40);
    s.ball(Rgb(0.02), {0.22, 0.62, 4.4}, 0.3);
    s.scene.materials.back().model = "lambert:kd=0.7";
    EXPECT_LE(wrong(s.scene, withLights(1), "near"), kEdges);
}

TEST_F(LightPassesTest, SoftLightByAMirror) {
    SceneDescription scene = mirrorScene().scene;
    scene.lights[0].area = LightArea{{0.15, 0, 0}, {0, 0, 0.15}};
    SceneSwitches on = withLights(1);
    double last = 1;
    for (const int points : {1, 8, 63}) {
        on.lightPoints = points;
        wrong(scene, on, "soft-" + std::to_string(points), 0.02);
        std::printf("  relative error %.4f\n", relative_);
        EXPECT_LT(relative_, last);
        last = relative_;
    }
    EXPECT_LT(last, 0.03);
}

/// The bar of the multi-pass issue: 512², four samples a pixel of both, direct and mirrored light.
TEST_F(LightPassesTest, FasterThanTheReferenceAtEqualSamples) {
    SceneDescription scene = readScene(NACRE_SOURCE_DIR "/demos/scenes/lit-by-mirror.json");
    SceneRenderer renderer(loader_, scene);
    renderer.switches = withLights(1);
    const RenderTarget target({.width = 1024, .height = 1024});
    const auto seconds = [](const auto& work) {
        const auto begin = std::chrono::steady_clock::now();
        work();
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    Image drawn, traced;
    const double first = seconds([&] { renderer.render(target), drawn = target.read(); });
    const double drawing = seconds([&] { renderer.render(target), drawn = target.read(); });
    const SceneTruths truths = openTruths(scene);
    SceneTraceOptions options{.width = 1024, .height = 1024, .supersample = 1};
    options.lightDepth = 1;
    const double tracing = seconds([&] { traced = traceScene(scene, scene.camera, truths, {{}}, options).front(); });
    const double error = compareImages(drawn, traced, pictureWhite(traced)).relative;
    std::printf("drawn in %.3f s (first frame %.3f s), traced in %.3f s: %.1f times; relative error %.5f\n", drawing,
                first, tracing, tracing / drawing, error);
    EXPECT_LT(error, 0.02);
    EXPECT_LT(drawing, tracing);
}

TEST_F(LightPassesTest, WithoutFacesNothingIsAdded) {
    test::SpecularScene s;
    s.ball(Rgb(0.1), {0, 0, 0});
    SceneRenderer renderer(loader_, s.scene);
    renderer.switches = withLights(2, ShadowMethod::Maps);
    draw(renderer);
    EXPECT_TRUE(renderer.schedule().lights.empty());
}

}  // namespace
}  // namespace nacre
