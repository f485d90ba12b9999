// The scene tracer against closed forms and against the tracer of single meshes.
#include "reference/scene_trace.hpp"

#include <gtest/gtest.h>

#include "factorize/models/models.hpp"
#include "reference/lobe_table.hpp"
#include "reference/raytrace.hpp"

namespace nacre {
namespace {

/// A square of edge 2 in the plane z = 0, facing +z, uv from 0 to 1.
Mesh square() {
    Mesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.tangents.assign(4, {1, 0, 0, 1});
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

SceneDescription squareScene(const Light& light) {
    SceneDescription scene;
    scene.meshes = {{"square", square()}};
    scene.materials.resize(1);
    scene.nodes.resize(1);
    scene.nodes[0].mesh = scene.nodes[0].material = 0;
    scene.lights.resize(1);
    scene.lights[0].light = light;
    scene.camera.orthographic = true;
    scene.camera.height = 1.8;  // the square fills the picture
    return scene;
}

SceneTruths lambertTruths(double albedo) {
    SceneTruths out;
    out.materials.resize(1);
    out.materials[0].brdf = [albedo](const Vec3&, const Vec3&) { return Rgb(albedo / kPi); };
    return out;
}

Image trace(const SceneDescription& scene, const SceneTruths& truths, const SceneParts& parts = {}, int size = 16,
            unsigned threads = 0) {
    SceneTraceOptions options{.width = size, .height = size, .supersample = 2};
    options.threads = threads;
    options.indirectPaths = 64;
    return traceScene(scene, scene.camera, truths, {parts}, options).front();
}

const Light kSun{true, {0.6, 0, 0.8}, Rgb(kPi, kPi, 0), {}};

TEST(SceneTrace, IsTheTracerOfOneMesh) {
    SceneDescription scene = squareScene({false, {0.3, 0.2, 1.5}, Rgb(2, 1, 0.5), {}});
    scene.nodes[0].rotation = glm::angleAxis(0.4, glm::normalize(Vec3(1, 2, 0)));
    SceneTruths truths = lambertTruths(1);
    truths.materials[0].brdf = makeModel("ggx:alphax=0.3,alphay=0.5").f;
    const Mesh moved = transformed(square(), nodeTransforms(scene, 0)[0]);
    const Image expected = raytrace(moved, scene.camera, {scene.lights[0].light}, truths.materials[0].brdf,
                                    {.width = 24, .height = 24, .supersample = 2})
                               .radiance;
    EXPECT_EQ(trace(scene, truths, {}, 24).data(), expected.data());
}

TEST(SceneTrace, ShadowRaysAskForMapsAndMarks) {
    SceneDescription scene = squareScene(kSun);
    scene.nodes.resize(2, scene.nodes[0]);
    scene.nodes[1].translation = {3, 0, 4};  // right in the light's way
    const auto middle = [&](const SceneDescription& s, const SceneParts& parts) {
        return trace(s, lambertTruths(0.5), parts).at(8, 8, 0);
    };
    EXPECT_NEAR(middle(scene, {}), 0.4, 1e-6) << "no shadow asked for";
    scene.lights[0].shadow = SceneShadow{};
    EXPECT_EQ(middle(scene, {}), 0);
    SceneParts without;
    without.shadows = false;
    EXPECT_NEAR(middle(scene, without), 0.4, 1e-6);
    scene.nodes[1].castsShadow = false;
    EXPECT_NEAR(middle(scene, {}), 0.4, 1e-6);
    scene.nodes[1].castsShadow = true;
    scene.nodes[0].receivesShadow = false;
    EXPECT_NEAR(middle(scene, {}), 0.4, 1e-6);
}

/// A trench of width 8 and depth 4 along y, in the middle of 32 texels.
std::shared_ptr<const ReliefTruth> trench() {
    HeightMap map{Image(32, 32, 1), Wrap::Repeat};
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) map.heights.at(x, y, 0) = x >= 12 && x < 20 ? 0.0f : 4.0f;
    return std::make_shared<const ReliefTruth>(map);
}

/// Of the red channel: everything here is the same along y, but for noise.
double columnMean(const Image& image, int x) {
    double sum = 0;
    for (int y = 0; y < image.height(); ++y) sum += image.at(x, y, 0);
    return sum / image.height();
}

TEST(SceneTrace, ReliefShadowsItselfAndBouncesLight) {
    SceneDescription scene = squareScene(kSun);  // slope 4/3: the trench's shadow is 3 of its 7 texels wide
    scene.materials[0].relief = SceneRelief{};
    scene.materials[0].relief->asset = 0;
    scene.materials[0].relief->albedo = Rgb(0.5);
    SceneTruths truths = lambertTruths(0.5);
    truths.materials[0].relief = trench();
    const auto at = [&](const Image& image, double texel) {  // u over the picture's 1.8 of 2
        return columnMean(image, static_cast<int>(((texel / 32 * 2 - 1) / 1.8 + 0.5) * image.width()));
    };
    const Image direct = trace(scene, truths, {}, 128);
    EXPECT_NEAR(at(direct, 6), 0.4, 1e-6) << "on top";
    EXPECT_EQ(at(direct, 18.5), 0) << "in the shadow of the right wall";
    EXPECT_NEAR(at(direct, 14), 0.4, 1e-6) << "beyond it";
    SceneParts without;
    without.reliefShadow = false;
    EXPECT_NEAR(at(trace(scene, truths, without, 128), 18.5), 0.4, 1e-6);
    scene.materials[0].relief->indirectLight = 0;
    scene.materials[0].relief->bounces = 1;
    const Image bounced = trace(scene, truths, {}, 128);
    // The wall opposite is lit; its upper edge is 7 texels away and 4 up: of the cosine it takes (1 − cos φ)/2.
    const double taken = (1 - 7 / std::hypot(7, 4)) / 2;
    const double cosine = glm::dot(glm::normalize(Vec3(4, 0, 1)), kSun.position);
    EXPECT_NEAR(at(bounced, 18.5) / (0.5 * 0.5 * cosine * taken), 1, 0.05);
    EXPECT_NEAR(at(bounced, 6), 0.4, 1e-6) << "nothing over the top";
    EXPECT_EQ(bounced.at(3, 3, 2), 0) << "blue, of which the light has none";
}

TEST(SceneTrace, SurroundingIsBlockedByReliefAndMeshes) {
    SceneDescription scene = squareScene(kSun);
    scene.lights.clear();
    scene.materials[0].surrounding = SceneSurrounding{};
    scene.materials[0].ambient = Rgb(0.25);
    EnvMap white(EnvLayout::LatLong, 32);
    for (float& v : white.image.data()) v = 2;
    SceneTruths truths = lambertTruths(0);
    truths.materials[0].surrounding.diffuse = [](const Vec3&) { return Rgb(2 * 0.5); };
    truths.materials[0].diffuseSource = std::make_shared<const BrightTexels>(white);
    truths.materials[0].diffuseColor = Rgb(0.5);
    SceneParts occluded;
    occluded.occlusion = true;
    EXPECT_NEAR(trace(scene, truths).at(8, 8, 0), 1.25, 1e-6);
    EXPECT_NEAR(trace(scene, truths, occluded).at(8, 8, 0), 1.25, 1e-6) << "nothing is in the way";
    // A wall of the same size at the square's right edge, 45° of the sky in the plane across: form factor from the
    // middle of the edge's foot is known to be below 1/2; just what lies on each side.
    scene.nodes.resize(2, scene.nodes[0]);
    scene.nodes[1].translation = {1, 0, 1};
    scene.nodes[1].rotation = glm::angleAxis(-kPi / 2, Vec3(0, 1, 0));
    SceneTruths both = truths;
    scene.camera.eye = {0, 0, 1.5};
    scene.camera.near = 0.01;
    const Image dark = trace(scene, both, occluded, 32), light = trace(scene, both, {}, 32);
    EXPECT_NEAR(light.at(16, 16, 0), 1.25, 1e-6);
    EXPECT_LT(dark.at(28, 16, 0), 0.85 * 1.25) << "beside the wall";
    EXPECT_GT(dark.at(2, 16, 0), 0.85 * 1.25) << "far from it";
    // the trench
    scene.nodes.resize(1);
    scene.materials[0].relief = SceneRelief{};
    scene.materials[0].relief->asset = 0;
    truths.materials[0].relief = trench();
    const Image relief = trace(scene, truths, {}, 64);
    EXPECT_NEAR(columnMean(relief, 4), 1.25, 0.02) << "on top";
    // From the floor's middle the walls' upper edges are 4.5 texels away and 4 up: an endless trench leaves the sine.
    EXPECT_NEAR(columnMean(relief, 32), 1.25 * std::sin(std::atan(4.5 / 4)), 0.02);
}

TEST(SceneTrace, BackgroundTurnsWithTheSky) {
    SceneDescription scene;
    scene.sky.asset = 0;
    scene.assets.resize(1);
    scene.sky.rotationY = kPi / 2;
    SceneTruths truths;
    truths.sky = [](const Vec3& d) { return Rgb(d.x > 0.9, d.z < -0.9, 0); };
    const Image picture = trace(scene, truths);  // the camera looks along −z
    EXPECT_EQ(picture.rgb(8, 8), Rgb(1, 0, 0)) << "what was at +x has turned to −z";
    SceneParts none;
    none.sky = false;
    EXPECT_EQ(trace(scene, truths, none).rgb(8, 8), Rgb(0));
    scene.sky.asset = -1;
    scene.sky.color = Rgb(0.5);
    EXPECT_EQ(trace(scene, SceneTruths()).rgb(8, 8), Rgb(0.5)) << "an empty scene";
}

TEST(SceneTrace, SameBitsForAnyThreads) {
    SceneDescription scene = squareScene(kSun);
    scene.materials[0].relief = SceneRelief{};
    scene.materials[0].relief->asset = 0;
    scene.materials[0].relief->indirectLight = 0;
    scene.materials[0].ambient = Rgb(1);
    SceneTruths truths = lambertTruths(0.5);
    truths.materials[0].relief = trench();
    EXPECT_EQ(trace(scene, truths, {}, 16, 1).data(), trace(scene, truths, {}, 16, 7).data());
}

TEST(SceneTrace, RejectsBadOptions) {
    const SceneDescription scene = squareScene(kSun);
    SceneTraceOptions options;
    EXPECT_THROW(traceScene(scene, scene.camera, {}, {{}}, options), std::invalid_argument) << "no truths";
    options.supersample = 0;
    EXPECT_THROW(traceScene(scene, scene.camera, lambertTruths(1), {{}}, options), std::invalid_argument);
}

TEST(LobeTable, LinearEnvironmentHasClosedForm) {  // ∫ (2 + l·z) p dω = 2 + (n+1)/(n+2) r·z
    EnvMap env(EnvLayout::LatLong, 128);
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 256; ++x) env.image.setRgb(x, y, Rgb(2 + envTexelDirection(env.layout, 128, x, y).z));
    for (const double n : {1.0, 30.0}) {
        const EnvMap table = tabulateLobe(env, {.kind = LobeKind::Phong, .exponent = n}, {.perWidth = 6, .most = 48});
        for (const Vec3& r : {Vec3(0, 0, 1), Vec3(0, 1, 0), glm::normalize(Vec3(1, -2, -3))})
            EXPECT_NEAR(sampleEnv(table, r).r, 2 + (n + 1) / (n + 2) * r.z, 5e-3) << n;
    }
    EXPECT_LT(lobeTableResolution({.kind = LobeKind::Phong, .exponent = 1e6}), 3);
    EXPECT_THROW(tabulateLobe(env, {LobeKind::Mirror}), std::invalid_argument);
}

TEST(BrightTexels, DrawsItsDensity) {
    EnvMap map(EnvLayout::LatLong, 16);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x) map.image.setRgb(x, y, Rgb(x == 5 && y == 3 ? 1000 : 1 + 0.1 * y));
    const BrightTexels bright(map);
    // ∫ L dω = E[L / density]; Monte Carlo, 20000 points of a lattice
    Rgb sum(0), exact(0);
    for (int i = 0; i < 20000; ++i) {
        const Vec3 d =
            bright.draw({std::fmod(0.5 + 0.7548776662466927 * i, 1.0), std::fmod(0.5698402909980532 * i, 1.0)});
        sum += bright.radiance(d) * (1 + d.x) / bright.density(d) / 20000.0;
    }
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x)
            exact += map.image.rgb(x, y) * (1 + envTexelDirection(map.layout, 16, x, y).x) *
                     envSolidAngle(map.layout, 16, x, y);
    EXPECT_NEAR(sum.r / exact.r, 1, 5e-3);
    const BrightTexels black(EnvMap(EnvLayout::LatLong, 4));
    EXPECT_NEAR(black.density(black.draw({0.3, 0.7})), 1 / (4 * kPi), 1e-9);
    EXPECT_THROW(BrightTexels(EnvMap(EnvLayout::Cube, 4)), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
