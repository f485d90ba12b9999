// The viewer as a program, on a screen in memory, moved by real key and mouse events.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/image_file.hpp"
#include "demos/viewer/light_drag.hpp"
#include "demos/viewer/orbit.hpp"
#include "demos/viewer/scene_edits.hpp"
#include "demos/viewer/session.hpp"
#include "shading/context.hpp"
#include "shading/image_output.hpp"
#include "shading/scene_file.hpp"
#include "tests/demos/viewer/display.hpp"

namespace nacre {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using tests::Child;
using tests::Display;
using tests::Scratch;
using tests::Viewer;

constexpr int kWidth = 200, kHeight = 150;
// Cameras differ by rounding, so that a pixel at a silhouette may fall on its other side.
constexpr double kSame = 1e-4, kEdgePixels = 0.002;
// [dB] The model itself, drawn and traced: only a rim of pixels differs, where interpolated normals turn away from the
// eye. Measured 39.7 at this size, 42.6 at twice the edges.
constexpr double kSilhouettes = 36;

const char* const kScene = R"({"nacre_scene": 1,
 "meshes": {"torus": {"torus": {}}},
 "materials": {"paint": {"model": "blinn-phong:kd=0.6/0.3/0.1,ks=0.3,n=30"}, "clay": {"model": "lambert:kd=0.5"}},
 "nodes": {"it": {"mesh": "torus", "material": "paint"}},
 "lights": {"sun": {"type": "directional", "direction": [-1, -1, -1], "intensity": 3}},
 "sky": {"color": [0.05, 0.06, 0.08]},
 "camera": {"eye": [0, 2, 4]}})";

Vec3 eyeOf(const json& line) {
    const json& eye = line.at("camera").at("eye");
    return {eye[0].get<double>(), eye[1].get<double>(), eye[2].get<double>()};
}

bool settled(const json& line) { return line.at("settled").get<bool>(); }

/// Share of the pixels of which a channel differs by more than kSame.
double differing(const Image& a, const Image& b) {
    EXPECT_EQ(a.data().size(), b.data().size());
    std::size_t count = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) {
            double most = 0;
            for (int c = 0; c < 3; ++c) most = std::max<double>(most, std::abs(a.at(x, y, c) - b.at(x, y, c)));
            count += most > kSame;
        }
    return static_cast<double>(count) / (a.width() * a.height());
}

class ViewerWindow : public ::testing::Test {
protected:
    ViewerWindow() { writeFile(file(), kScene); }
    std::string file() const { return (scratch_ / "scene.json").string(); }
    std::vector<std::string> words() const {
        return {file(), "--size", "200x150", "--no-panel", "--white", "1", "--screenshots", scratch_.folder().string()};
    }
    /// What the renderer draws with the scene's camera after a drag.
    Image expected(Vec2 drag) const {
        const Context context;
        ViewerSession session({file(), {}, 1});
        session.resize(kWidth, kHeight);
        if (drag != Vec2(0)) session.move(orbited(session.camera, drag, kHeight));
        session.draw();
        return session.target()->read();
    }
    Scratch scratch_;
};

TEST_F(ViewerWindow, ADragOrbitsAndAScreenshotIsTheRenderersPicture) {
    const Display display;
    Viewer viewer(display, words());
    const json first = viewer.until(settled);
    const int left = first["window"][0], top = first["window"][1];
    const auto at = [&](int x, int y) {
        return std::vector<std::string>{"mousemove", std::to_string(left + x), std::to_string(top + y)};
    };
    display.send(at(60, 70));
    display.send({"mousedown", "1"});
    display.send(at(100, 90));
    display.send({"mouseup", "1"});
    Camera camera;
    camera.eye = {0, 2, 4};
    const Vec3 eye = orbited(camera, {40, 20}, kHeight).eye;
    viewer.until([&](const json& line) { return glm::length(eyeOf(line) - eye) < 1e-9 && settled(line); });
    display.send({"mousemove", "790", "470"});  // the pointer off the picture
    display.send({"key", "s"});
    const json shot = viewer.until([](const json& line) { return line["screenshot"] != "" && settled(line); });

    const std::string png = shot["screenshot"];
    const Image picture = readImageFile(std::filesystem::path(png).replace_extension(".exr")).image;
    EXPECT_LE(differing(picture, expected({40, 20})), kEdgePixels);
    EXPECT_GT(differing(picture, expected({0, 0})), 0.2);  // the drag is seen
    // And the screen shows it, tone-mapped, within a code.
    const std::vector<std::uint8_t> shown = display.codes(left, top, kWidth, kHeight), wanted = toneMap(picture, {1});
    int worst = 0;
    for (std::size_t i = 0; i < shown.size(); ++i) worst = std::max(worst, std::abs(shown[i] - wanted[i]));
    EXPECT_LE(worst, 1);
}

TEST_F(ViewerWindow, KeysAndWheelDoWhatTheHelpSays) {
    const Display display;
    Viewer viewer(display, words());
    const json first = viewer.until(settled);
    const int left = first["window"][0], top = first["window"][1];
    const auto before = display.codes(left, top, kWidth, kHeight);
    display.send({"key", "F1"});
    viewer.until([](const json& line) { return line["help"] == true && settled(line); });
    EXPECT_NE(display.codes(left, top, kWidth, kHeight), before);
    display.send({"key", "Escape"});
    viewer.until([](const json& line) { return line["help"] == false && settled(line); });
    EXPECT_EQ(display.codes(left, top, kWidth, kHeight), before);
    display.send({"mousemove", std::to_string(left + 100), std::to_string(top + 75), "click", "4"});
    viewer.until([&](const json& line) { return glm::length(eyeOf(line)) < 0.91 * glm::length(eyeOf(first)); });
    display.send({"key", "Home"});
    viewer.until([&](const json& line) { return eyeOf(line) == eyeOf(first); });
    display.send({"key", "Tab"});
    const json panel = viewer.until([](const json& line) { return line["panel"] == true && settled(line); });
    EXPECT_GT(panel["origin"], 0);
    display.send({"key", "Escape"});
    EXPECT_EQ(viewer.code(), 0);
}

TEST_F(ViewerWindow, AClickChoosesAMeshAndControlDragTurnsTheLight) {
    const Display display;
    Viewer viewer(display, words());
    const json first = viewer.until(settled);
    EXPECT_EQ(first["node"], -1);
    const SceneDescription scene = readScene(file());
    Vec2 pixel(0, kHeight / 2 + 0.5);
    while (nodeAt(scene, nodeTransforms(scene, 0), scene.camera, pixel + Vec2(4, 0), {kWidth, kHeight}) < 0) ++pixel.x;
    const auto at = [&](double x, double y) {
        return std::vector<std::string>{"mousemove", fmt::format("{:.0f}", x + first["window"][0].get<int>()),
                                        fmt::format("{:.0f}", y + first["window"][1].get<int>())};
    };
    display.send(at(pixel.x + 4, kHeight / 2));
    display.send({"click", "1"});
    viewer.until([](const json& line) { return line["node"] == 0; });
    display.send({"key", "n"});  // the mesh's next material: clay comes before paint
    viewer.until([&](const json& line) { return line["materials"] != first["materials"]; });

    display.send({"keydown", "ctrl"});
    display.send({"mousedown", "1"});
    display.send(at(pixel.x + 34, kHeight / 2 + 10));
    display.send({"mouseup", "1"});
    display.send({"keyup", "ctrl"});
    const Light sun = dragged(scene.lights[0].light, scene.camera, {30, 10}, kHeight);
    const json turned = viewer.until([&](const json& line) {
        const json& p = line["lights"][0];
        return glm::length(Vec3(p[0].get<double>(), p[1].get<double>(), p[2].get<double>()) - sun.position) < 1e-9;
    });
    EXPECT_EQ(turned["camera"], first["camera"]);
}

TEST_F(ViewerWindow, ShowsABrokenScenesMessageAndTheLastGoodPicture) {
    const Display display;
    Viewer viewer(display, words());
    const json first = viewer.until(settled);
    const auto before = display.codes(first["window"][0], first["window"][1], kWidth, kHeight);
    writeFile(file(), "{ broken");
    const json broken = viewer.until([](const json& line) { return !line["problems"].empty() && settled(line); });
    EXPECT_THAT(broken["problems"]["scene"].get<std::string>(), HasSubstr("scene.json"));
    EXPECT_EQ(display.codes(first["window"][0], first["window"][1], kWidth, kHeight), before);
    std::string other = kScene;
    writeFile(file(), other.replace(other.find("[0, 2, 4]"), 9, "[0, 2, 5]"));
    viewer.until([](const json& line) { return line["problems"].empty() && eyeOf(line) == Vec3(0, 2, 5); });
}

TEST_F(ViewerWindow, AWindowOfOnePixelAndAHiddenOneComeBack) {
    const Display display;
    Viewer viewer(display, words());
    const json first = viewer.until(settled);
    const auto before = display.codes(first["window"][0], first["window"][1], kWidth, kHeight);
    display.send({"search", "--name", "^nacre: ", "windowsize", "1", "1"});
    viewer.until([](const json& line) { return line["width"] == 1 && line["height"] == 1 && settled(line); });
    display.send({"search", "--name", "^nacre: ", "windowsize", "200", "150"});
    const json again = viewer.until(
        [](const json& line) { return line["width"] == kWidth && line["height"] == kHeight && settled(line); });
    EXPECT_EQ(display.codes(again["window"][0], again["window"][1], kWidth, kHeight), before);
    display.send({"search", "--name", "^nacre: ", "windowunmap"});
    display.send({"search", "--name", "^nacre: ", "windowmap"});
    display.send({"mousemove", std::to_string(again["window"][0].get<int>() + 100),
                  std::to_string(again["window"][1].get<int>() + 75), "click", "4"});
    const json last = viewer.until([&](const json& line) { return eyeOf(line) != eyeOf(first) && settled(line); });
    EXPECT_TRUE(last["problems"].empty());
}

TEST_F(ViewerWindow, GoesOnInANewWindowAfterALostContext) {
    const Display display;
    std::vector<std::string> more = words();
    more.insert(more.end(), {"--lose-context", "4"});
    Viewer viewer(display, more);
    viewer.until([](const json& line) { return line["frame"] == 4; });
    const json again = viewer.until([](const json& line) { return line["frame"] == 1; });
    const json first = viewer.until(settled);
    EXPECT_EQ(first["camera"], again["camera"]);
    display.send({"mousemove", std::to_string(first["window"][0].get<int>() + 100),
                  std::to_string(first["window"][1].get<int>() + 75), "click", "4"});
    const json closer = viewer.until([&](const json& line) { return eyeOf(line) != eyeOf(first) && settled(line); });
    EXPECT_TRUE(closer["problems"].empty());
    display.send({"key", "Escape"});
    EXPECT_EQ(viewer.code(), 0);
}

TEST_F(ViewerWindow, TracesTheReferenceOfTheView) {
    const Display display;
    std::vector<std::string> more = words();
    more.insert(more.end(), {"--reference-passes", "1", "--reference-scale", "1"});
    Viewer viewer(display, more);
    viewer.until(settled);
    display.send({"key", "d"});
    const json line = viewer.until([](const json& l) { return l["reference_passes"] == 1; });
    EXPECT_GT(line["psnr"], kSilhouettes);
}

TEST_F(ViewerWindow, BenchmarkPrintsFramesPerSecond) {
    const Display display;
    std::vector<std::string> all = words();
    all.insert(all.begin(), NACRE_VIEW);
    all.insert(all.end(), {"--benchmark", "5"});
    Child viewer(all, 1, {"DISPLAY=" + display.name()});
    const json result = json::parse(viewer.line());
    EXPECT_EQ(result["frames"], 5);
    EXPECT_EQ(result["width"], kWidth);
    EXPECT_GT(result["frames_per_second"], 0);
    EXPECT_EQ(viewer.code(), 0);
}

TEST_F(ViewerWindow, SaysWhatIsMissingInOneLine) {
    const auto outcome = [](const std::vector<std::string>& arguments, const std::vector<std::string>& variables) {
        std::vector<std::string> all = arguments;
        all.insert(all.begin(), NACRE_VIEW);
        Child viewer(all, 2, variables);
        std::string line = viewer.line();
        const std::string rest = viewer.line();
        return fmt::format("{} {}{}", viewer.code(), line, rest);
    };
    EXPECT_THAT(outcome({file()}, {"DISPLAY=", "WAYLAND_DISPLAY="}),
                AllOf(HasSubstr("1 nacre: view: expected a display"), HasSubstr("found none")));
    EXPECT_THAT(outcome({}, {}), HasSubstr("2 nacre view: file is required"));
    EXPECT_THAT(outcome({file(), "--size", "big"}, {}), AllOf(HasSubstr("2 nacre view: "), HasSubstr("'big'")));
    const Display display;
    const std::string name = "DISPLAY=" + display.name();
    EXPECT_THAT(outcome({(scratch_ / "absent.json").string()}, {name}),
                AllOf(HasSubstr("1 nacre: "), HasSubstr("absent.json")));
    EXPECT_THAT(outcome({file()}, {name, "MESA_GL_VERSION_OVERRIDE=2.1"}),
                AllOf(HasSubstr("1 nacre: view: expected OpenGL 3.3 core"), HasSubstr("found OpenGL 2.1")));
}

}  // namespace
}  // namespace nacre
