// Whole scenes on the GPU: against the passes that draw single meshes, and the hard cases of scenes.
#include "shading/scene_renderer.hpp"

#include <epoxy/gl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include <glm/gtc/matrix_transform.hpp>

#include "core/asset.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "factorize/models/models.hpp"
#include "gpu_evaluate.hpp"
#include "reference/image_compare.hpp"
#include "scene_fixture.hpp"
#include "shading/environment_pass.hpp"
#include "shading/image_output.hpp"
#include "shading/lit_pass.hpp"
#include "shading/primitives.hpp"

namespace nacre {
namespace {

constexpr int kWidth = 160, kHeight = 120;

RenderTarget target() { return RenderTarget({.width = kWidth, .height = kHeight}); }

Image draw(SceneRenderer& renderer, double time = 0) {
    const RenderTarget to = target();
    renderer.render(to, time);
    return to.read();
}

double relative(const Image& a, const Image& b) { return compareImages(a, b, pictureWhite(b)).relative; }

class Scenes : public ::testing::Test {
protected:
    void SetUp() override { test::context(); }
    ProgramLoader loader_;
};

/// For looking at: NACRE_TEST_PICTURES names a folder.
void keep(const Image& image, const std::string& name) {
    if (const char* folder = std::getenv("NACRE_TEST_PICTURES"))
        writePng(image, std::filesystem::path(folder) / (name + ".png"), {pictureWhite(image)});
}

TEST_F(Scenes, FullSceneShowsEveryPart) {
    SceneRenderer renderer(loader_, test::fullScene());
    const Image all = draw(renderer);
    keep(all, "full");
    for (const float v : all.data()) ASSERT_TRUE(std::isfinite(v));
    struct Part {
        const char* words;
        SceneSwitches on;
    };
    std::vector<Part> parts = {{"lamps", {}},    {"ambient", {}},     {"relief", {}}, {"relief's shadows", {}},
                               {"indirect", {}}, {"surrounding", {}}, {"sky", {}},    {"fast Phong", {}},
                               {"shadows", {}}};
    parts[0].on.lamps = false;
    parts[1].on.ambient = false;
    parts[2].on.relief = false;
    parts[3].on.reliefShadow = BumpShadow::None;
    parts[4].on.indirect = false;
    parts[5].on.surrounding = false;
    parts[6].on.sky = false;
    parts[7].on.reflectance = SceneReflectance::FastPhong;
    parts[8].on.shadows = false;
    for (const Part& part : parts) {
        renderer.switches = part.on;
        const Image without = draw(renderer);
        keep(without, std::string("without ") + part.words);
        EXPECT_GT(relative(without, all), 2e-3) << part.words << " makes no difference";
    }
    renderer.switches = {};
    EXPECT_EQ(draw(renderer).data(), all.data()) << "switches leave traces";
    renderer.switches.reflectance = SceneReflectance::Direct;
    EXPECT_LT(relative(draw(renderer), all), 0.02) << "the factored BRDF and the model it was baked from";
}

TEST_F(Scenes, DrawsWhatThePassesDraw) {
    const SceneDescription full = test::fullScene();
    SceneDescription scene = full;
    scene.nodes = {full.nodes[1], full.nodes[0]};
    scene.tracks.clear();
    scene.materials[0].relief->indirectLight = -1;
    scene.lights.pop_back();
    scene.lights[0].shadow.reset();
    scene.sky.asset = -1;
    SceneRenderer renderer(loader_, scene);
    const Image picture = draw(renderer);

    const SceneAssets assets(scene.assets);
    const RenderTarget to = target();
    to.clear(glm::vec4(0, 0, 0, 1));
    const std::vector<glm::dmat4> nodes = nodeTransforms(scene, 0);
    EnvironmentSurface surface;
    surface.fromWorld = Mat3(glm::rotate(glm::dmat4(1), -0.7, Vec3(0, 1, 0)));
    surface.diffuse = {&*assets[test::kDiffuse].environment, 0, Rgb(0.3)};
    const BumpSurface relief{.map = &*assets[test::kWall].bump, .tiles = {3, 3}};
    LitView view{scene.camera, {scene.lights[0].light}, Rgb(0.02), nodes[1]};
    renderDirect(loader_, to, GpuMesh(scene.meshes[0].mesh), view, *directBrdf(makeModel("lambert:kd=0.6")), surface,
                 relief);
    surface.reflection = {&*assets[test::kSky].environment, 1, Rgb(1)};
    surface.diffuse.color = Rgb(0.2);
    surface.table = &*assets[test::kFresnel].table;
    view.ambient = Rgb(0);
    view.toWorld = nodes[0];
    renderFactored(loader_, to, GpuMesh(scene.meshes[1].mesh), view, *assets[test::kGlossy].brdf, surface);
    EXPECT_LT(relative(picture, to.read()), 1e-5);
}

TEST_F(Scenes, EmptySceneIsBackground) {
    SceneDescription scene;
    scene.sky.color = Rgb(0.25, 0.5, 1);
    SceneRenderer renderer(loader_, scene);
    const Image picture = draw(renderer);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(picture.at(5, 7, c), scene.sky.color[c]);
    EXPECT_TRUE(renderer.programs().empty());
    scene.meshes = {{"nothing", Mesh()}};
    scene.materials = {{}};
    scene.nodes.resize(1);
    scene.nodes[0].mesh = scene.nodes[0].material = 0;
    renderer.setScene(scene);
    EXPECT_EQ(draw(renderer).data(), picture.data()) << "a mesh without triangles";
}

TEST_F(Scenes, WithoutLightsAmbientAndSurroundingStay) {
    SceneDescription scene = test::fullScene();
    scene.lights.clear();
    scene.materials[0].relief->indirectLight = -1;
    SceneRenderer renderer(loader_, scene);
    const Image picture = draw(renderer);
    SceneRenderer lit(loader_, test::fullScene());
    lit.switches.lamps = false;
    EXPECT_EQ(picture.data(), draw(lit).data());
}

TEST_F(Scenes, MissingAssetIsNamed) {
    SceneDescription scene = test::fullScene();
    scene.assets[test::kWall].file = "/nowhere/wall.exr";
    const std::string message = tests::messageOf<Error>([&] { SceneRenderer(loader_, scene); });
    EXPECT_NE(message.find("asset 'wall': "), std::string::npos) << message;
    EXPECT_NE(message.find("/nowhere/wall.exr"), std::string::npos) << message;
}

TEST_F(Scenes, WhatDoesNotFitIsNamed) {
    const auto messageOf = [&](auto edit) {
        SceneDescription scene = test::fullScene();
        edit(scene);
        return tests::messageOf<Error>([&] { SceneRenderer(loader_, scene); });
    };
    EXPECT_EQ(messageOf([](SceneDescription& s) { s.materials[1].brdf = test::kWall; }),
              "material 'ball': brdf: expected an asset of kind brdf, found 'wall' of kind bump");
    EXPECT_EQ(messageOf([](SceneDescription& s) { s.materials[0].relief->roughness = true; }),
              "material 'floor': relief: expected normals with roughness in 'wall', found none");
    EXPECT_EQ(messageOf([](SceneDescription& s) {
                  for (glm::vec2& uv : s.meshes[0].mesh.uvs) uv.y = 0.5f;  // a line
              }),
              "node 'floor': expected a mesh with uv for the relief of 'floor', found none in 'square'");
    EXPECT_NE(messageOf([](SceneDescription& s) { s.materials[2].model = "wood"; }).find("material 'ring': model: "),
              std::string::npos);
    EXPECT_EQ(messageOf([](SceneDescription& s) { s.sky.asset = test::kFresnel; }),
              "sky: asset: expected an asset of kind environment, found 'fresnel' of kind fresnel");
    SceneDescription scene = test::fullScene();
    scene.nodes[2].material = 9;
    EXPECT_THROW(SceneRenderer(loader_, scene), std::invalid_argument);
    scene = test::fullScene();
    scene.lights.resize(9, scene.lights[0]);
    scene.file = "nine.json";
    EXPECT_EQ(tests::messageOf<Error>([&] { SceneRenderer(loader_, scene); }),
              "nine.json: expected at most 8 lights, found 9");
}

TEST_F(Scenes, InstancesShareAMeshAndMirroredOnesAreMirrored) {
    SceneDescription scene = test::fullScene();
    SceneDescription copies = scene;
    const std::vector<glm::dmat4> nodes = nodeTransforms(scene, 0.5);
    copies.meshes.push_back({"copy", transformed(scene.meshes[2].mesh, nodes[2])});
    copies.meshes.push_back({"mirrored copy", transformed(scene.meshes[2].mesh, nodes[3])});
    for (const int i : {2, 3}) {
        copies.nodes[static_cast<std::size_t>(i)] = SceneNode{};
        copies.nodes[static_cast<std::size_t>(i)].mesh = i + 1;
        copies.nodes[static_cast<std::size_t>(i)].material = 2;
    }
    copies.tracks.clear();
    SceneRenderer instances(loader_, scene), baked(loader_, copies);
    EXPECT_LT(relative(draw(instances, 0.5), draw(baked, 0.5)), 5e-3);
    EXPECT_GT(relative(draw(instances, 0.5), draw(instances, 1.5)), 0.02) << "nothing turns";
    EXPECT_EQ(draw(instances, 0.5).data(), draw(instances, 4.5).data()) << "the animation repeats";
}

/// Names of GL objects in use.
std::size_t glObjects() {
    std::size_t count = 0;
    for (GLuint name = 1; name < 20000; ++name)
        count += glIsTexture(name) + glIsBuffer(name) + glIsFramebuffer(name) + glIsRenderbuffer(name) +
                 glIsVertexArray(name) + glIsQuery(name) + glIsProgram(name) + glIsShader(name);
    return count;
}

std::size_t residentBytes() {
    std::ifstream file("/proc/self/statm");
    std::size_t total = 0, resident = 0;
    file >> total >> resident;
    return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

TEST_F(Scenes, HundredFramesDoNotGrow) {
    SceneRenderer renderer(loader_, test::fullScene());
    renderer.setTiming(true);
    const RenderTarget to = target();
    std::size_t objects = 0, bytes = 0;
    for (int frame = 0; frame < 100; ++frame) {
        SceneLight spot = renderer.scene().lights[1];
        spot.light.position.x = 1.2 + 0.1 * std::sin(0.3 * frame);
        renderer.setLight(1, spot);
        renderer.render(to, 0.05 * frame);
        if (frame == 10) objects = glObjects(), bytes = residentBytes();
    }
    EXPECT_EQ(glObjects(), objects);
#ifndef __SANITIZE_ADDRESS__                         // it keeps freed memory for a while, to tell of its use
    EXPECT_LT(residentBytes(), bytes + (4u << 20));  // pages that allocators and the driver's threads take once
#else
    EXPECT_GT(bytes, 0u);
#endif
}

TEST_F(Scenes, BouncedLightIsMadeAgainOnlyWhenItsLightMoves) {
    SceneRenderer renderer(loader_, test::fullScene());
    renderer.setTiming(true);
    const auto seconds = [&] {
        draw(renderer);
        for (const PassTime& pass : renderer.passes())
            if (pass.name == "relief light") return pass.wallSeconds;
        return -1.0;
    };
    const Image first = draw(renderer);
    double still = seconds();
    for (int i = 0; i < 5; ++i) still = std::min(still, seconds());
    EXPECT_GE(still, 0);
    EXPECT_LT(still, 1e-3) << "nothing moved";
    SceneLight spot = renderer.scene().lights[1];
    spot.light.position = {-1.5, 2.0, 1.0};
    spot.light.cone->axis = glm::normalize(Vec3(0, -0.5, 0) - spot.light.position);
    renderer.setLight(1, spot);
    const Image moved = draw(renderer);
    EXPECT_GT(relative(moved, first), 0.02);
    SceneDescription scene = renderer.scene();
    SceneRenderer fresh(loader_, scene);
    EXPECT_EQ(draw(fresh).data(), moved.data());
}

double secondsOf(SceneRenderer& renderer, const char* pass, double time) {
    const RenderTarget to = target();
    renderer.render(to, time);
    for (const PassTime& p : renderer.passes())
        if (p.name == pass) return p.wallSeconds;
    return -1;
}

TEST_F(Scenes, ShadowMapsAreDrawnAgainOnlyWhenSomethingMoved) {
    SceneDescription scene = test::fullScene();
    for (SceneLight& light : scene.lights) light.shadow->size = 2048;
    SceneRenderer renderer(loader_, scene);
    renderer.setTiming(true);
    secondsOf(renderer, "shadow maps", 0.5);
    double moving = 1, still = 1;
    for (int i = 1; i <= 5; ++i) moving = std::min(moving, secondsOf(renderer, "shadow maps", 0.5 + 0.1 * i));
    for (int i = 1; i <= 5; ++i) still = std::min(still, secondsOf(renderer, "shadow maps", 1.0));
    EXPECT_LT(still, 0.2 * moving);
    const Image turned = draw(renderer, 1.0);
    SceneRenderer fresh(loader_, scene);
    EXPECT_EQ(draw(fresh, 1.0).data(), turned.data()) << "a map that is out of date";
}

TEST_F(Scenes, CastingAndReceivingAreMarks) {
    SceneDescription scene = test::fullScene();
    SceneRenderer renderer(loader_, scene);
    const Image all = draw(renderer);
    renderer.switches.shadows = false;
    const Image none = draw(renderer);
    for (SceneNode& node : scene.nodes) node.castsShadow = false;
    SceneRenderer casting(loader_, scene);
    EXPECT_LT(relative(draw(casting), none), 1e-3) << "nobody casts";
    scene = test::fullScene();
    for (SceneNode& node : scene.nodes) node.receivesShadow = false;
    SceneRenderer receiving(loader_, scene);
    EXPECT_EQ(draw(receiving).data(), none.data()) << "nobody receives";
    EXPECT_GT(relative(none, all), 1e-2);
}

TEST_F(Scenes, PassesAreTimedWhenAskedFor) {
    SceneRenderer renderer(loader_, test::fullScene());
    draw(renderer);
    EXPECT_TRUE(renderer.passes().empty());
    renderer.setTiming(true);
    draw(renderer);
    std::vector<std::string> names;
    for (const PassTime& pass : renderer.passes()) {
        names.push_back(pass.name);
        EXPECT_GE(pass.wallSeconds, 0);
        EXPECT_GE(pass.gpuSeconds, 0);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"relief light", "shadow maps", "surfaces", "sky"}));
}

TEST_F(Scenes, ProgramsAreOneForEachCombination) {
    const SceneDescription scene = test::fullScene();
    SceneRenderer renderer(loader_, scene);
    const std::vector<ListedProgram> programs = renderer.programs();
    ASSERT_EQ(programs.size(), 4u);
    EXPECT_EQ(programs[2].nodes, (std::vector<int>{2, 3})) << "both tori";
    EXPECT_EQ(programs[3].program.fragment, "sky.frag.glsl");
    std::vector<AssetTraits> traits;  // as from files, without a GPU
    for (const SceneAsset& asset : scene.assets) traits.push_back(traitsOf(readAsset(asset.file), asset.name));
    const std::vector<ListedProgram> listed = scenePrograms(scene, traits);
    ASSERT_EQ(listed.size(), programs.size());
    for (std::size_t i = 0; i < listed.size(); ++i) EXPECT_EQ(listed[i].program, programs[i].program);
}

TEST_F(Scenes, ChangedAssetsAreLoadedAndBrokenOnesReported) {
    const tests::Scratch folder;
    SceneDescription scene = test::fullScene();
    const std::filesystem::path file = folder / "glossy.exr";
    std::filesystem::copy_file(scene.assets[test::kGlossy].file, file);
    scene.assets[test::kGlossy].file = file;
    SceneRenderer renderer(loader_, scene);
    const Image first = draw(renderer);
    EXPECT_TRUE(renderer.reloadAssets().empty());

    writeFile(file, "no picture");
    std::vector<AssetChange> changes = renderer.reloadAssets();
    ASSERT_EQ(changes.size(), 1u);
    EXPECT_EQ(changes[0].name, "glossy");
    EXPECT_NE(changes[0].problem.find(file.string()), std::string::npos) << changes[0].problem;
    EXPECT_EQ(draw(renderer).data(), first.data()) << "the last good one stays";
    EXPECT_TRUE(renderer.reloadAssets().empty()) << "reported once";

    std::filesystem::copy_file(scene.assets[test::kWall].file, file, std::filesystem::copy_options::overwrite_existing);
    changes = renderer.reloadAssets();
    ASSERT_EQ(changes.size(), 1u);
    EXPECT_NE(changes[0].problem.find("material 'ball': brdf: "), std::string::npos) << changes[0].problem;
    EXPECT_EQ(draw(renderer).data(), first.data());

    Asset other = readAsset(scene.assets[test::kGlossy].file.parent_path() / "glossy.exr");
    std::filesystem::remove(file);
    changes = renderer.reloadAssets();
    ASSERT_EQ(changes.size(), 1u);
    EXPECT_NE(changes[0].problem, "") << "gone";
}

TEST_F(Scenes, EditsAreCheckedAndTakeEffect) {
    SceneRenderer renderer(loader_, test::fullScene());
    const Image first = draw(renderer);
    renderer.setNodeMaterial(1, 2);
    EXPECT_GT(relative(draw(renderer), first), 1e-2);
    EXPECT_THROW(renderer.setNodeMaterial(1, 7), std::invalid_argument);
    renderer.setNodeMaterial(1, 1);
    SceneMaterial ball = renderer.scene().materials[1];
    ball.brdf = test::kWall;
    EXPECT_THROW(renderer.setMaterial(1, ball), Error);
    SceneSky sky = renderer.scene().sky;
    sky.rotationY = NAN;
    EXPECT_THROW(renderer.setSky(sky), std::invalid_argument);
    EXPECT_EQ(draw(renderer).data(), first.data());
    renderer.setScene(test::fullScene());
    EXPECT_EQ(draw(renderer).data(), first.data());
}

TEST(ScenesInEs3, LookTheSame) {
    test::context();
    Image desktop;
    {
        ProgramLoader loader;
        SceneRenderer renderer(loader, test::fullScene());
        desktop = draw(renderer);
    }
    test::context(GlApi::Es3);
    ProgramLoader loader(Glsl::Es300);
    SceneRenderer renderer(loader, test::fullScene());
    renderer.setTiming(true);
    EXPECT_LT(relative(draw(renderer), desktop), 1e-3);
    EXPECT_TRUE(std::isnan(renderer.passes().front().gpuSeconds));
}

}  // namespace
}  // namespace nacre
