// nacre bump, and nacre info of what it writes, from outside: the hard cases of reliefs among them.
#include <csignal>
#include <thread>

#include "core/file.hpp"
#include "tests/cli/bump_command.hpp"
#include "tests/core/height_files.hpp"

namespace nacre {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace tests::bump;
using tests::contents;
using tests::nacre;
using tests::Outcome;
using tests::Scratch;
using tests::start;
using tests::waitFor;
using tests::writeExr;

TEST(CommandBump, JsonHasWhatTheDocumentationNames) {
    const Scratch scratch;
    const std::string source = relief(scratch, 24, 16, bumps);
    const json meta = baked(source, scratch / "a.exr", kEverything);
    for (const char* key :
         {"kind",    "source",       "source_hash",     "size",       "wrap",    "surface",     "texel_size",
          "scale",   "height_range", "azimuths",        "directions", "weights", "ellipse_fit", "bytes",
          "seconds", "cpu_seconds",  "measure_seconds", "times",      "error",   "input",       "command_line",
          "format"})
        EXPECT_TRUE(meta.contains(key)) << key;
    EXPECT_EQ(meta["kind"], "bump");
    EXPECT_EQ(meta["size"], json({24, 16}));
    EXPECT_EQ(meta["directions"].size(), 5u);
    for (const char* key : {"misjudged", "misjudged_radii_only"}) EXPECT_LT(meta["error"]["ellipses"][key], 0.2) << key;
    EXPECT_LT(meta["error"]["horizon"]["max_rad"], 0.02);
    EXPECT_GT(meta["error"]["horizon"]["share_within_1e-3"], 0.95);
    EXPECT_LT(meta["error"]["horizon"]["rmse_deg"], 0.1);
    EXPECT_LT(meta["error"]["scatter"]["hit_mismatch"], 0.01);
    EXPECT_LT(meta["error"]["scatter"]["beyond_one_texel"], 0.01);
    EXPECT_GT(meta["times"]["ellipses"]["texels_per_second"], 0);
    EXPECT_GT(meta["times"]["horizon"]["horizons_per_second"], 0);
    EXPECT_GT(meta["times"]["scatter"]["rays_per_second"], 0);
    EXPECT_EQ(json::parse(nacre({"info", (scratch / "a.exr").string(), "--json"}).out), meta);
    const Outcome info = nacre({"info", (scratch / "a.exr").string()});
    EXPECT_THAT(info.out, AllOf(HasSubstr("ellipse0"), HasSubstr("misjudged"), HasSubstr("wrap")));
    EXPECT_THAT(info.err, IsEmpty());
}

TEST(CommandBump, DefaultsToNormalsAndEllipses) {
    const Scratch scratch;
    const std::string source = relief(scratch, 16, 16, bumps);
    EXPECT_EQ(baked(source, scratch / "a.exr", {"--directions", "16", "--json"})["ellipse_fit"]["directions"], 16);
    const json meta = baked(source, scratch / "a.exr", {"--json"});
    EXPECT_TRUE(meta.contains("normal_levels") && meta.contains("ellipse_fit"));
    EXPECT_FALSE(meta.contains("azimuths") || meta.contains("directions"));
    EXPECT_EQ(meta["ellipse_fit"]["directions"], 128);
}

TEST(CommandBump, SameAssetForAnyThreadCount) {
    const Scratch scratch;
    const std::string source = relief(scratch, 24, 16, bumps);
    std::vector<std::string> one = kEverything, two = kEverything;
    one.insert(one.end(), {"--threads", "1"});
    two.insert(two.end(), {"--threads", "3"});
    EXPECT_EQ(baked(source, scratch / "1.exr", one)["error"], baked(source, scratch / "2.exr", two)["error"]);
    std::string lines;
    for (int i = 0; i < 50; ++i) lines += fmt::format("{},{},{},{},0.5\n", 0.01 * i, 0.02 * i, 0.1 * i - 2, 0.7);
    EXPECT_EQ(eval(scratch / "1.exr", lines).out, eval(scratch / "2.exr", lines).out);
}

TEST(CommandBump, HardReliefsAreBakedAndMeasured) {
    const std::vector<std::pair<const char*, Field>> fields = {
        {"flat", flat},
        {"spike", spike},
        {"step", step},
        {"ramp", [](int x, int y) { return 0.5 * x + 0.25 * y; }},
        {"saw-tooth at Nyquist", [](int x, int) { return x % 2; }},
        {"8-bit terraces", [](int x, int y) { return std::floor(3 * bumps(x, y)); }},
        {"heights of 1e6", [](int x, int y) { return 1e6 * bumps(x, y); }},
        {"heights of 1e-6", [](int x, int y) { return 1e-6 * bumps(x, y); }}};
    for (const auto& [name, field] : fields)
        for (const char* wrap : {"repeat", "clamp", "mirror"}) {
            const Scratch scratch;
            std::vector<std::string> more = kEverything;
            more.insert(more.end(), {"--wrap", wrap, "--format", "float"});
            const json meta = baked(relief(scratch, 17, 16, field), scratch / "a.exr", more);
            ASSERT_TRUE(meta.is_object()) << name;
            EXPECT_LT(meta["error"]["horizon"]["rmse_deg"], 0.5) << name << " " << wrap;
            EXPECT_LT(meta["error"]["ellipses"]["misjudged"], 0.25) << name << " " << wrap;
            EXPECT_LT(meta["error"]["scatter"]["hit_mismatch"], 0.02) << name << " " << wrap;
        }
}

TEST(CommandBump, OddAndThinSizes) {
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {9, 1}, {7, 5}, {2, 3}}) {
        const Scratch scratch;
        const json meta = baked(relief(scratch, width, height, bumps), scratch / "a.exr", kEverything);
        EXPECT_EQ(meta["size"], json({width, height}));
        EXPECT_EQ(eval(scratch / "a.exr", "0.3,0.4,0,0,1\n").out, "1,1\n") << "light from above";
    }
}

TEST(CommandBump, FlatFieldIsAlwaysLitAndSeesNothing) {
    const Scratch scratch;
    const json meta = baked(relief(scratch, 16, 16, flat), scratch / "a.exr", kEverything);
    EXPECT_EQ(meta["error"]["ellipses"]["misjudged"], 0);
    EXPECT_EQ(meta["error"]["horizon"]["max_rad"], 0);
    EXPECT_EQ(eval(scratch / "a.exr", "0.2,0.2,1,0,0\n0.7,0.1,-0.3,0.1,0.001\n0.2,0.2,0.1,0,-0.2\n").out,
              "1,1\n1,1\n0,0\n")
        << "a light in the horizon plane is lit, one below is not";
    EXPECT_EQ(eval(scratch / "a.exr", "0.2,0.2\n", {"--normal"}).out, "0,0,1\n");
}

TEST(CommandBump, StepCastsItsShadowAcrossTheSeamWhereItRepeats) {
    const Scratch scratch;
    const std::string source = relief(scratch, 16, 4, step);
    for (const auto& [wrap, expected] : {std::pair{"repeat", "0,0\n"}, {"clamp", "1,1\n"}}) {
        ASSERT_EQ(nacre(bake(source, scratch / "a.exr", {"--horizon", "8", "--heights", "--wrap", wrap})).code, 0);
        EXPECT_EQ(eval(scratch / "a.exr", "0.96875,0.5,1,0,0.5\n").out, expected)
            << wrap;  // the last column, light along +u
        EXPECT_EQ(eval(scratch / "a.exr", "0.53125,0.5,-1,0,0.5\n").out, "0,0\n") << wrap;  // behind the step
    }
}

TEST(CommandBump, HolesCastNoShadow) {
    const Scratch scratch;
    const std::string source = relief(scratch, 16, 16, [](int x, int y) { return x == 8 ? NAN : bumps(x, y); });
    expectFailure(nacre(bake(source, scratch / "a.exr")), 1, {"16 NaN", "(8, 0)", "--nodata nan"});
    EXPECT_FALSE(std::filesystem::exists(scratch / "a.exr"));
    std::vector<std::string> more = kEverything;
    more.insert(more.end(), {"--nodata", "nan"});
    const Outcome outcome = nacre(bake(source, scratch / "a.exr", more));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("16 of 256 texels are holes"));
    EXPECT_EQ(json::parse(outcome.out)["holes"], 16);
    EXPECT_EQ(eval(scratch / "a.exr", "0.53125,0.5,0.9,0,0.1\n").out, "1,1\n") << "holes are lit";
    EXPECT_EQ(eval(scratch / "a.exr", "0.53125,0.5,0.9,0,0.1\n", {"--source", source}).out, "1,1\n");
}

TEST(CommandBump, UnitsOfIntegersFloatsAndTexels) {
    const Scratch scratch;
    writeFile(scratch / "a.bmp", tests::greyBmp(4, 2, {0, 51, 102, 153, 204, 255, 0, 0}));
    writeFile(scratch / "a.tif", tests::tiff16(2, 2, {-100, 0, 300, 20}, true, "20"));
    const Outcome quiet = nacre(bake((scratch / "a.bmp").string(), scratch / "a.exr", {"--normals", "--json"}));
    EXPECT_THAT(quiet.err, AllOf(HasSubstr("uint8 codes taken as 0 to 1"), HasSubstr("--scale")));
    const json codes = baked((scratch / "a.bmp").string(), scratch / "a.exr",
                             {"--normals", "--scale", "10", "--texel-size", "2", "--json"});
    EXPECT_EQ(codes["height_range"], json({0.0, 10.0}));
    EXPECT_EQ(codes["height_range_texels"], json({0.0, 5.0}));
    const json model = baked((scratch / "a.tif").string(), scratch / "a.exr", {"--normals", "--scale", "-1", "--json"});
    EXPECT_EQ(model["height_range"], json({-300.0, 100.0}));
    EXPECT_EQ(model["holes"], 1);
}

TEST(CommandBump, ColoursNeedAChannel) {
    const Scratch scratch;
    Image colours(4, 4, 3);
    colours.setRgb(2, 1, Rgb(1, 2, 3));
    const std::string source = (scratch / "c.exr").string();
    writeExr(colours, source);
    expectFailure(nacre(bake(source, scratch / "a.exr")), 1, {"c.exr", "(2, 1)", "--channel"});
    EXPECT_EQ(baked(source, scratch / "a.exr", {"--normals", "--channel", "b", "--json"})["height_range"],
              json({0.0, 3.0}));
}

TEST(CommandBump, BudgetsChooseOrSayHowNearTheyCame) {
    const Scratch scratch;
    const std::string source = relief(scratch, 24, 24, bumps);
    const json loose = baked(source, scratch / "a.exr", {"--ellipses", "--max-error", "0.4", "--json"});
    EXPECT_EQ(loose["ellipse_fit"]["directions"], 32);
    EXPECT_LE(loose["error"]["ellipses"]["misjudged"], 0.4);
    const json exact = baked(source, scratch / "a.exr", {"--ellipses", "--max-error", "0.004", "--json"});
    EXPECT_FALSE(exact.contains("ellipse_fit")) << "ellipses can't: a horizon map";
    EXPECT_GE(exact["azimuths"], 8);
    EXPECT_LE(exact["error"]["horizon"]["misjudged"], 0.004);
    expectFailure(nacre(bake(source, scratch / "b.exr", {"--horizon", "9", "--max-error", "1e-4"})), 1,
                  {"b.exr: expected at most 0.0001 of shadows misjudged", "found", "azimuths"});
    expectFailure(nacre(bake(source, scratch / "b.exr", {"--max-bytes", "1000"})), 1, {"at most 1000 bytes", "found"});
    expectFailure(nacre(bake(source, scratch / "b.exr", {"--max-error", "1e-4", "--max-bytes", "20000"})), 1,
                  {"b.exr: expected at most 0.0001 of shadows misjudged in 20000 bytes", "found"});
    for (const char* share : {"1e-9", "2"})
        expectFailure(nacre(bake(source, scratch / "b.exr", {"--max-error", share})), 2, {"--max-error", "to 1"});
    EXPECT_FALSE(std::filesystem::exists(scratch / "b.exr"));
}

TEST(CommandBump, IndirectLightIsMeasured) {
    const Scratch scratch;
    const std::string source = relief(scratch, 24, 24, bumps);
    const json meta = baked(source, scratch / "a.exr",
                            {"--indirect", "--light", "1,0,1", "--albedo", "0.9,0.5,0.2", "--paths", "50", "--json"});
    EXPECT_LE(meta["error"]["indirect"]["relative_rmse_total"], 0.05);
    EXPECT_GT(meta["error"]["indirect"]["relative_rmse"], 0);
    EXPECT_EQ(meta["light"]["paths"], 50);
    EXPECT_EQ(meta["light"]["bounces"], 3);
    EXPECT_NEAR(meta["light"]["direction"][0], std::sqrt(0.5), 1e-6);
    for (const std::vector<std::string>& wrong :
         std::vector<std::vector<std::string>>{{"--light", "1,0,1"},
                                               {"--indirect", "--light", "1,0,-1"},
                                               {"--indirect", "--light", "1,0"},
                                               {"--indirect", "--albedo", "1.5"},
                                               {"--indirect", "--paths", "0"}})
        expectFailure(nacre(bake(source, scratch / "b.exr", wrong)), 2, {wrong[wrong.size() - 2]});
}

TEST(CommandBump, WrongUsageIsExitTwo) {
    const Scratch scratch;
    const std::string source = relief(scratch, 8, 8, bumps);
    const auto fails = [&](std::vector<std::string> more, const std::vector<std::string>& fragments) {
        expectFailure(nacre(bake(source, scratch / "a.exr", std::move(more))), 2, fragments);
    };
    fails({"--frob"}, {"--frob"});
    fails({"--horizon", "0"}, {"--horizon", "1 to 256"});
    fails({"--scatter", "x"}, {"--scatter", "'x'"});
    fails({"--ellipses", "--directions", "4"}, {"--directions", "8 to 4096"});
    fails({"--ellipses", "--fit", "best"}, {"--fit", "radii"});
    fails({"--normals", "--fit", "full"}, {"--fit", "--ellipses"});
    fails({"--wrap", "tile"}, {"--wrap", "mirror"});
    fails({"--scale", "0"}, {"--scale", "'0'"});
    fails({"--scale", "nan"}, {"--scale"});
    fails({"--texel-size", "-2"}, {"--texel-size"});
    fails({"--nodata", "none"}, {"--nodata", "nan"});
    fails({"--channel", "x"}, {"--channel"});
    fails({"--scatter", "4", "--format", "unorm8"}, {"--format", "half or float"});
    fails({"--normals", "--max-error", "0.1"}, {"--max-error"});
    fails({"--ellipses", "--horizon", "8", "--max-error", "0.1"}, {"--max-error", "both"});
    expectFailure(nacre({"bump", source}), 2, {"--output is required"});
    expectFailure(nacre(bake(source, source)), 2, {"other than the source"});
    expectFailure(nacre(bake(source, scratch / "a.png")), 2, {".exr"});
    EXPECT_EQ(scratch.fileCount(), 1u) << "the source alone";
}

TEST(CommandBump, BrokenSourcesAreRefusedInOneLine) {
    const Scratch scratch;
    const std::string bytes = contents(relief(scratch, 32, 32, bumps));
    writeFile(scratch / "cut.exr", bytes.substr(0, bytes.size() / 2));
    const std::string tiff = tests::tiff16(9, 9, std::vector<int>(81, 3), true, "");
    writeFile(scratch / "cut.tif", tiff.substr(0, tiff.size() - 9));
    writeFile(scratch / "text.png", "no picture");
    writeExr(Image(4, 4, 2), scratch / "zn.exr", {.channels = {"Z", "N"}});
    const auto run = [&](const char* name) { return nacre(bake((scratch / name).string(), scratch / "a.exr")); };
    expectFailure(run("cut.exr"), 1, {"cut.exr: expected", "found"});
    expectFailure(run("cut.tif"), 1, {"cut.tif: expected a complete TIFF"});
    expectFailure(run("text.png"), 1, {"text.png: expected a complete picture"});
    expectFailure(run("zn.exr"), 1, {"zn.exr: expected channels"});
    expectFailure(run("none.png"), 1, {"found none"});
    relief(scratch, 8, 8, [](int x, int) { return x == 3 ? INFINITY : 0; });
    expectFailure(run("heights.exr"), 1, {"infinity", "(3, 0)"});
    EXPECT_FALSE(std::filesystem::exists(scratch / "a.exr"));
    ASSERT_EQ(nacre(bake(relief(scratch, 16, 16, bumps), scratch / "a.exr", {"--normals"})).code, 0);
    const std::string whole = contents(scratch / "a.exr");
    for (std::size_t tenth = 0; tenth < 10; ++tenth) {
        writeFile(scratch / "b.exr", whole.substr(0, whole.size() * tenth / 10));
        expectFailure(eval(scratch / "b.exr", "0,0\n", {"--normal"}), 1, {"b.exr"});
    }
    expectFailure(nacre(bake((scratch / "a.exr").string(), scratch / "c.exr")), 1, {"a nacre asset"});
}

TEST(CommandBump, SignalsHalfWayLeaveNoFile) {
    const Scratch in;
    const std::string source = relief(in, 96, 96, bumps);
    for (const int signal : {SIGTERM, SIGINT, SIGKILL})
        for (const int milliseconds : {5, 20, 60}) {
            const Scratch scratch, io;
            const pid_t child = start(bake(source, scratch / "a.exr", {"--scatter", "64", "--horizon", "64"}), {}, io);
            std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
            ::kill(child, signal);
            if (waitFor(child) == 0) continue;  // it was faster
            EXPECT_FALSE(std::filesystem::exists(scratch / "a.exr"));
            EXPECT_TRUE(signal == SIGKILL || scratch.fileCount() == 0) << "after signal " << signal;
        }
}

}  // namespace
}  // namespace nacre
