// nacre envmap, and nacre eval and info of what it writes, from outside.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "core/environment.hpp"
#include "tests/cli/process.hpp"
#include "tests/core/exr_files.hpp"

namespace nacre {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using tests::contents;
using tests::nacre;
using tests::Outcome;
using tests::Scratch;
using tests::writeExr;

/// A latlong of radiance 1 + y with `bright` in one texel.
std::string latlong(const Scratch& scratch, float bright = 1, int height = 16) {
    Image image(2 * height, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < 2 * height; ++x)
            image.setRgb(x, y, Rgb(1 + envTexelDirection(EnvLayout::LatLong, height, x, y).y));
    image.setRgb(3, height / 2, Rgb(bright));
    const std::string path = (scratch / "source.exr").string();
    writeExr(image, path);
    return path;
}

std::vector<std::string> convert(const std::string& source, const std::filesystem::path& output,
                                 std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"envmap", source, "-o", output.string(), "--convert"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

void expectFailure(const Outcome& outcome, int code, const std::vector<std::string>& fragments) {
    EXPECT_EQ(outcome.code, code) << outcome.err;
    for (const std::string& fragment : fragments) EXPECT_THAT(outcome.err, HasSubstr(fragment));
    EXPECT_THAT(outcome.out, IsEmpty());
}

TEST(CommandEnvmap, JsonHasWhatTheDocumentationNamesAndEnergyStays) {
    const Scratch scratch;
    const std::string source = latlong(scratch, 1e5f * 30);
    for (const std::string layout : {"latlong", "cube", "dual_paraboloid", "octahedral"}) {
        const Outcome outcome =
            nacre(convert(source, scratch / "a.exr", {"--layout", layout, "--size", "9", "--json"}));
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        const json meta = json::parse(outcome.out);
        for (const char* key : {"kind", "source", "source_hash", "layout", "size", "bytes", "seconds", "cpu_seconds",
                                "input", "energy", "orientation", "flip", "command_line"})
            EXPECT_TRUE(meta.contains(key)) << key;
        EXPECT_EQ(meta["kind"], "environment");
        EXPECT_EQ(meta["layout"], layout);
        EXPECT_EQ(meta["size"], 9);
        EXPECT_LT(meta["energy"]["error"], 1e-4) << layout;
        EXPECT_EQ(json::parse(nacre({"info", (scratch / "a.exr").string(), "--json"}).out), meta);
    }
    EXPECT_THAT(nacre({"info", (scratch / "a.exr").string()}).out,
                AllOf(HasSubstr("environment"), HasSubstr("octahedral")));
}

TEST(CommandEnvmap, LayoutAndSizeDefaultToTheSources) {
    const Scratch scratch;
    const std::string source = latlong(scratch);
    EXPECT_EQ(json::parse(nacre(convert(source, scratch / "a.exr", {"--json"})).out)["size"], 16);
    EXPECT_EQ(json::parse(nacre(convert(source, scratch / "a.exr", {"--json", "--layout", "cube"})).out)["size"], 8);
}

TEST(CommandEnvmap, SameBytesForAnyThreadCount) {
    const Scratch scratch;
    const std::string source = latlong(scratch);
    json one = json::parse(nacre(convert(source, scratch / "1.exr", {"--json", "--threads", "1"})).out);
    json two = json::parse(nacre(convert(source, scratch / "2.exr", {"--json", "--threads", "2"})).out);
    for (const char* key : {"seconds", "cpu_seconds", "read_seconds", "command_line"}) one.erase(key), two.erase(key);
    EXPECT_EQ(one, two);
}

TEST(CommandEnvmap, EvalAnswersWhatAShaderFetches) {
    const Scratch scratch;
    const std::string output = (scratch / "a.exr").string();
    ASSERT_EQ(nacre(convert(latlong(scratch), output, {"--layout", "cube", "--size", "32"})).code, 0);
    const Outcome outcome =
        nacre({"eval", output}, {.input = "x,y,z\n0,1,0\n# no answer\n\n0,-1e300,0\n0.001,0,0.001", .stdoutPath = {}});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    std::istringstream lines(outcome.out);
    std::vector<double> red;
    for (std::string line; std::getline(lines, line);) red.push_back(std::stod(line));
    ASSERT_EQ(red.size(), 3u);
    EXPECT_NEAR(red[0], 2, 0.02);
    EXPECT_NEAR(red[1], 0, 0.02);
    EXPECT_NEAR(red[2], 1, 0.1);
    expectFailure(nacre({"eval", output}, {.input = "0,1,0,0.5", .stdoutPath = {}}), 1, {"level_mapping"});
    expectFailure(nacre({"eval", output}, {.input = "1,2\n", .stdoutPath = {}}), 1, {"line 1", "x,y,z"});
    expectFailure(nacre({"eval", output}, {.input = "0,0,0\n", .stdoutPath = {}}), 1, {"line 1", "not 0"});
    expectFailure(nacre({"eval", output, "--source", "lambert"}, {}), 2, {"--source"});
}

TEST(CommandEnvmap, HalfOverflowIsAnErrorOrAStatedScaleNeverAnInfinity) {
    const Scratch scratch;
    const std::string source = latlong(scratch, 1e6f);
    expectFailure(nacre(convert(source, scratch / "a.exr", {"--format", "half"})), 1, {"65504", "scale of 16"});
    EXPECT_FALSE(std::filesystem::exists(scratch / "a.exr"));
    const Outcome scaled = nacre(convert(source, scratch / "a.exr", {"--format", "half", "--scale", "auto", "--json"}));
    ASSERT_EQ(scaled.code, 0) << scaled.err;
    EXPECT_EQ(json::parse(scaled.out)["scale"], 16);
    EXPECT_EQ(json::parse(scaled.out)["textures"][0]["scale"][0], 16);
    const std::vector<std::string> faces = {"--layout", "cube", "--size", "64", "--export", "ktx2"};
    expectFailure(nacre(convert(source, scratch / "b.exr", faces)), 1, {"65504", "export"});
    EXPECT_FALSE(std::filesystem::exists(scratch / "b.exr"));
    EXPECT_FALSE(std::filesystem::exists(scratch / "b.ktx2"));
    EXPECT_EQ(nacre(convert(source, scratch / "c.exr", {"--scale", "0.5"})).code, 0);
}

TEST(CommandEnvmap, ExportsLieBesideTheAsset) {
    const Scratch scratch;
    const std::string source = latlong(scratch);
    for (const std::string format : {"ktx2", "dds"}) {
        const Outcome outcome = nacre(
            convert(source, scratch / "a.exr", {"--layout", "cube", "--size", "5", "--export", format, "--json"}));
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        const json exported = json::parse(outcome.out)["export"];
        EXPECT_EQ(exported["levels"], 3);  // 5, 2, 1
        EXPECT_EQ(contents(scratch / ("a." + format)).size(), exported["bytes"]);
    }
    expectFailure(nacre(convert(source, scratch / "a.exr", {"--export", "dds"})), 2, {"--export", "cube"});
}

TEST(CommandEnvmap, WhatTheRulesChangeIsSaidOnStandardError) {
    const Scratch scratch;
    Image image(8, 4, 3);
    image.setRgb(0, 0, Rgb(-1, 2, 3));
    image.setRgb(5, 2, Rgb(NAN));
    image.setRgb(6, 2, Rgb(INFINITY));
    const std::string source = (scratch / "bad.exr").string();
    writeExr(image, source);
    const Outcome clamped = nacre(convert(source, scratch / "a.exr", {"--quiet"}));
    EXPECT_EQ(clamped.code, 0);
    EXPECT_THAT(clamped.err, AllOf(HasSubstr("1 of 32 texels negative: clamped"), HasSubstr("energy removed"),
                                   HasSubstr("2 of 32 texels not finite"), HasSubstr("1 of 32 texels at 65504")));
    EXPECT_THAT(nacre(convert(source, scratch / "a.exr", {"--negative", "keep"})).err, HasSubstr("negative: kept"));
    expectFailure(nacre(convert(source, scratch / "b.exr", {"--negative", "error"})), 1,
                  {"1 negative and 2 non-finite", "(0, 0)"});
    EXPECT_FALSE(std::filesystem::exists(scratch / "b.exr"));
}

TEST(CommandEnvmap, BrokenSourcesAreRefusedInOneLine) {
    const Scratch scratch;
    const std::string source = latlong(scratch, 1, 64), bytes = contents(source);
    std::ofstream(scratch / "cut.exr", std::ios::binary) << bytes.substr(0, bytes.size() / 2);
    std::ofstream(scratch / "cut.hdr", std::ios::binary) << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n\x02\x02";
    writeExr(Image(100, 51, 3), scratch / "odd.exr");
    writeExr(Image(8, 8, 3), scratch / "square.exr");
    const auto run = [&](const std::string& name) {
        return nacre(convert((scratch / name).string(), scratch / "a.exr"));
    };
    expectFailure(run("cut.exr"), 1, {"cut.exr: expected", "found"});
    expectFailure(run("cut.hdr"), 1, {"cut.hdr: expected", "truncated"});
    expectFailure(run("odd.exr"), 1, {"odd.exr: expected proportions 2:1", "100 x 51"});
    expectFailure(run("square.exr"), 1, {"angular"});
    expectFailure(run("none.exr"), 1, {"none.exr", "found none"});
    expectFailure(run("%s.exr"), 1, {"six faces"});
    EXPECT_FALSE(std::filesystem::exists(scratch / "a.exr"));
}

TEST(CommandEnvmap, WrongUsageIsExitTwo) {
    const Scratch scratch;
    const std::string source = latlong(scratch), out = (scratch / "a.exr").string();
    expectFailure(nacre({"envmap", source, "-o", out}), 2, {"--convert"});
    expectFailure(nacre(convert(source, out, {"--layout", "sphere"})), 2, {"--layout", "cube", "octahedral"});
    expectFailure(nacre(convert(source, out, {"--size", "0"})), 2, {"--size", "1 to 4096"});
    expectFailure(nacre(convert(source, out, {"--source-layout", "fisheye"})), 2, {"mirror_ball"});
    expectFailure(nacre(convert(source, out, {"--flip", "z"})), 2, {"--flip"});
    expectFailure(nacre(convert(source, out, {"--yaw", "north"})), 2, {"--yaw", "'north'"});
    expectFailure(nacre(convert(source, out, {"--scale", "-1"})), 2, {"--scale", "auto"});
    expectFailure(nacre(convert(source, source)), 2, {"other than the source"});
    expectFailure(nacre(convert(source, scratch.folder())), 1, {"can't write"});
}

TEST(CommandEnvmap, FlipAndYawAreWrittenIntoTheAsset) {
    const Scratch scratch;
    const Outcome outcome =
        nacre(convert(latlong(scratch), scratch / "a.exr", {"--flip", "y", "--yaw", "-90.5", "--json"}));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const json meta = json::parse(outcome.out);
    EXPECT_EQ(meta["flip"], "y");
    EXPECT_EQ(meta["yaw_deg"], -90.5);
    EXPECT_THAT(nacre({"eval", (scratch / "a.exr").string()}, {.input = "0,-1,0\n", .stdoutPath = {}}).out,
                HasSubstr("1.9"));
}

Outcome eval(const std::filesystem::path& file, const std::string& lines) {
    return nacre({"eval", file.string()}, {lines, {}, RLIM_INFINITY, false});
}

std::vector<std::string> filter(const std::string& source, const std::filesystem::path& output,
                                std::vector<std::string> more) {
    std::vector<std::string> arguments = {"envmap", source, "-o", output.string(), "--layout", "cube"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

TEST(CommandEnvmapLobe, ChainVerifiesItsErrorAndAnswersByAlpha) {
    const Scratch scratch;
    const std::string source = latlong(scratch, 40, 32);
    const Outcome outcome =
        nacre(filter(source, scratch / "a.exr",
                     {"--size", "16", "--lobe", "ggx", "--chain", "4", "--verify", "--samples", "40", "--json"}));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const json meta = json::parse(outcome.out);
    EXPECT_EQ(meta["level_mapping"]["values"].size(), 4u);
    EXPECT_EQ(meta["lobes"].size(), 4u);
    EXPECT_EQ(meta["lobes"][0]["lobe"], "mirror");
    EXPECT_EQ(meta["lobes"][3]["alpha"], 1);
    EXPECT_EQ(meta["lobes"][3]["size"], 2);
    EXPECT_LT(meta["error"]["rmse"], 2e-3);
    EXPECT_GT(meta["error"]["rmse"], 0);
    const Outcome answer = eval(scratch / "a.exr", "0,1,0,1\n0,-1,0,1\n");
    ASSERT_EQ(answer.code, 0) << answer.err;
    EXPECT_GT(std::stod(answer.out), 1.2);  // 1 + 2/3 y for a cosine lobe, and a spot
    EXPECT_LT(std::stod(answer.out.substr(answer.out.find('\n') + 1)), 0.8);
}

TEST(CommandEnvmapLobe, WhiteGivesOneThroughTheFile) {
    const Scratch scratch;
    Image white(16, 8, 3);
    for (float& v : white.data()) v = 1;
    writeExr(white, (scratch / "white.exr").string());
    for (const std::vector<std::string>& lobe : {std::vector<std::string>{"--lobe", "diffuse"},
                                                 {"--lobe", "phong", "--exponent", "100"},
                                                 {"--lobe", "ggx_refraction", "--alpha", "0.3", "--ior", "1.5"}}) {
        ASSERT_EQ(nacre(filter((scratch / "white.exr").string(), scratch / "a.exr", lobe)).code, 0);
        const Outcome answer = eval(scratch / "a.exr", "1,2,3\n");
        EXPECT_NEAR(std::stod(answer.out), 1, 1e-5) << lobe[1];
    }
}

TEST(CommandEnvmapLobe, BudgetsChooseTheSizeOrFail) {
    const Scratch scratch;
    const std::string source = latlong(scratch, 1, 32);
    const Outcome cheap =
        nacre(filter(source, scratch / "a.exr", {"--lobe", "diffuse", "--max-error", "0.02", "--json"}));
    ASSERT_EQ(cheap.code, 0) << cheap.err;
    EXPECT_LE(json::parse(cheap.out)["error"]["filtered_rmse"], 0.02);
    EXPECT_LE(json::parse(cheap.out)["size"], 8);
    const Outcome small =
        nacre(filter(source, scratch / "b.exr", {"--lobe", "diffuse", "--max-bytes", "5000", "--json"}));
    ASSERT_EQ(small.code, 0) << small.err;
    EXPECT_EQ(json::parse(small.out)["size"], 8);  // 6 · 8² · 3 floats = 4608 bytes
    expectFailure(nacre(filter(source, scratch / "c.exr",
                               {"--lobe", "phong", "--exponent", "500", "--size", "4", "--max-error", "1e-5"})),
                  1, {"expected an error", "found"});
    EXPECT_FALSE(std::filesystem::exists(scratch / "c.exr"));
}

TEST(CommandEnvmapLobe, WrongUsageIsExitTwo) {
    const Scratch scratch;
    const std::string source = latlong(scratch);
    const auto fails = [&](std::vector<std::string> more, const std::string& fragment) {
        expectFailure(nacre(filter(source, scratch / "a.exr", std::move(more))), 2, {fragment});
    };
    fails({}, "--lobe");
    fails({"--lobe", "diffuse", "--convert"}, "--convert");
    fails({"--lobe", "gloss"}, "gloss");
    fails({"--lobe", "phong"}, "--exponent");
    fails({"--lobe", "phong", "--exponent", "-1"}, "--exponent");
    fails({"--lobe", "ggx"}, "--alpha");
    fails({"--lobe", "ggx", "--alpha", "2"}, "alpha");
    fails({"--lobe", "diffuse", "--alpha", "0.1"}, "--alpha");
    fails({"--lobe", "ggx_refraction", "--alpha", "0.1"}, "--ior");
    fails({"--lobe", "ggx", "--chain", "3", "--values", "0.1,0.2"}, "--values");
    fails({"--lobe", "ggx", "--chain", "3", "--values", "0.1,0.2,0.1"}, "strictly");
    fails({"--lobe", "ggx", "--chain", "9", "--size", "16"}, "--chain");
    fails({"--lobe", "mirror", "--max-error", "0.1"}, "--max-error");
    fails({"--convert", "--max-bytes", "1000"}, "--max-bytes");
    fails({"--convert", "--ior", "1.5"}, "--ior");
    EXPECT_FALSE(std::filesystem::exists(scratch / "a.exr"));
}

TEST(CommandEnvmapLobe, ScaleThatLosesTheLightIsRefused) {
    const Scratch scratch;
    const std::string source = latlong(scratch);
    expectFailure(nacre(filter(source, scratch / "a.exr", {"--lobe", "diffuse", "--format", "half", "--scale", "1e9"})),
                  1, {"--scale", "lost"});
    EXPECT_FALSE(std::filesystem::exists(scratch / "a.exr"));
}

TEST(CommandEnvmapLobe, SourceWithoutAFiniteTexelIsRefused) {
    const Scratch scratch;
    Image image(8, 4, 3);
    for (float& v : image.data()) v = NAN;
    writeExr(image, (scratch / "nan.exr").string());
    expectFailure(nacre(filter((scratch / "nan.exr").string(), scratch / "a.exr", {"--lobe", "diffuse"})), 1,
                  {"nan.exr", "finite"});
}

TEST(CommandFresnel, TablesCarryTheirErrorAndAnswer) {
    const Scratch scratch;
    const std::string file = (scratch / "f.exr").string();
    const Outcome outcome = nacre({"fresnel", "-o", file, "--eta", "1.5", "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_LT(json::parse(outcome.out)["error"]["max_abs"], 5e-4);
    EXPECT_NEAR(std::stod(eval(file, "1\n").out), 0.04, 1e-4);
    expectFailure(eval(file, "2\n"), 1, {"line 1", "[0, 1]"});
    const json small = json::parse(nacre({"fresnel", "-o", file, "--max-error", "0.01", "--json"}).out);
    EXPECT_LE(small["error"]["max_abs"], 0.01);
    EXPECT_LE(small["size"], 32);
    expectFailure(nacre({"fresnel", "-o", file, "--max-error", "1e-9"}), 1, {"expected an error"});
    expectFailure(nacre({"fresnel", "-o", file, "--eta", "0"}), 2, {"eta"});
    expectFailure(nacre({"fresnel", "-o", file, "--eta", "a/b"}), 2, {"--eta"});
    const json rough = json::parse(nacre({"fresnel", "-o", file, "--scale-bias", "--json"}).out);
    EXPECT_EQ(rough["kind"], "scale_bias");
    EXPECT_LT(rough["error"]["max_abs"], 5e-3);
    EXPECT_THAT(eval(file, "1,0\n").out, HasSubstr(","));
    EXPECT_THAT(nacre({"info", file}).err, IsEmpty());
}

TEST(CommandSh, PrintsNineCoefficients) {
    const Scratch scratch;
    const std::string source = latlong(scratch, 1, 64);
    const json meta = json::parse(nacre({"sh", source, "--json"}).out);
    ASSERT_EQ(meta["coefficients"].size(), 9u);
    EXPECT_NEAR(meta["coefficients"][0][0], std::sqrt(4 * 3.14159265), 1e-2);      // L = 1 + y
    EXPECT_NEAR(meta["coefficients"][1][0], std::sqrt(4 * 3.14159265 / 3), 1e-2);  // of y
    const json diffuse = json::parse(nacre({"sh", source, "--lobe", "diffuse", "--json"}).out);
    EXPECT_NEAR(diffuse["coefficients"][1][0].get<double>(), meta["coefficients"][1][0].get<double>() * 2 / 3, 1e-6);
    const std::string lines = nacre({"sh", source, "--order", "1"}).out;
    EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 4);
    expectFailure(nacre({"sh", (scratch / "none.exr").string()}), 1, {"none.exr"});
    expectFailure(nacre({"sh", source, "--order", "2000"}), 2, {"--order"});
}

}  // namespace
}  // namespace nacre
