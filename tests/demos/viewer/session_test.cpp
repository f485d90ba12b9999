// What the viewer shows, without its window: edits that fail, files that change, a context that is lost.
#include "demos/viewer/session.hpp"

#include <gmock/gmock.h>

#include <optional>

#include "bump/bump_asset.hpp"
#include "bump/normals.hpp"
#include "core/asset.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "demos/viewer/orbit.hpp"
#include "shading/context.hpp"
#include "tests/core/scratch.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

const char* const kScene = R"({"nacre_scene": 1,
 "meshes": {"torus": {"torus": {}}},
 "materials": {"clay": {"model": "lambert:kd=0.5"}, "shiny": {"model": "blinn-phong:kd=0.1,ks=0.6,n=30"}},
 "nodes": {"it": {"mesh": "torus", "material": "clay"}},
 "lights": {"sun": {"type": "directional", "direction": [-1, -1, -1], "intensity": 3}},
 "camera": {"eye": [0, 2, 4]}})";

class Session : public ::testing::Test {
protected:
    Session() { write(kScene); }

    void write(const std::string& text) const { writeFile(file(), text); }
    fs::path file() const { return scratch_ / "scene.json"; }
    void replaceIn(std::string text, const std::string& from, const std::string& to) const {
        write(text.replace(text.find(from), from.size(), to));
    }
    ViewerSession open() const {
        ViewerSession session({file(), {}, 1});
        session.resize(48, 32);
        EXPECT_TRUE(session.draw());
        return session;
    }
    /// A relief: normals alone.
    void writeSpike() const {
        HeightMap heights{Image(8, 8, 1), Wrap::Repeat};
        heights.heights.at(3, 4, 0) = 2;
        BumpMaps maps{8, 8, Wrap::Repeat, {}, {}, {}, {}, {}, {}};
        maps.normals = makeNormals(heights);
        writeAsset(toAsset(maps), scratch_ / "spike.exr");
    }
    static std::vector<float> pixels(ViewerSession& session) {
        session.draw();
        return session.target()->read().data();
    }

    tests::Scratch scratch_;
    std::optional<Context> context_{std::in_place};
};

TEST_F(Session, DrawsOnlyWhatHasChanged) {
    ViewerSession session = open();
    EXPECT_FALSE(session.draw());
    session.touch();
    EXPECT_TRUE(session.draw());
    session.resize(0, 0);  // minimised
    EXPECT_FALSE(session.draw());
    session.resize(48, 32);
    EXPECT_TRUE(session.draw());
    session.advance(1);  // the scene has no animation
    EXPECT_FALSE(session.draw());
    EXPECT_EQ(session.pictures(), 3);
}

TEST_F(Session, AnEditThatFailsChangesNothing) {
    ViewerSession session = open();
    const std::vector<float> before = pixels(session);
    EXPECT_FALSE(session.setNodeMaterial(0, std::string("no-such-model:x=1")));
    EXPECT_THAT(session.problems(), ElementsAre(Pair("material", HasSubstr("no-such-model"))));
    EXPECT_FALSE(session.replaceAsset(7, "a.exr"));
    EXPECT_FALSE(session.open(scratch_ / "absent.json"));
    EXPECT_EQ(pixels(session), before);
    EXPECT_TRUE(session.setNodeMaterial(0, 1));
    EXPECT_EQ(session.problems().count("material"), 0u);
    EXPECT_NE(pixels(session), before);
    EXPECT_TRUE(session.setNodeMaterial(0, std::string("lambert:kd=0.5")));  // the scene's own
    EXPECT_EQ(session.scene().materials.size(), 2u);
    EXPECT_EQ(pixels(session), before);
}

TEST_F(Session, AReliefIsAddedAndTakenAway) {
    writeSpike();
    ViewerSession session = open();
    const std::vector<float> before = pixels(session);
    EXPECT_FALSE(session.setRelief(0, scratch_ / "absent.exr"));
    EXPECT_THAT(session.problems(), ElementsAre(Pair("relief", HasSubstr("absent.exr"))));
    EXPECT_EQ(pixels(session), before);
    EXPECT_TRUE(session.setRelief(0, scratch_ / "spike.exr")) << session.problems().begin()->second;
    EXPECT_EQ(session.scene().materials[0].relief.value().shadow, BumpShadow::None);  // it holds normals alone
    EXPECT_NE(pixels(session), before);
    EXPECT_TRUE(session.setRelief(0, {}));
    EXPECT_THAT(session.problems(), IsEmpty());
    EXPECT_EQ(pixels(session), before);
}

TEST_F(Session, AMeshWithoutUvTakesNoRelief) {
    writeSpike();
    writeFile(scratch_ / "bare.obj", "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n");
    std::string scene = kScene;
    scene.replace(scene.find(R"("torus": {"torus": {}})"), 0, R"("bare": {"file": "bare.obj"}, )");
    scene.replace(scene.find(R"("it": {)"), 0, R"("other": {"mesh": "bare", "material": "shiny"}, )");
    write(scene);
    ViewerSession session = open();
    const std::vector<float> before = pixels(session);
    EXPECT_FALSE(session.setRelief(1, scratch_ / "spike.exr"));
    EXPECT_THAT(session.problems(), ElementsAre(Pair("relief", HasSubstr("node 'other': expected a mesh with uv"))));
    EXPECT_EQ(pixels(session), before);
    EXPECT_TRUE(session.setRelief(0, scratch_ / "spike.exr"));
    EXPECT_FALSE(session.setNodeMaterial(1, 0));  // the one that has the relief now
    EXPECT_THAT(session.problems(), ElementsAre(Pair("material", HasSubstr("node 'other': expected a mesh with uv"))));
}

TEST_F(Session, ReadsTheSceneAgainAndKeepsTheView) {
    ViewerSession session = open();
    const std::vector<float> before = pixels(session);
    session.move(orbited(session.camera, {10, 5}, 32));
    const Camera moved = session.camera;
    EXPECT_FALSE(session.poll());
    replaceIn(kScene, "kd=0.5", "kd=0.25");
    EXPECT_TRUE(session.poll());
    EXPECT_THAT(session.problems(), IsEmpty());
    EXPECT_EQ(session.scene().materials[0].model, "lambert:kd=0.25");
    EXPECT_EQ(session.camera.eye, moved.eye);
    replaceIn(kScene, "[0, 2, 4]", "[0, 2, 5]");  // another camera in the file is meant
    EXPECT_TRUE(session.poll());
    EXPECT_EQ(session.camera.eye, Vec3(0, 2, 5));
}

TEST_F(Session, ABrokenSceneKeepsTheLastGoodOne) {
    ViewerSession session = open();
    const std::vector<float> before = pixels(session);
    write("{ broken");
    EXPECT_TRUE(session.poll());
    EXPECT_THAT(session.problems(), ElementsAre(Pair("scene", HasSubstr("scene.json"))));
    EXPECT_EQ(pixels(session), before);
    EXPECT_FALSE(session.poll());
    write(kScene);
    EXPECT_TRUE(session.poll());
    EXPECT_THAT(session.problems(), IsEmpty());
    EXPECT_EQ(pixels(session), before);
}

TEST_F(Session, ReadsShadersAgainAndKeepsTheLastGoodOnes) {
    const fs::path shaders = scratch_ / "shaders";
    fs::copy(shaderFolder(), shaders, fs::copy_options::recursive);
    setenv("NACRE_SHADERS", shaders.c_str(), 1);
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    ViewerSession session = open();
    unsetenv("NACRE_SHADERS");
    const std::vector<float> before = pixels(session);
    const std::string good = readShader({shaders}, "scene.frag.glsl").text;
    writeFile(shaders / "scene.frag.glsl", good + "\nthis is no GLSL\n");
    EXPECT_TRUE(session.poll());
    EXPECT_THAT(session.problems(), ElementsAre(Pair("shaders", HasSubstr("scene.frag.glsl"))));
    session.touch();
    EXPECT_EQ(pixels(session), before);
    writeFile(shaders / "scene.frag.glsl", good + "\n");
    EXPECT_TRUE(session.poll());
    EXPECT_THAT(session.problems(), IsEmpty());
    EXPECT_EQ(pixels(session), before);
}

TEST_F(Session, GoesOnInANewContextAfterALostOne) {
    auto session = std::make_unique<ViewerSession>(open());
    session->setNodeMaterial(0, std::string("phong:kd=0.2,ks=0.3,n=10"));
    session->move(orbited(session->camera, {10, 5}, 32));
    const std::vector<float> before = pixels(*session);
    const SessionState last = session->state();
    session.reset();
    context_.emplace();
    ViewerSession next({file(), {}, 1});
    next.restore(last);
    next.resize(48, 32);
    EXPECT_EQ(pixels(next), before);
}

TEST_F(Session, ScreenshotsDontOverwriteEachOther) {
    const Image image(4, 4, 3);
    const fs::path first = writeScreenshot(image, scratch_.folder(), 1);
    const fs::path second = writeScreenshot(image, scratch_.folder(), 1);
    EXPECT_NE(first, second);
    for (const fs::path& file : {first, second}) {
        EXPECT_TRUE(fs::is_regular_file(file));
        EXPECT_TRUE(fs::is_regular_file(fs::path(file).replace_extension(".exr")));
    }
    EXPECT_THAT(tests::messageOf<Error>([&] { writeScreenshot(image, scratch_ / "absent", 1); }), HasSubstr("absent"));
}

TEST_F(Session, APictureOfAnotherSizeIsTheMeanOfALargerOne) {
    ViewerSession session = open();
    const Image fine = session.pictureOf(48, 32, 1), mean = session.pictureOf(24, 16, 2);
    EXPECT_EQ(fine.data(), pixels(session));
    for (int i = 0; i < 24 * 16; ++i) {
        const int x = i % 24, y = i / 24;
        const Rgb sum = fine.rgb(2 * x, 2 * y) + fine.rgb(2 * x + 1, 2 * y) + fine.rgb(2 * x, 2 * y + 1) +
                        fine.rgb(2 * x + 1, 2 * y + 1);
        EXPECT_LT(glm::length(mean.rgb(x, y) - 0.25 * sum), 1e-6) << i;
    }
}

TEST_F(Session, LevelsOfShadowsFollowLightsAndScenes) {
    const std::string lamp = R"("lamp": {"type": "point", "position": [0, 3, 0], "intensity": 20, "shadow": true,
        "area": {"u": [0.3, 0, 0], "v": [0, 0, 0.3]}})";
    std::string scene = kScene;
    const std::string sun = R"("sun": {"type": "directional", "direction": [-1, -1, -1], "intensity": 3})";
    scene.replace(scene.find(sun), sun.size(), lamp);
    scene.replace(scene.find(R"("torus": {"torus": {}})"), 22,
                  R"("torus": {"torus": {}}, "floor": {"quad": {"size": 9}})");
    scene.replace(
        scene.find(R"("nodes": {)"), 10,
        R"("nodes": {"floor": {"mesh": "floor", "material": "clay", "translation": [0, -2, 0], "axis": [1, 0, 0],
                     "angleDeg": -90}, )");
    write(scene);
    ViewerSession session = open();
    const auto dark = [&](bool shadows) {
        session.switches.shadows = shadows;
        session.touch();
        double sum = 0;
        for (const float v : pixels(session)) sum += v;
        return sum;
    };
    session.switches.shadowMethod = ShadowMethod::Levels;
    const double shadowed = dark(true), bare = dark(false);
    EXPECT_LT(shadowed, 0.97 * bare);
    SceneLight moved = session.scene().lights[0];
    moved.light.position = {9, 3, 0};
    ASSERT_TRUE(session.setLight(0, moved));
    EXPECT_NE(dark(true), shadowed);
    // An object moved is the picture of a scene that has it there, its shadow too.
    session.switches.shadows = true;
    ASSERT_TRUE(session.setNodeTranslation(0, {0, -1.5, 0}));
    const std::vector<float> after = pixels(session);
    write([&] {
        std::string other = scene;
        other.replace(other.find("[0, -2, 0]"), 10, "[0, -1.5, 0]");
        other.replace(other.find("[0, 3, 0]"), 9, "[9, 3, 0]");
        return other;
    }());
    session.reload();
    EXPECT_EQ(session.scene().nodes[0].translation.y, -1.5);
    EXPECT_EQ(pixels(session), after);
    write(kScene);  // a directional light without shadow, and other meshes
    session.reload();
    EXPECT_THAT(session.problems(), IsEmpty());
    EXPECT_EQ(dark(true), dark(false));
    session.switches.lightPoints = 0;
    session.touch();
    session.draw();
    EXPECT_THAT(session.problems(), ElementsAre(Pair("picture", HasSubstr("points"))));
}

TEST_F(Session, AMissingFileIsNamed) {
    EXPECT_THAT(tests::messageOf<Error>([&] {
                    ViewerSession({scratch_ / "absent.json", {}, 1});
                }),
                HasSubstr("absent.json"));
    EXPECT_THAT(tests::messageOf<Error>([&] {
                    ViewerSession({scratch_ / "absent.obj", {}, 1});
                }),
                HasSubstr("absent.obj"));
}

/// A target that no level meets: while it moves the least is drawn; at rest all comes back, one level a picture.
TEST_F(Session, QualityGivesWayWhileItMovesAndComesBack) {
    std::string room = kScene;
    room.replace(room.find("\"nodes\": {"), 10, R"("nodes": {"glass": {"mesh": "wall", "material": "glass"},)");
    room.replace(room.find("\"meshes\": {"), 11, R"("meshes": {"wall": {"quad": {"size": 2, "steps": 1}},)");
    room.replace(room.find("\"materials\": {"), 14, R"("materials": {"glass": {"specular": {"ior": 1.5}},)");
    write(room);
    ViewerSession session = open();
    const std::size_t all = session.renderer().schedule().views.size();
    EXPECT_EQ(all, 3u) << "the camera's, refracted, reflected";
    const std::vector<float> full = pixels(session);
    session.quality.emplace(1e-6);
    for (int i = 0; i < 2 * kQualityLevels; ++i) {
        session.touch();
        EXPECT_TRUE(session.draw());
    }
    EXPECT_STREQ(qualityName(session.quality->level()), "least");
    EXPECT_EQ(session.renderer().schedule().views.size(), 2u) << "without the weak reflection";
    for (int i = 1; i < kQualityLevels; ++i) {
        EXPECT_TRUE(session.refines());
        EXPECT_TRUE(session.draw());
    }
    EXPECT_FALSE(session.refines());
    EXPECT_FALSE(session.draw()) << "nothing to gain";
    EXPECT_EQ(session.renderer().schedule().views.size(), all);
    EXPECT_EQ(pixels(session), full);
}

}  // namespace
}  // namespace nacre
