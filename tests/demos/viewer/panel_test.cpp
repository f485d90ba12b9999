// The panel's lists of baked files, chosen from by real mouse events.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "bump/bump_asset.hpp"
#include "bump/normals.hpp"
#include "core/asset.hpp"
#include "core/file.hpp"
#include "core/image_file.hpp"
#include "demos/viewer/session.hpp"
#include "factorize/factored_brdf.hpp"
#include "factorize/factorize.hpp"
#include "factorize/models/models.hpp"
#include "shading/context.hpp"
#include "tests/demos/viewer/display.hpp"

namespace nacre {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using tests::Display;
using tests::Scratch;
using tests::Viewer;

// High enough for the whole panel.
constexpr int kWidth = 200, kHeight = 900;

const char* const kScene = R"({"nacre_scene": 1,
 "assets": {"paint": {"file": "dull.exr"}},
 "meshes": {"torus": {"torus": {}}},
 "materials": {"paint": {"brdf": "paint"}},
 "nodes": {"it": {"mesh": "torus", "material": "paint"}},
 "lights": {"sun": {"type": "directional", "direction": [-1, -1, -1], "intensity": 3}},
 "camera": {"eye": [0, 2, 4]}})";

bool settled(const json& line) { return line.at("settled").get<bool>(); }

class ViewerPanel : public ::testing::Test {
protected:
    ViewerPanel() {
        writeFile(file(), kScene);
        for (const auto& [name, model] : {std::pair{"dull.exr", "torrance-sparrow:alpha=0.6,kd=0.6/0.3/0.1"},
                                          {"shiny.exr", "torrance-sparrow:alpha=0.2,kd=0.1"}})
            writeAsset(toAsset(factorize(makeModel(model), {.method = "analytic", .size = 16})), scratch_ / name);
        HeightMap heights{Image(8, 8, 1), Wrap::Repeat};
        heights.heights.at(3, 4, 0) = 2;
        BumpMaps maps{8, 8, Wrap::Repeat, {}, {}, {}, {}, {}, {}};
        maps.normals = makeNormals(heights);
        writeAsset(toAsset(maps), scratch_ / "spike.exr");
    }
    std::filesystem::path file() const { return scratch_ / "scene.json"; }
    std::vector<std::string> words(const std::filesystem::path& shown) const {
        return {shown.string(),
                "--size",
                fmt::format("{}x{}", kWidth, kHeight),
                "--white",
                "1",
                "--screenshots",
                scratch_.folder().string()};
    }
    /// Clicks what a line of the trace places.
    void click(const json& line, const std::string& name) const {
        const json& at = line.at("places").at(name);
        display_.send({"mousemove", fmt::format("{:.0f}", line["window"][0].get<double>() + at[0].get<double>()),
                       fmt::format("{:.0f}", line["window"][1].get<double>() + at[1].get<double>())});
        display_.send({"click", "1"});
    }
    /// The next settled line in which `name` can be clicked.
    static json offered(Viewer& viewer, const std::string& name) {
        return viewer.until([&](const json& line) {
            return settled(line) && line.contains("places") && line["places"].contains(name);
        });
    }
    /// \param line  the last one of the trace, then the next settled one: nothing more comes until something happens
    Image screenshot(Viewer& viewer, json& line) const {
        display_.send({"key", "s"});
        line = viewer.until(
            [before = line["screenshot"]](const json& l) { return l["screenshot"] != before && settled(l); });
        return readImageFile(std::filesystem::path(line["screenshot"].get<std::string>()).replace_extension(".exr"))
            .image;
    }
    /// What a session draws after the same edit.
    template <class Edit>
    Image expected(Edit&& edit) const {
        const Context context;
        ViewerSession session({file(), {}, 1});
        session.resize(kWidth, kHeight);
        edit(session);
        session.draw();
        return session.target()->read();
    }
    Scratch scratch_;
    Display display_;
};

/// Largest difference of a channel.
double differing(const Image& a, const Image& b) {
    EXPECT_EQ(a.width(), b.width());
    EXPECT_EQ(a.height(), b.height());
    double most = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x)
            for (int c = 0; c < 3; ++c) most = std::max<double>(most, std::abs(a.at(x, y, c) - b.at(x, y, c)));
    return most;
}

constexpr double kSame = 1e-4;

TEST_F(ViewerPanel, AnotherFileTakesAnAssetsPlace) {
    Viewer viewer(display_, words(file()));
    click(offered(viewer, "Baked assets"), "Baked assets");
    click(offered(viewer, "file##paint"), "file##paint");
    click(offered(viewer, "file##paint/shiny.exr"), "file##paint/shiny.exr");
    json after = viewer.until([](const json& line) { return line["assets"][0] == "shiny.exr" && settled(line); });
    EXPECT_THAT(after["problems"], IsEmpty());
    const Image picture = screenshot(viewer, after);
    EXPECT_LE(differing(picture, expected([&](ViewerSession& s) { s.replaceAsset(0, scratch_ / "shiny.exr"); })),
              kSame);
    EXPECT_GT(differing(picture, expected([](ViewerSession&) {})), 0.05);
}

TEST_F(ViewerPanel, ABakedBrdfIsChosenForTheMesh) {
    Viewer viewer(display_, words(file()));
    click(offered(viewer, "baked"), "baked");
    const json list = offered(viewer, "baked/shiny.exr");
    EXPECT_FALSE(list["places"].contains("baked/spike.exr"));  // it is no BRDF
    click(list, "baked/shiny.exr");
    const json after = viewer.until([](const json& line) { return line["materials"][0] == 1 && settled(line); });
    EXPECT_THAT(after["assets"], ElementsAre("dull.exr", "shiny.exr"));
    EXPECT_THAT(after["problems"], IsEmpty());
}

TEST_F(ViewerPanel, AReliefIsAddedAndTakenAway) {
    Viewer viewer(display_, words(file()));
    json line = offered(viewer, "relief");
    const Image flat = screenshot(viewer, line);
    click(line, "relief");
    click(offered(viewer, "relief/spike.exr"), "relief/spike.exr");
    line = offered(viewer, "Flat");
    EXPECT_THAT(line["assets"], ElementsAre("dull.exr", "spike.exr"));
    EXPECT_THAT(line["problems"], IsEmpty());
    const Image rough = screenshot(viewer, line);
    EXPECT_LE(differing(rough, expected([&](ViewerSession& s) { s.setRelief(0, scratch_ / "spike.exr"); })), kSame);
    EXPECT_GT(differing(rough, flat), 0.05);
    click(line, "Flat");
    line = viewer.until([](const json& l) { return settled(l) && !l["places"].contains("Flat"); });
    EXPECT_EQ(differing(screenshot(viewer, line), flat), 0);
}

TEST_F(ViewerPanel, AMeshWithoutTextureCoordinatesIsOfferedNoRelief) {
    writeFile(scratch_ / "bare.obj", "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n");
    Viewer viewer(display_, words(scratch_ / "bare.obj"));
    EXPECT_FALSE(offered(viewer, "baked")["places"].contains("relief"));
}

/// A mirror fills the picture; its view is switched off in the list of passes.
TEST_F(ViewerPanel, ViewsOfMirrorsAreSwitchedOff) {
    writeFile(scratch_ / "mirror.json", R"({"nacre_scene": 1,
 "meshes": {"wall": {"quad": {"size": 8, "steps": 1}}},
 "materials": {"mirror": {"specular": {}}},
 "nodes": {"glass": {"mesh": "wall", "material": "mirror"}},
 "sky": {"color": [0.2, 0.5, 0.3]},
 "camera": {"eye": [0, 0, 4]}})");
    Viewer viewer(display_, words(scratch_ / "mirror.json"));
    json line = offered(viewer, "Passes");
    const Image mirrored = screenshot(viewer, line);
    EXPECT_NEAR(mirrored.at(kWidth / 2, kHeight / 2, 1), 0.5, 1e-3);
    click(line, "Passes");
    click(offered(viewer, "camera > glass reflects"), "camera > glass reflects");
    line =
        viewer.until([pictures = line["pictures"]](const json& l) { return l["pictures"] != pictures && settled(l); });
    EXPECT_EQ(screenshot(viewer, line).at(kWidth / 2, kHeight / 2, 1), 0) << "a mirror that shows nothing";
}

}  // namespace
}  // namespace nacre
