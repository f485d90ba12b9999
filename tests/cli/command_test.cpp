// The nacre command from outside: exit codes, one-line messages, and what it leaves on disk when something fails.
#include <gmock/gmock.h>

#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/cli/process.hpp"

namespace nacre {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;
using tests::contents;
using tests::nacre;
using tests::Outcome;
using tests::Scratch;
using tests::start;
using tests::Surroundings;
using tests::waitFor;

void expectFailure(const Outcome& outcome, int code, const std::vector<std::string>& fragments) {
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_THAT(outcome.err, StartsWith("nacre: "));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    for (const std::string& fragment : fragments) EXPECT_THAT(outcome.err, HasSubstr(fragment));
}

std::vector<std::string> bake(const std::filesystem::path& output, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"factorize", "blinn-phong:kd=0.2,ks=0.5,n=20", "-o", output.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

TEST(CommandUsage, WithoutTheViewerViewSaysHowToGetIt) {
    const Scratch scratch;
    std::filesystem::copy_file(NACRE_COMMAND, scratch / "nacre");
    const std::string err = (scratch / "err").string();
    EXPECT_NE(std::system(((scratch / "nacre").string() + " view a.obj 2> " + err).c_str()), 0);
    EXPECT_THAT(contents(err),
                AllOf(StartsWith("nacre: view: expected the viewer"), HasSubstr("./dev view builds it")));
}

TEST(CommandUsage, HelpOfEveryVerbGoesToStandardOutput) {
    for (const std::vector<std::string>& words : {std::vector<std::string>{"--help"},
                                                  {"factorize", "--help"},
                                                  {"envmap", "--help"},
                                                  {"bump", "--help"},
                                                  {"transfer", "--help"},
                                                  {"bake", "--help"},
                                                  {"info", "--help"},
                                                  {"eval", "--help"},
                                                  {"models", "--help"},
                                                  {"methods", "--help"},
                                                  {"view", "--help"},
                                                  {"--help-all"},
                                                  {"--version"}}) {
        const Outcome outcome = nacre(words);
        EXPECT_EQ(outcome.code, 0) << words[0];
        EXPECT_THAT(outcome.out, Not(IsEmpty())) << words[0];
        EXPECT_THAT(outcome.err, IsEmpty()) << words[0];
    }
}

TEST(CommandUsage, WrongUsageIsExitTwo) {
    const Scratch scratch;
    expectFailure(nacre({}), 2,
                  {"expected a verb",
                   "factorize, envmap, bump, fresnel, sh, transfer, bake, info, eval, render, view, models, methods"});
    expectFailure(nacre({"frobnicate"}), 2, {"'frobnicate'", "factorize"});
    expectFailure(nacre({"factorize", "lambert"}), 2, {"--output is required"});
    expectFailure(nacre({"info"}), 2, {"file"});
    expectFailure(nacre(bake(scratch / "a.exr", {"--frob"})), 2, {"--frob"});
    expectFailure(nacre(bake(scratch / "a.exr", {"--size", "1"})), 2, {"--size", "2 to 4096", "'1'"});
    expectFailure(nacre(bake(scratch / "a.exr", {"--size", "64x"})), 2, {"--size", "'64x'"});
    expectFailure(nacre(bake(scratch / "a.exr", {"--format", "bc6"})), 2, {"--format", "half", "float", "unorm8"});
    expectFailure(nacre(bake(scratch / "a.exr", {"--method", "magic"})), 2, {"--method", "auto"});
    expectFailure(nacre(bake(scratch / "a.exr", {"--max-error", "-1"})), 2, {"--max-error", "'-1'"});
    expectFailure(nacre(bake(scratch / "a.exr", {"--max-error", "nan"})), 2, {"--max-error", "'nan'"});
    EXPECT_EQ(scratch.fileCount(), 0u);
}

TEST(CommandUsage, UnknownModelAndParameterListTheKnown) {
    const Scratch scratch;
    const std::string out = (scratch / "a.exr").string();
    expectFailure(nacre({"factorize", "no-such-model", "-o", out}), 2, {"no-such-model", "lambert", "ward"});
    expectFailure(nacre({"factorize", "lambert:shine=1", "-o", out}), 2, {"shine", "kd"});
    expectFailure(nacre({"factorize", "lambert:kd=-1", "-o", out}), 2, {"kd", "-1"});
    expectFailure(nacre({"models", "no-such-model"}), 2, {"no-such-model", "lambert"});
    EXPECT_EQ(scratch.fileCount(), 0u);
}

TEST(CommandUsage, MicroGeometriesTakeAColonAndAreNamedInFull) {
    const Scratch scratch;
    const std::string out = (scratch / "a.exr").string();
    const auto source = [&](const char* text) {
        return json::parse(
                   nacre({"factorize", text, "-o", out, "--size", "8", "--method", "homomorphic", "--json"}).out)
            .value("source", "none");
    };
    EXPECT_EQ(source("micro:ridges:slope=2,resolution=4"), source("micro:ridges,slope=2,resolution=4"));
    for (const char* bare : {"micro", "ridges", "ridges:slope=2", "micro:no-such"})
        expectFailure(nacre({"factorize", bare, "-o", out}), 2, {"unknown", "micro:ridges", "micro:gaussian-bumps"});
}

TEST(CommandModels, ListsNamesRangesAndDefaults) {
    EXPECT_THAT(nacre({"models"}).out, AllOf(HasSubstr("torrance-sparrow"), HasSubstr("alpha"), HasSubstr("default")));
    const json list = json::parse(nacre({"models", "--json"}).out);
    ASSERT_GE(list.size(), 8u);
    for (const json& model : list) {
        EXPECT_TRUE(model["name"].is_string() && model["parameters"].is_array());
        for (const json& p : model["parameters"]) EXPECT_TRUE(p.contains("range") && p.contains("default")) << p;
    }
    EXPECT_GE(json::parse(nacre({"methods", "--json"}).out).size(), 1u);
}

TEST(CommandModels, ListingsFitAHundredColumns) {
    for (const char* verb : {"models", "methods"}) {
        std::istringstream lines(nacre({verb}).out);
        for (std::string line; std::getline(lines, line);) {
            const auto starts = std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xc0) != 0x80; });
            EXPECT_LE(starts, 100) << line;
        }
    }
    EXPECT_THAT(nacre({"models", "sgd"}).out, HasSubstr("; default gold-paint\n")) << "a range longer than a line";
}

TEST(CommandFactorize, OutputThatIsNoExrIsWrongUsage) {
    const Scratch scratch;
    expectFailure(nacre(bake(scratch / "x.png")), 2, {"x.png: expected a name that ends in .exr, found .png"});
    expectFailure(nacre(bake(scratch / "x")), 2, {"expected a name that ends in .exr, found no ending"});
    EXPECT_EQ(scratch.fileCount(), 0u);
    EXPECT_EQ(nacre(bake(scratch / "x.EXR")).code, 0);
}

TEST(CommandFactorize, OptionThatTheMethodLacksIsWrongUsage) {
    const Scratch scratch;
    expectFailure(nacre(bake(scratch / "a.exr", {"--method", "single-lobe", "--parametrization", "in_out"})), 2,
                  {"--parametrization: only svd takes it, found method single-lobe"});
    expectFailure(nacre(bake(scratch / "a.exr", {"--method", "cosine", "--terms", "2"})), 2,
                  {"--terms: only fit and svd take it, found method cosine"});
    expectFailure(nacre(bake(scratch / "a.exr", {"--parametrization", "in_out"})), 2, {"only svd takes it", "auto"});
    EXPECT_EQ(scratch.fileCount(), 0u);
}

TEST(CommandFactorize, JsonHasWhatTheDocumentationNames) {
    const Scratch scratch;
    const Outcome outcome = nacre(bake(scratch / "a.exr", {"--json"}));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const json object = json::parse(outcome.out);
    for (const char* key : {"kind", "source", "method", "fetches", "bytes", "seconds", "error", "command_line", "nacre",
                            "source_hash", "form", "textures", "version"})
        EXPECT_TRUE(object.contains(key)) << key;
    for (const char* key : {"l2_rel", "log_rms", "max_rel", "grazing_l2_rel", "sphere_psnr", "albedo_max_abs",
                            "reciprocity_residual", "samples", "negative", "non_finite"})
        EXPECT_TRUE(object["error"].contains(key)) << key;
    EXPECT_EQ(object["kind"], "brdf");
    EXPECT_EQ(object["error"]["non_finite"], 0);
    EXPECT_GT(object["error"]["samples"], 100000);
    EXPECT_THAT(object["command_line"].get<std::string>(), HasSubstr("nacre factorize blinn-phong:"));
    EXPECT_EQ(scratch.fileCount(), 1u) << "no provisional file stays";
    EXPECT_EQ(json::parse(nacre({"info", (scratch / "a.exr").string(), "--json"}).out), object);
}

TEST(CommandFactorize, SameBytesForAnyThreadCount) {
    const Scratch scratch;
    json one = json::parse(nacre(bake(scratch / "1.exr", {"--json", "--threads", "1"})).out);
    json two = json::parse(nacre(bake(scratch / "2.exr", {"--json", "--threads", "2"})).out);
    for (const char* key : {"seconds", "measure_seconds", "command_line"}) one.erase(key), two.erase(key);
    EXPECT_EQ(one, two);
}

TEST(CommandFactorize, BudgetThatCannotBeMetFails) {
    const Scratch scratch;
    expectFailure(nacre(bake(scratch / "a.exr", {"--size", "64", "--max-bytes", "100"})), 1, {"at most 100 bytes"});
    expectFailure(nacre(bake(scratch / "a.exr", {"--size", "8", "--max-error", "1e-9"})), 1, {"l2_rel <= 1e-09"});
    expectFailure(nacre(bake(scratch / "a.exr", {"--max-bytes", "1", "--max-error", "1e-9"})), 1,
                  {"the smallest takes"});
    expectFailure(nacre(bake(scratch / "a.exr", {"--max-bytes", "9000", "--max-error", "1e-9"})), 1,
                  {"nearest tried: ", "with error"});
    expectFailure(nacre(bake(scratch / "a.exr", {"--max-fetches", "0"})), 2, {"--max-fetches", "1 to 64"});
    EXPECT_EQ(scratch.fileCount(), 0u);
}

TEST(CommandFactorize, BlackMeetsAnyBudget) {
    const Scratch scratch;
    const Outcome outcome = nacre({"factorize", "torrance-sparrow:ks=0", "-o", (scratch / "a.exr").string(),
                                   "--max-error", "1e-6", "--max-bytes", "1000"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("l2_rel 0 "), Not(HasSubstr("nan"))));
    EXPECT_THAT(outcome.err, IsEmpty());
}

TEST(CommandFactorize, FewSamplesAreSaid) {
    const Scratch scratch;
    std::ofstream(scratch / "few.csv") << "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,r,g,b\n"
                                          "10,0,10,180,1,1,1\n50,0,20,90,0.1,0.1,0.1\n70,0,30,20,0.3,0.3,0.3\n";
    const Outcome outcome = nacre(
        {"factorize", (scratch / "few.csv").string(), "-o", (scratch / "a.exr").string(), "--size", "16", "--json"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("3 distinct samples; samples left out are missed by"), HasSubstr(" %")));
    EXPECT_GT(json::parse(outcome.out)["data"]["holdout_l2_rel"].get<double>(), 0.1);
}

TEST(CommandFactorize, MissingAndBrokenSources) {
    const Scratch scratch;
    const std::string out = (scratch / "a.exr").string();
    expectFailure(nacre({"factorize", (scratch / "none.binary").string(), "-o", out}), 1,
                  {"none.binary", "found none"});
    std::ofstream(scratch / "bad.binary", std::ios::binary) << std::string("\x01\0\0\0\x02\0\0\0\x03\0\0\0", 12);
    expectFailure(nacre({"factorize", (scratch / "bad.binary").string(), "-o", out}), 1,
                  {"bad.binary", "expected", "found"});
    std::ofstream(scratch / "cut.bsdf", std::ios::binary) << "tensor_file\0\1";
    expectFailure(nacre({"factorize", (scratch / "cut.bsdf").string(), "-o", out}), 1, {"cut.bsdf"});
    EXPECT_EQ(scratch.fileCount(), 2u);
}

/// A MERL table: 0.1 in red everywhere, less in the others, and `peak` times that in one cell.
std::filesystem::path merlTable(const Scratch& scratch, double peak) {
    constexpr std::size_t kCells = 90 * 90 * 180, kSpike = (30 * 90 + 20) * 180 + 50;
    std::vector<double> cells(kCells, 150);
    cells[kSpike] *= peak;
    std::ofstream file(scratch / "spike.binary", std::ios::binary);
    const std::int32_t sizes[3] = {90, 90, 180};
    file.write(reinterpret_cast<const char*>(sizes), sizeof sizes);
    for (int channel = 0; channel < 3; ++channel)
        file.write(reinterpret_cast<const char*>(cells.data()), kCells * sizeof(double));
    return scratch / "spike.binary";
}

TEST(CommandFactorize, SpikeThatNoMeasurementSeesIsSaid) {
    const Scratch scratch;
    const std::vector<std::string> words = {"factorize", merlTable(scratch, 1e5).string(),
                                            "-o",        (scratch / "a.exr").string(),
                                            "--method",  "fit",
                                            "--size",    "16",
                                            "--json"};
    const Outcome spiked = nacre(words);
    ASSERT_EQ(spiked.code, 0) << spiked.err;
    EXPECT_THAT(spiked.err, AllOf(HasSubstr("% of the energy of"), HasSubstr("spike.binary")));
    EXPECT_GT(std::abs(json::parse(spiked.out)["error"]["energy_seen"].get<double>() - 1), 0.2);
    merlTable(scratch, 1);
    const Outcome even = nacre(words);
    EXPECT_THAT(even.err, Not(HasSubstr("energy")));
    EXPECT_NEAR(json::parse(even.out)["error"]["energy_seen"].get<double>(), 1, 0.02);
}

TEST(CommandFullDisk, DevFullAsOutput) {
    expectFailure(nacre({"factorize", "lambert", "-o", "/dev/full"}), 1, {"/dev/full", "can't write"});
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST(CommandFullDisk, WriteThatFailsHalfWayLeavesNothing) {
    const Scratch scratch;
    Surroundings small;
    small.fileSize = 1000;  // smaller than any asset
    expectFailure(nacre(bake(scratch / "a.exr"), small), 1, {"can't write", "too large"});
    EXPECT_EQ(scratch.fileCount(), 0u);
}

TEST(CommandFullDisk, StandardOutputThatIsFull) {
    Surroundings full;
    full.stdoutPath = "/dev/full";
    expectFailure(nacre({"models"}, full), 1, {"standard output", "No space left"});
}

TEST(CommandOutput, UnwritableAndMissingFolders) {
    const Scratch scratch;
    std::filesystem::permissions(scratch.folder(), std::filesystem::perms::owner_exec);
    Surroundings nobody;
    nobody.asNobody = true;
    expectFailure(nacre(bake(scratch / "a.exr"), nobody), 1, {"a.exr: can't write", "Permission denied"});
    expectFailure(nacre(bake("/no/such/folder/a.exr")), 1, {"/no/such/folder/a.exr", "No such file"});
}

TEST(CommandOutput, KilledMidwayLeavesNoFinalFile) {
    const Scratch scratch, io;
    for (const int milliseconds : {1, 5, 20, 60, 150}) {
        const pid_t child = start(bake(scratch / "a.exr"), {}, io);
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
        ::kill(child, SIGKILL);
        if (waitFor(child) == 0) break;  // it was faster: the file is complete
        if (std::filesystem::exists(scratch / "a.exr")) {
            EXPECT_EQ(nacre({"info", (scratch / "a.exr").string()}).code, 0) << "what has the final name is complete";
            break;
        }
    }
}

TEST(CommandOutput, CatchableSignalsLeaveNoFile) {
    for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
        const Scratch scratch, io;
        int code = 0;
        for (int tried = 0; tried < 40 && code != 128 + signal; ++tried) {
            const pid_t child = start(bake(scratch / "a.exr"), {}, io);
            for (int i = 0; i < 20000 && scratch.fileCount() == 0; ++i)  // until a provisional file is there
                std::this_thread::sleep_for(std::chrono::microseconds(100));
            ::kill(child, signal);
            code = waitFor(child);
            std::error_code none;
            std::filesystem::remove(scratch / "a.exr", none);
            EXPECT_EQ(scratch.fileCount(), 0u) << "after signal " << signal;
        }
        EXPECT_EQ(code, 128 + signal) << "ended as the signal does";
    }
}

TEST(CommandInfo, TruncatedAtEveryTenth) {
    const Scratch scratch;
    ASSERT_EQ(nacre(bake(scratch / "a.exr")).code, 0);
    const std::string whole = contents(scratch / "a.exr");
    for (std::size_t tenth = 0; tenth < 10; ++tenth) {
        std::ofstream(scratch / "cut.exr", std::ios::binary) << whole.substr(0, whole.size() * tenth / 10);
        expectFailure(nacre({"info", (scratch / "cut.exr").string()}), 1, {"cut.exr", "expected", "found"});
    }
}

TEST(CommandInfo, WhatIsNoAsset) {
    const Scratch scratch;
    std::ofstream(scratch / "a.exr") << "nothing like it";
    expectFailure(nacre({"info", (scratch / "a.exr").string()}), 1, {"a.exr", "OpenEXR"});
    expectFailure(nacre({"info", (scratch / "none.exr").string()}), 1, {"none.exr", "found none"});
    expectFailure(nacre({"eval", scratch.folder().string()}), 1, {"folder"});
}

TEST(CommandInfo, ExrThatIsNoNacreAsset) {  // the same file with the attribute under another name
    const Scratch scratch;
    ASSERT_EQ(nacre(bake(scratch / "a.exr")).code, 0);
    std::string bytes = contents(scratch / "a.exr");
    const std::size_t at = bytes.find(std::string("nacre\0string", 12));
    ASSERT_NE(at, std::string::npos);
    bytes[at] = 'N';
    std::ofstream(scratch / "b.exr", std::ios::binary) << bytes;
    expectFailure(nacre({"info", (scratch / "b.exr").string()}), 1, {"b.exr", "an EXR that is no nacre asset"});
}

/// A baked asset whose metadata says something else, at the same length.
std::filesystem::path relabelled(const Scratch& scratch, const std::string& from, const std::string& to) {
    EXPECT_EQ(nacre(bake(scratch / "a.exr")).code, 0);
    std::string bytes = contents(scratch / "a.exr");
    const std::size_t at = bytes.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    if (at != std::string::npos) bytes.replace(at, from.size(), to);
    std::ofstream(scratch / "b.exr", std::ios::binary) << bytes;
    return scratch / "b.exr";
}

TEST(CommandInfo, FormAndKindOfALaterVersion) {  // shown, but not as if they could be used
    const Scratch scratch;
    const std::string form = relabelled(scratch, "\"form\": \"single_lobe\"", "\"form\": \"neural_lobe\"").string();
    for (const std::vector<std::string>& words : {std::vector<std::string>{"info", form}, {"info", form, "--json"}}) {
        const Outcome outcome = nacre(words);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_THAT(outcome.out, HasSubstr("neural_lobe"));
        EXPECT_THAT(outcome.err, AllOf(HasSubstr("unknown factored form 'neural_lobe'"), HasSubstr("can't use")));
    }
    expectFailure(nacre({"eval", form}), 1, {"b.exr", "unknown factored form 'neural_lobe'", "single_lobe"});
    const std::string kind = relabelled(scratch, "\"kind\": \"brdf\"", "\"kind\": \"glow\"").string();
    const Outcome outcome = nacre({"info", kind});
    EXPECT_THAT(outcome.out, HasSubstr("glow"));
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("does not know the kind 'glow'"), HasSubstr("can't use")));
    expectFailure(nacre({"eval", kind}), 1, {"expected an asset of kind brdf, found glow"});
}

TEST(CommandInfo, UsableAssetIsShownWithoutComplaint) {
    const Scratch scratch;
    ASSERT_EQ(nacre(bake(scratch / "a.exr")).code, 0);
    EXPECT_THAT(nacre({"info", (scratch / "a.exr").string()}).err, IsEmpty());
}

TEST(CommandInfo, OversizedFiles) {  // sparse: they take no room on disk, and must take none in memory
    const Scratch scratch;
    for (const char* name : {"huge.exr", "huge.binary", "huge.bsdf", "huge.csv"}) {
        std::ofstream(scratch / name) << "x";
        std::filesystem::resize_file(scratch / name, std::uintmax_t{1} << 36);
        const std::string path = (scratch / name).string();
        const bool isAsset = path.ends_with(".exr");
        expectFailure(isAsset ? nacre({"info", path}) : nacre({"factorize", path, "-o", (scratch / "a.exr").string()}),
                      1, {name, "expected", "found"});
    }
}

class CommandEval : public ::testing::Test {
protected:
    static constexpr const char* kSource = "blinn-phong:kd=0.2,ks=0.5,n=20";
    Outcome eval(const std::string& input, bool withTruth = false) {
        if (!std::filesystem::exists(scratch / "a.exr")) {
            EXPECT_EQ(nacre(bake(scratch / "a.exr")).code, 0);
        }
        std::vector<std::string> arguments = {"eval", (scratch / "a.exr").string()};
        if (withTruth) arguments.insert(arguments.end(), {"--source", kSource});
        Surroundings setup;
        setup.input = input;
        return nacre(arguments, setup);
    }
    const Scratch scratch;
};

TEST_F(CommandEval, SkipsHeaderCommentsAndBlankLines) {
    const Outcome outcome =
        eval("# directions\n\nwix,wiy,wiz,wox,woy,woz\r\n0,0,1,0,0,1\r\n  \n 0.6, 0, 0.8, 0, 0.6, 0.8");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 2) << outcome.out;
}

TEST_F(CommandEval, TruthStandsBesideTheBake) {
    const Outcome outcome = eval("0,0,1,0,0,1\n0.6,0,0.8,-0.6,0,0.8\n", true);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    std::istringstream lines(outcome.out);
    for (std::string line; std::getline(lines, line);) {
        double v[6] = {};
        ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf", v, v + 1, v + 2, v + 3, v + 4, v + 5), 6);
        constexpr double kBake = 0.02;  // relative, at the peak of the lobe, whichever method auto picks
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(v[c] / v[c + 3], 1, kBake) << line;
    }
}

TEST_F(CommandEval, AnotherSourceThanTheBakesIsSaid) {
    EXPECT_THAT(eval("0,0,1,0,0,1\n", true).err, IsEmpty());
    Surroundings setup;
    setup.input = "0,0,1,0,0,1\n";
    const Outcome outcome = nacre({"eval", (scratch / "a.exr").string(), "--source", "lambert"}, setup);
    EXPECT_EQ(outcome.code, 0);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("baked from blinn-phong:"), HasSubstr("set against lambert:")));
}

TEST_F(CommandEval, BelowTheHorizonIsBlack) { EXPECT_EQ(eval("0,0,-1,0,0,1\n").out, "0,0,0\n"); }

TEST_F(CommandEval, BadLinesAreNamed) {
    expectFailure(eval("0,0,1,0,0,1\n0,0,1,0,0\n"), 1, {"line 2", "six numbers", "0,0,1,0,0"});
    expectFailure(eval("0,0,1,0,0,1\n\n0,0,1,0,0,1,7\n"), 1, {"line 3"});
    expectFailure(eval("0,0,1,0,0,1\nwix,wiy,wiz,wox,woy,woz\n"), 1, {"line 2"});
    expectFailure(eval("0,0,2,0,0,1\n"), 1, {"line 1", "wi of length 1"});
    expectFailure(eval("0,0,1,0,0,nan\n"), 1, {"line 1", "wo of length 1"});
    expectFailure(eval("0,0,1,0,0,0x1\n"), 1, {"line 1"});
    expectFailure(eval(std::string(200000, '7')), 1, {"line"});
    EXPECT_EQ(eval("").code, 0) << "nothing asked, nothing answered";
}

TEST_F(CommandEval, ManyLinesCrossBatches) {
    constexpr int kLines = 150000;  // more than two batches of 65536
    std::string input;
    for (int i = 0; i < kLines; ++i) input += i % 2 ? "0,0,1,0,0,1\n" : "0.6,0,0.8,0,0.6,0.8\n";
    const Outcome outcome = eval(input);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), kLines);
    const std::string pair = eval("0.6,0,0.8,0,0.6,0.8\n0,0,1,0,0,1\n").out;
    EXPECT_EQ(outcome.out.substr(outcome.out.size() - pair.size()), pair);
}

}  // namespace
}  // namespace nacre
