// nacre render from outside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "core/file.hpp"
#include "core/image_file.hpp"
#include "tests/cli/process.hpp"
#include "tests/shading/volume_fixture.hpp"

namespace nacre {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using tests::nacre;
using tests::Outcome;
using tests::Scratch;
using tests::Surroundings;

/// Two squares, one lit from the side, and a spot with a shadow: no asset to bake.
std::string sceneFile(const Scratch& scratch) {
    writeFile(scratch / "scene.json", R"({
        "nacre_scene": 1,
        "meshes": {"square": {"quad": {"size": 2, "steps": 2}}},
        "materials": {"matt": {"model": "lambert:kd=0.7/0.5/0.3", "ambient": [0.02, 0.02, 0.02]}},
        "nodes": {"back": {"mesh": "square", "material": "matt", "scale": [2, 2, 2]},
                  "front": {"mesh": "square", "material": "matt", "translation": [0.3, 0.2, 0.6], "scale": [0.3, 0.3, 0.3]}},
        "lights": {"lamp": {"type": "spot", "position": [1, 1, 3], "target": [0, 0, 0], "intensity": 30, "shadow": {"size": 512}}},
        "camera": {"eye": [0, 0, 4], "target": [0, 0, 0], "fovYDeg": 40, "near": 0.5, "far": 20}
    })");
    return (scratch / "scene.json").string();
}

/// A dome of 8 x 8 x 8 samples in a .den file over a floor.
std::string volumeScene(const Scratch& scratch, const char* file = "dome.den") {
    test::Bytes dome = test::den(8, 8, 8);
    const std::size_t data = dome.size() - 512;
    for (std::size_t i = 0; i < 512; ++i) {
        const Vec3 p(static_cast<double>(i % 8) - 3.5, static_cast<double>(i / 8 % 8),
                     static_cast<double>(i / 64) - 3.5);
        dome[data + i] = static_cast<std::uint8_t>(250 - 40 * std::min(6.0, glm::length(p)));
    }
    writeFile(scratch / "dome.den", test::text(dome));
    writeFile(scratch / "volume.json", std::string(R"({
        "nacre_scene": 1,
        "meshes": {"square": {"quad": {"size": 8}}},
        "volumes": {"dome": {"file": ")") + file +
                                           R"(", "iso": 130}},
        "materials": {"matt": {"model": "lambert:kd=0.7", "ambient": 0.02}},
        "nodes": {"floor": {"mesh": "square", "material": "matt", "translation": [0, -1, 0], "axis": [1, 0, 0], "angleDeg": -90},
                  "dome": {"volume": "dome", "material": "matt"}},
        "lights": {"lamp": {"type": "spot", "position": [3, 3, 2], "target": [0, -1, 0], "intensity": 60, "shadow": true}},
        "camera": {"eye": [0, 2, 6], "target": [0, -0.5, 0], "fovYDeg": 40}
    })");
    return (scratch / "volume.json").string();
}

TEST(CommandRender, VolumesAreDrawnTracedAndListed) {
    const Scratch scratch;
    const std::string scene = volumeScene(scratch);
    const Outcome run = nacre({"render", scene, "-o", scratch / "v.png", "--size", "96x64", "--shares", "--json"});
    ASSERT_EQ(run.code, 0) << run.err;
    const json data = json::parse(run.out);
    EXPECT_GT(data["errors"]["all"]["psnr"], 35)
        << "models in the shader: what is left are outlines and shadows' edges";
    EXPECT_LT(data["errors"]["shares"][0]["psnr_off"].get<double>(), data["errors"]["all"]["psnr"].get<double>() - 4)
        << "the volume's shadow is in the reference";
    const Outcome info = nacre({"info", scene});
    ASSERT_EQ(info.code, 0) << info.err;
    EXPECT_THAT(info.out, AllOf(HasSubstr("8 x 8 x 8 samples, surface at 130, march"), HasSubstr("volume.frag.glsl")));
    for (const auto& [flag, method] : {std::pair{"--shadows", "sampled"}, {"--specular", "traced"}}) {
        const Outcome meshes = nacre({"render", scene, "-o", scratch / "w.png", "--size", "16x16", flag, method});
        EXPECT_EQ(meshes.code, 1);
        EXPECT_THAT(meshes.err, HasSubstr("expected meshes alone, found a volume at node 'dome'"));
    }
    const Outcome wrong = nacre({"render", volumeScene(scratch, "gone.den"), "-o", scratch / "w.png"});
    EXPECT_EQ(wrong.code, 1);
    EXPECT_THAT(wrong.err, AllOf(HasSubstr("volume.json: /volumes/dome/file: "), HasSubstr("gone.den")));
    EXPECT_FALSE(std::filesystem::exists(scratch / "w.png"));
}

TEST(CommandRender, DrawsAndComparesWithTheReference) {
    const Scratch scratch;
    const std::string output = scratch / "a.exr";
    const Outcome run = nacre({"render", sceneFile(scratch), "-o", output, "--size", "96x64", "--shares", "--json"});
    ASSERT_EQ(run.code, 0) << run.err;
    const json data = json::parse(run.out);
    EXPECT_EQ(data["width"], 96);
    EXPECT_EQ(data["programs"], 1);
    EXPECT_GT(data["errors"]["all"]["psnr"], 35) << "models in the shader: what is left are shadows' edges";
    EXPECT_FALSE(data["errors"].contains("surrounding_occluded")) << "there is none";
    ASSERT_EQ(data["errors"]["shares"].size(), 1u);
    EXPECT_EQ(data["errors"]["shares"][0]["name"], "shadow maps");
    EXPECT_LT(data["errors"]["shares"][0]["psnr_off"], data["errors"]["all"]["psnr"]);
    EXPECT_GT(data["errors"]["shares"][0]["psnr_without"], data["errors"]["all"]["psnr"]);
    const Image picture = readImageFile(output).image, reference = readImageFile(scratch / "a-reference.exr").image;
    EXPECT_EQ(picture.width(), 96);
    EXPECT_EQ(reference.height(), 64);
    EXPECT_TRUE(std::filesystem::exists(scratch / "a-difference.png"));
    const Outcome text =
        nacre({"render", sceneFile(scratch), "-o", scratch / "a.png", "--size", "32x32", "--reference", "--quiet"});
    ASSERT_EQ(text.code, 0) << text.err;
    EXPECT_THAT(text.out, AllOf(HasSubstr("a.png: 32 x 32 pixels"), HasSubstr("PSNR"),
                                ContainsRegex("reference, traced in [0-9.]+ s: "), Not(HasSubstr("surrounding"))));
    EXPECT_EQ(text.err, "");
}

TEST(CommandRender, MirrorsAndPanesAreDrawnTracedAndListed) {
    const Scratch scratch;
    writeFile(scratch / "room.json", R"({
        "nacre_scene": 1,
        "meshes": {"square": {"quad": {"size": 2}}, "ball": {"sphere": {"radius": 0.4}}},
        "materials": {"matt": {"model": "lambert:kd=0.7/0.5/0.3", "ambient": 0.05}, "mirror": {"specular": {"reflection": 0.9}},
                      "pane": {"specular": {"ior": 1.5}}},
        "nodes": {"floor": {"mesh": "square", "material": "matt", "translation": [0, -1, 0], "axis": [1, 0, 0], "angleDeg": -90, "scale": 2},
                  "looking-glass": {"mesh": "square", "material": "mirror", "translation": [0, 0.2, -1.5], "axis": [0, 1, 0], "angleDeg": 15},
                  "pane": {"mesh": "square", "material": "pane", "translation": [0.8, -0.3, 0.5], "scale": 0.6, "castsShadow": false},
                  "ball": {"mesh": "ball", "material": "matt", "translation": [0.2, -0.5, -0.2]}},
        "lights": {"lamp": {"type": "spot", "position": [1, 3, 2], "target": [0, -1, 0], "intensity": 40, "shadow": {"size": 512}}},
        "sky": {"color": 0.3},
        "camera": {"eye": [0.3, 0.4, 5], "target": [0, -0.2, 0], "fovYDeg": 40}
    })");
    const std::string scene = scratch / "room.json";
    const Outcome list = nacre({"render", scene, "--passes", "--depth", "2"});
    ASSERT_EQ(list.code, 0) << list.err;
    EXPECT_THAT(list.out, AllOf(HasSubstr("camera > looking-glass reflects > pane refracts"), HasSubstr("2 levels")));
    const Outcome listed = nacre({"render", scene, "--passes", "--json"});
    ASSERT_EQ(listed.code, 0) << listed.err;
    EXPECT_GT(json::parse(listed.out)["passes"].size(), 10u);
    const Outcome run = nacre({"render", scene, "-o", scratch / "r.png", "--size", "96x64", "--reference", "--json"});
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_GT(json::parse(run.out)["errors"]["all"]["psnr"], 32) << "outlines, shadows' edges, one angle a pane";
    const Outcome low = nacre(
        {"render", scene, "-o", scratch / "l.png", "--size", "96x64", "--quality", "low", "--reference", "--json"});
    ASSERT_EQ(low.code, 0) << low.err;
    EXPECT_EQ(json::parse(low.out)["quality"], "low");
    EXPECT_LT(json::parse(low.out)["passes"], json::parse(run.out)["passes"]);
    EXPECT_LT(json::parse(low.out)["errors"]["all"]["psnr"], json::parse(run.out)["errors"]["all"]["psnr"])
        << "against the same reference";
    EXPECT_THAT(nacre({"info", scene}).out,
                AllOf(HasSubstr("specular mirror\n"), HasSubstr("specular index 1.5\n"), HasSubstr("ambient 0.05")));
    const auto render = [&](const char* lights) {
        const Outcome out = nacre({"render", scene, "-o", scratch / "l.png", "--size", "96x64", "--shadows", "volumes",
                                   "--light-paths", lights, "--reference", "--json"});
        EXPECT_EQ(out.code, 0) << out.err;
        return json::parse(out.out);
    };
    const json without = render("0"), with = render("1");
    EXPECT_EQ(without["light_paths"]["images"], 0);
    EXPECT_EQ(with["light_paths"]["images"], 1) << "the mirror's; the pane casts no shadow";
    EXPECT_GT(with["light_paths"]["passes"], 1 + with["specular_views"].get<int>());
    EXPECT_LE(with["light_paths"]["passes"], 2 * (1 + with["specular_views"].get<int>()));
    EXPECT_GT(with["errors"]["all"]["psnr"], 32);
    const Outcome lights = nacre({"render", scene, "--passes", "--light-paths", "1"});
    EXPECT_THAT(lights.out, HasSubstr("lamp > looking-glass reflects: add in 1 light volume"));
    EXPECT_EQ(nacre({"render", scene, "-o", scratch / "l.png", "--light-paths", "5"}).code, 2);
    const Outcome deep = nacre({"render", scene, "-o", scratch / "d.png", "--depth", "500"});
    EXPECT_EQ(deep.code, 1);
    EXPECT_THAT(deep.err, HasSubstr("at most 127 with 8 bits of stencil"));
    EXPECT_FALSE(std::filesystem::exists(scratch / "d.png"));
}

TEST(CommandRender, ShadowsByVolumes) {
    const Scratch scratch;
    const Outcome run = nacre({"render", sceneFile(scratch), "-o", scratch / "v.png", "--size", "96x64", "--shadows",
                               "volumes", "--light-points", "4", "--soft", "pivot", "--reference", "--json"});
    ASSERT_EQ(run.code, 0) << run.err;
    const json data = json::parse(run.out);
    EXPECT_GT(data["errors"]["all"]["psnr"], 35);
    EXPECT_GT(data["shadow_volumes"]["made"], 0);
    const Outcome radiosity =
        nacre({"render", sceneFile(scratch), "-o", scratch / "r.png", "--size", "16x16", "--radiosity", "--json"});
    ASSERT_EQ(radiosity.code, 0) << radiosity.err;
    EXPECT_LE(json::parse(radiosity.out)["radiosity"]["left"], 1);
    for (const auto& [flag, words] :
         {std::pair{"--shadows", "expected maps, volumes"}, {"--soft", "regenerated, pivot or levels"}}) {
        const Outcome wrong = nacre({"render", sceneFile(scratch), "-o", scratch / "w.png", flag, "blurred"});
        EXPECT_EQ(wrong.code, 2);
        EXPECT_THAT(wrong.err, HasSubstr(words));
        EXPECT_FALSE(std::filesystem::exists(scratch / "w.png"));
    }
}

TEST(CommandRender, InStages) {
    const Scratch scratch;
    writeFile(scratch / "room.json", R"({
        "nacre_scene": 1,
        "meshes": {"square": {"quad": {"size": 2}}, "ball": {"sphere": {"radius": 0.4}}},
        "materials": {"matt": {"model": "lambert:kd=0.7/0.5/0.3"}, "glass": {"specular": {"ior": 1.5}}},
        "nodes": {"floor": {"mesh": "square", "material": "matt", "translation": [0, -1, 0], "axis": [1, 0, 0], "angleDeg": -90},
                  "back": {"mesh": "square", "material": "matt", "translation": [0, 0, -1]},
                  "ball": {"mesh": "ball", "material": "glass", "translation": [0.2, -0.5, 0]}},
        "lights": {"lamp": {"type": "point", "position": [0, 0.5, 0.5], "intensity": 3, "shadow": true}},
        "camera": {"eye": [0.3, 0.4, 5], "target": [0, -0.2, 0], "fovYDeg": 30}
    })");
    const std::string scene = scratch / "room.json";
    const Outcome run = nacre({"render",
                               scene,
                               "-o",
                               scratch / "s.png",
                               "--size",
                               "64x64",
                               "--samples",
                               "2",
                               "--rays",
                               "2",
                               "--shadows",
                               "volumes",
                               "--indirect",
                               "virtual-lights",
                               "--virtual-lights",
                               "64",
                               "--virtual-shadows",
                               "--specular",
                               "traced",
                               "--stages",
                               "--reference",
                               "--json"});
    ASSERT_EQ(run.code, 0) << run.err;
    const json data = json::parse(run.out);
    EXPECT_EQ(data["virtual_lights"]["lights"], 64);
    EXPECT_GE(data["virtual_lights"]["clamped_share"], 0);
    EXPECT_GT(data["traced"]["pixels"], 100);
    EXPECT_GT(data["stage_seconds"]["virtual lights"], 0);
    EXPECT_GT(data["errors"]["trace_seconds"], 0);
    EXPECT_LT(data["errors"]["indirect"]["rms_over_mean"], 0.2) << "64 lights; the truth has 256 paths a pixel";
    EXPECT_LT(data["errors"]["traced"]["relative_rmse"], 0.05);
    EXPECT_GT(data["errors"]["blended"]["psnr"], 35);
    const auto refused = [&](const std::vector<std::string>& more, const std::string& words) {
        std::vector<std::string> all = {"render", scene, "-o", scratch / "refused.png", "--indirect", "virtual-lights"};
        all.insert(all.end(), more.begin(), more.end());
        const Outcome outcome = nacre(all);
        EXPECT_EQ(outcome.code, 2) << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr(words));
        EXPECT_FALSE(std::filesystem::exists(scratch / "refused.png"));
    };
    refused({}, "--indirect: expected --specular traced beside it in a scene with mirrors or panes");
    for (const char* flag : {"--radiosity", "--shares", "--passes"})
        refused({"--specular", "traced", flag}, std::string(flag) + ": expected none of --indirect");
    refused({"--specular", "traced", "--quality", "low"}, "--quality: expected none of");
    refused({"--specular", "traced", "--light-paths", "1"}, "--light-paths: expected 0 beside --indirect");
    for (const char* stage : {"", "-direct", "-indirect", "-traced"})
        for (const char* what : {"", "-reference", "-difference"})
            EXPECT_TRUE(std::filesystem::exists(scratch / (std::string("s") + stage + what + ".png"))) << stage << what;
    const Outcome text = nacre({"render", scene, "-o", scratch / "t.png", "--size", "16x16", "--specular", "traced",
                                "--light-paths", "0", "--reference", "--rays", "1"});
    ASSERT_EQ(text.code, 0) << text.err;
    EXPECT_THAT(text.out, AllOf(HasSubstr("note: light by way of mirrors and panes is left out"),
                                ContainsRegex("reference, traced in [0-9.]+ s")));
    const Outcome views = nacre({"render", scene, "-o", scratch / "v.png"});
    EXPECT_EQ(views.code, 1) << "views of planar mirrors alone";
    EXPECT_THAT(views.err, HasSubstr("--specular traced draws curved meshes"));
    refused({"--elements", "16777216", "--specular", "traced"}, "--elements: expected a whole number 1 to 4194304");
    const Outcome sampled = nacre({"render", scene, "-o", scratch / "l.png", "--size", "48x48", "--samples", "1",
                                   "--shadows", "sampled", "--specular", "traced", "--repeat", "2", "--json"});
    ASSERT_EQ(sampled.code, 0) << sampled.err;
    const json chosen = json::parse(sampled.out);
    EXPECT_THAT((std::set<std::string>{"maps", "volumes"}), testing::Contains(chosen["shadows"]["method"]));
    EXPECT_GT(chosen["shadows"]["map_psnr"], 20);
    EXPECT_GT(chosen["repeated"]["frames_per_second"], 0);
    EXPECT_THAT(nacre({"render", scene, "-o", scratch / "l.png", "--shadows", "sampled"}).err,
                HasSubstr("--shadows: expected --specular traced beside it"));
    EXPECT_THAT(nacre({"render", scene, "-o", scratch / "l.png", "--shadows", "soft"}).err,
                HasSubstr("expected maps, volumes, sampled-maps, sampled-volumes or sampled, found 'soft'"));
    for (const auto& [flag, words] : {std::pair{"--indirect", "virtual-lights"},
                                      {"--specular", "views or traced"},
                                      {"--virtual-choice", "grouped or strongest"},
                                      {"--virtual-near", "rectangle, disk or point"}}) {
        const Outcome wrong = nacre({"render", scene, "-o", scratch / "w.png", flag, "blurred"});
        EXPECT_EQ(wrong.code, 2);
        EXPECT_THAT(wrong.err, HasSubstr(words));
    }
}

TEST(CommandRender, FramesASecondOfAPlainPicture) {
    const Scratch scratch;
    const Outcome run =
        nacre({"render", sceneFile(scratch), "-o", scratch / "a.png", "--size", "16x16", "--repeat", "3", "--json"});
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(json::parse(run.out)["repeated"]["frames"], 3);
    EXPECT_GT(json::parse(run.out)["repeated"]["frames_per_second"], 0);
    const Outcome text =
        nacre({"render", sceneFile(scratch), "-o", scratch / "a.png", "--size", "16x16", "--repeat", "1"});
    EXPECT_THAT(text.out, HasSubstr(" frames/s\n"));
}

TEST(CommandRender, OptionsThatNothingReadsAreRefused) {
    const Scratch scratch;
    const std::string scene = sceneFile(scratch), output = scratch / "a.png";
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
        {{"--stages"}, "--stages: expected --indirect virtual-lights, --specular traced or sampled"},
        {{"--virtual-lights", "3"}, "--virtual-lights: expected --indirect virtual-lights"},
        {{"--virtual-shadows", "--specular", "traced"}, "--virtual-shadows: expected --indirect virtual-lights"},
        {{"--virtual-choice", "grouped"}, "--virtual-choice: expected --indirect virtual-lights"},
        {{"--virtual-near", "disk"}, "--virtual-near: expected --indirect virtual-lights"},
        {{"--elements", "100"}, "--elements: expected --indirect virtual-lights"},
        {{"--soft", "pivot"}, "--soft: expected --shadows volumes"},
        {{"--light-points", "4", "--shadows", "maps"}, "--light-points: expected --shadows volumes"}};
    for (const auto& [more, words] : cases) {
        std::vector<std::string> all = {"render", scene, "-o", output};
        all.insert(all.end(), more.begin(), more.end());
        const Outcome run = nacre(all);
        EXPECT_EQ(run.code, 2) << run.err;
        EXPECT_THAT(run.err, HasSubstr(words));
        EXPECT_FALSE(std::filesystem::exists(output));
    }
}

TEST(CommandRender, PicturesThatBelongTogetherAppearTogether) {
    const Scratch scratch;
    std::filesystem::create_directory(scratch / "s-indirect.png");  // in the way of one
    const std::string scene = sceneFile(scratch);
    const Outcome run = nacre(
        {"render", scene, "-o", scratch / "s.png", "--size", "16x16", "--indirect", "virtual-lights", "--stages"});
    EXPECT_EQ(run.code, 1);
    EXPECT_THAT(run.err, HasSubstr("s-indirect.png: can't write"));
    EXPECT_FALSE(std::filesystem::exists(scratch / "s.png"));
    EXPECT_FALSE(std::filesystem::exists(scratch / "s-direct.png"));
    std::filesystem::remove(scratch / "s-indirect.png");
    Surroundings small;
    small.fileSize = 6000;  // PNG of noise-free stages fits, EXR of 64 x 64 floats doesn't
    const Outcome full =
        nacre({"render", scene, "-o", scratch / "s.exr", "--size", "64x64", "--indirect", "virtual-lights", "--stages"},
              small);
    EXPECT_NE(full.code, 0);
    for (const auto& entry : std::filesystem::directory_iterator(scratch / "."))
        EXPECT_EQ(entry.path().filename().string(), "scene.json") << "nothing half-written";
}

TEST(CommandRender, WhatTheSceneReadsIsNotReplaced) {
    const Scratch scratch;
    ASSERT_EQ(nacre({"factorize", "lambert:kd=0.5", "-o", scratch / "matt.exr"}).code, 0);
    ASSERT_EQ(nacre({"render", sceneFile(scratch), "-o", scratch / "tint.png", "--size", "8x8"}).code, 0);
    writeFile(scratch / "reads.json", R"({"nacre_scene": 1, "assets": {"matt": {"file": "matt.exr"}},
        "meshes": {"square": {"quad": {"size": 2}}},
        "materials": {"m": {"brdf": "matt"}, "pane": {"specular": {"ior": 1.5, "filter": "tint.png"}}},
        "nodes": {"n": {"mesh": "square", "material": "m"}, "p": {"mesh": "square", "material": "pane", "translation": [0, 0, 1]}}})");
    for (const char* file : {"matt.exr", "tint.png", "reads.json"}) {
        const std::string before = tests::contents(scratch / file);
        const Outcome run = nacre({"render", scratch / "reads.json", "-o", scratch / file, "--size", "8x8"});
        EXPECT_EQ(run.code, 2) << file;
        EXPECT_EQ(tests::contents(scratch / file), before) << file;
    }
}

TEST(CommandRender, MeshFilesAndEmptyScenes) {
    const Scratch scratch;
    writeFile(scratch / "triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const Outcome mesh = nacre({"render", scratch / "triangle.obj", "-o", scratch / "m.png", "--size", "40x30"});
    EXPECT_EQ(mesh.code, 0) << mesh.err;
    writeFile(scratch / "empty.json", R"({"nacre_scene": 1, "sky": {"color": [0.5, 0.25, 0.125]}})");
    const Outcome empty =
        nacre({"render", scratch / "empty.json", "-o", scratch / "e.exr", "--size", "8x8", "--reference"});
    ASSERT_EQ(empty.code, 0) << empty.err;
    EXPECT_EQ(readImageFile(scratch / "e.exr").image.rgb(3, 3), Rgb(0.5, 0.25, 0.125));
}

TEST(CommandRender, WrongUsageIsTwo) {
    const Scratch scratch;
    const std::string scene = sceneFile(scratch), output = scratch / "a.png";
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
        {{"render", scene, "-o", scratch / "a.jpg"}, "ends in .exr or .png"},
        {{"render", scene, "-o", output, "--size", "96"}, "WIDTHxHEIGHT"},
        {{"render", scene, "-o", output, "--size", "0x10"}, "WIDTHxHEIGHT"},
        {{"render", scene, "-o", output, "--samples", "0"}, "--samples"},
        {{"render", scene, "-o", output, "--time", "soon"}, "--time"},
        {{"render", scene, "-o", output, "--quality", "best"}, "--quality: expected full, high, medium, low or least"},
        {{"render", scene}, "--output"}};
    for (const auto& [arguments, words] : cases) {
        const Outcome run = nacre(arguments);
        EXPECT_EQ(run.code, 2) << run.err;
        EXPECT_THAT(run.err, HasSubstr(words));
    }
}

TEST(CommandRender, FailuresAreOneLine) {
    const Scratch scratch;
    const auto expect = [](const Outcome& run, const std::string& words) {
        EXPECT_EQ(run.code, 1) << run.err;
        EXPECT_THAT(run.err, HasSubstr(words));
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    };
    expect(nacre({"render", "/nowhere/scene.json", "-o", scratch / "a.png"}), "/nowhere/scene.json");
    expect(nacre({"render", sceneFile(scratch), "-o", "/nowhere/a.png", "--size", "8x8"}), "/nowhere/a.png");
    writeFile(scratch / "missing.json", R"({"nacre_scene": 1, "assets": {"gold": {"file": "gold.exr"}},
        "meshes": {"square": {"quad": {"size": 2}}}, "materials": {"m": {"brdf": "gold"}},
        "nodes": {"n": {"mesh": "square", "material": "m"}}})");
    expect(nacre({"render", scratch / "missing.json", "-o", scratch / "a.png"}), "gold");
    ::setenv("MESA_GL_VERSION_OVERRIDE", "2.1", 1);
    const Outcome old = nacre({"render", sceneFile(scratch), "-o", scratch / "a.png"});
    ::unsetenv("MESA_GL_VERSION_OVERRIDE");
    expect(old, "expected a context of OpenGL 3.3 core");
    EXPECT_THAT(old.err, HasSubstr("found OpenGL 2.1"));
}

}  // namespace
}  // namespace nacre
