// nacre transfer from outside.
#include <gmock/gmock.h>

#include <csignal>
#include <limits>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/file.hpp"
#include "tests/cli/process.hpp"
#include "tests/shading/glb_writer.hpp"
#include "transfer/transfer_file.hpp"

namespace nacre {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using tests::nacre;
using tests::Outcome;
using tests::Scratch;

void expectFailure(const Outcome& outcome, int code, const std::string& fragment) {
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(::testing::StartsWith("nacre: "), HasSubstr(fragment)));
}

/// A floor and a wall of 6 × 6 vertices each that meet in a right angle, as OBJ.
std::string corner() {
    constexpr int n = 6;
    std::string out;
    for (int i = 0; i < n * n; ++i) out += "v " + std::to_string(i % n) + " 0 " + std::to_string(i / n) + "\n";
    for (int i = 0; i < n * n; ++i) out += "v 0 " + std::to_string(i % n) + " " + std::to_string(i / n) + "\n";
    for (int part = 0; part < 2; ++part)
        for (int z = 0; z + 1 < n; ++z)
            for (int x = 0; x + 1 < n; ++x) {
                const int i = part * n * n + z * n + x + 1;
                const int corners[] = {i, i + n, i + n + 1, i + 1};
                out += "f";
                for (int c = 0; c < 4; ++c) out += " " + std::to_string(corners[part ? 3 - c : c]);
                out += "\n";
            }
    return out;
}

/// A tetrahedron that stands, moves, is nowhere in its fourth frame, and moves on: six frames.
std::string leapingTetrahedron() {
    tests::GlbWriter glb;
    const std::size_t positions = glb.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3", 3),
                      indices = glb.add<std::uint32_t>({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}, "SCALAR", 1);
    // Frames come every 1/30 s: the key that is no number touches the one at 0.1 s alone.
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<float> times = {0, 0.04f, 0.06f, 0.09f, 0.1f, 0.11f, 5 / 30.0f};
    std::vector<float> places;
    for (const float x : {0.0f, 0.0f, 0.5f, 0.6f, nan, 1.5f, 3.0f}) places.insert(places.end(), {x, 0, 0});
    const std::size_t input = glb.add(times, "SCALAR", 1), output = glb.add(places, "VEC3", 3);
    json& d = glb.document;
    d["accessors"][positions].update({{"min", {0, 0, 0}}, {"max", {1, 1, 1}}});
    d["accessors"][input].update({{"min", {0}}, {"max", {times.back()}}});
    d["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}}}}};
    d["nodes"] = {{{"mesh", 0}}};
    d["scenes"] = {{{"nodes", {0}}}};
    d["animations"] = {{{"samplers", {{{"input", input}, {"output", output}}}},
                        {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    return glb.bytes();
}

TEST(CommandTransfer, JsonAndFileSayTheSame) {
    const Scratch scratch;
    const std::string out = scratch / "a.tv";
    const Outcome run =
        nacre({"transfer", "cloth", "-o", out, "--frames", "1:4", "--reference", "64", "--json", "--quiet"});
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(run.err, "");
    EXPECT_EQ(scratch.fileCount(), 1u);
    const json data = json::parse(run.out);
    EXPECT_GT(data["vertices_per_second"], 0);
    EXPECT_NEAR(data["vertices_per_second"].get<double>() / data["frames_per_second"].get<double>(), 1378, 1e-6);
    EXPECT_GT(data["blockers"]["listed"], data["blockers"]["drawn"]);
    EXPECT_GT(data["memory"]["bytes_per_vertex"], 25 * 4 + 3 * 64) << "coefficients, and a row for each triangle";
    EXPECT_LE(data["memory"]["bytes_per_vertex"], 2048) << "the issue's bar";
    for (const char* part : {"rasterization", "integration", "transform"}) EXPECT_GT(data["seconds"][part], 0) << part;
    EXPECT_GE(data["seconds"]["other"], 0);
    for (const char* key : {"l2_rel", "median", "p95", "total", "buried"})
        EXPECT_TRUE(data["error"][key].is_number()) << key;
    EXPECT_EQ(data["error"]["rays"], 64);
    EXPECT_EQ(data["error"]["frames"], json({1, 2, 3}));
    EXPECT_EQ(data["frames_refused"], json::array());
    EXPECT_EQ(data["vertices_without_normal"], 0);
    const TransferRecording file = readTransfer(out);
    EXPECT_EQ(file.meta["error"], data["error"]);
    EXPECT_EQ(file.vertexCount(), 1378u);
    EXPECT_EQ(file.coefficientCount(), 25u);
    EXPECT_EQ(file.frames.front().number, 1);
    EXPECT_EQ(file.frames.size(), 3u);
    EXPECT_THAT(file.meta["command_line"].get<std::string>(), HasSubstr("nacre transfer cloth -o"));
    EXPECT_EQ(json::parse(nacre({"info", out, "--json"}).out), file.meta);
    EXPECT_THAT(nacre({"info", out}).out, AllOf(HasSubstr("25 coefficients for 1378 vertices"), HasSubstr("(1 to 3)")));
}

TEST(CommandTransfer, SameBitsForAnyThreadsAndVectors) {
    const Scratch scratch;
    const auto coefficients = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words = {"transfer", "cloth", "-o", scratch / "a.tv", "--frames", "9:10"};
        words.insert(words.end(), more.begin(), more.end());
        EXPECT_EQ(nacre(words).code, 0);
        return readTransfer(scratch / "a.tv").blocks[0].coefficients;
    };
    const std::vector<float> one = coefficients({"--threads", "1"});
    EXPECT_EQ(coefficients({}), one);
    EXPECT_EQ(coefficients({"--vectors", "plain"}), one);
    EXPECT_NE(coefficients({"--mask", "64"}), one);
}

TEST(CommandTransfer, VisibleSetsListLessAndChangeNothing) {
    const Scratch scratch;
    const std::string sets = scratch / "a.pvs";
    const auto run = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words = {"transfer", "cloth", "-o", scratch / "a.tv", "--frames", "3:8", "--json"};
        words.insert(words.end(), more.begin(), more.end());
        const Outcome outcome = nacre(words);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return json::parse(outcome.out);
    };
    const json plain = run({});
    const std::vector<float> expected = readTransfer(scratch / "a.tv").blocks[4].coefficients;
    const json made = run({"--pvs", sets, "--pvs-window", "3"});
    EXPECT_EQ(readTransfer(scratch / "a.tv").blocks[4].coefficients, expected);
    EXPECT_EQ(made["pvs"]["made"], true);
    EXPECT_EQ(made["pvs"]["windows"], 2);
    EXPECT_EQ(made["pvs"]["bytes"], std::filesystem::file_size(sets));
    EXPECT_LT(made["blockers"]["listed"].get<double>(), 0.9 * plain["blockers"]["listed"].get<double>());
    EXPECT_EQ(made["blockers"]["drawn"], plain["blockers"]["drawn"]);
    const json read = run({"--pvs", sets});
    EXPECT_EQ(read["pvs"]["made"], false);
    EXPECT_EQ(readTransfer(scratch / "a.tv").blocks[4].coefficients, expected);

    // Some of the frames only: the same groups, so the same sets.
    EXPECT_EQ(nacre({"transfer", "cloth", "-o", scratch / "a.tv", "--frames", "5:8", "--pvs", sets, "--json"}).code, 0);
    EXPECT_EQ(readTransfer(scratch / "a.tv").blocks[2].coefficients, expected);

    const auto refused = [&](const std::vector<std::string>& more, int code, const std::string& fragment) {
        std::vector<std::string> words = {"transfer", "cloth", "-o", scratch / "b.tv", "--pvs", sets};
        words.insert(words.end(), more.begin(), more.end());
        expectFailure(nacre(words), code, fragment);
    };
    refused({"--frames", "3:12"}, 1, "expected a set for frame 9, found none");
    refused({"--frames", "3:8", "--lod-angle", "0.7"}, 1, "with these levels of detail, found others");
    refused({"--lut", "64"}, 2, "--pvs: expected no --lut");
    expectFailure(nacre({"transfer", "cloth", "-o", sets, "--pvs", sets}), 2, "--pvs: expected another file than -o");
    std::vector<std::uint8_t> bytes = readFile(sets, 1 << 20);
    bytes[bytes.size() / 2] ^= 4;
    writeFile(sets, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    refused({"--frames", "3:8"}, 1, "a.pvs: expected the bytes that were written");
    writeFile(sets, "NACRE_PV");
    refused({"--frames", "3:8"}, 1, "a.pvs: expected visible sets");
    EXPECT_EQ(scratch.fileCount(), 2u);
}

TEST(CommandTransfer, VerticesThatAreOneForSizeAreTold) {
    const Scratch scratch;
    writeFile(scratch / "far.obj", corner() + "v 1e7 0 0\nv 0 1e7 0\nv 0 0 1e7\nf -1 -2 -3\n");
    const Outcome outcome = nacre({"transfer", scratch / "far.obj", "-o", scratch / "a.tv"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_NE(outcome.err.find("nearer to others than 1e-5 of the extent"), std::string::npos) << outcome.err;
}

TEST(CommandTransfer, PaperMethodErrsMoreAndSaysItsTable) {
    const Scratch scratch;
    writeFile(scratch / "corner.obj", corner());
    const auto run = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words = {"transfer", scratch / "corner.obj", "-o",   scratch / "a.tv", "--coarse",
                                          "0",        "--reference",          "1024", "--json"};
        words.insert(words.end(), more.begin(), more.end());
        const Outcome outcome = nacre(words);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return json::parse(outcome.out);
    };
    const json ours = run({}), paper = run({"--lut", "128"});
    EXPECT_FALSE(ours["options"].contains("lut"));
    EXPECT_EQ(ours["options"]["rings"], 1);
    EXPECT_EQ(paper["options"]["lut"], 128);
    EXPECT_EQ(paper["options"]["rings"], 2);
    EXPECT_GT(paper["error"]["l2_rel"], ours["error"]["l2_rel"]);
    EXPECT_NE(run({"--lut", "4"})["error"], paper["error"]);
    EXPECT_EQ(nacre({"transfer", scratch / "corner.obj", "-o", scratch / "a.tv", "--lut", "8", "--mask", "32"}).code,
              2);
}

TEST(CommandTransfer, SidesAreSaidAsResolved) {
    const Scratch scratch;
    writeFile(scratch / "corner.obj", corner());
    writeFile(scratch / "closed.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    const auto sides = [&](const char* model, const std::vector<std::string>& more = {}) {
        std::vector<std::string> words = {"transfer", scratch / model, "-o", scratch / "a.tv", "--json"};
        words.insert(words.end(), more.begin(), more.end());
        return json::parse(nacre(words).out)["options"]["sides"].get<std::string>();
    };
    EXPECT_EQ(sides("closed.obj"), "front");
    EXPECT_EQ(sides("corner.obj"), "both");
    EXPECT_EQ(sides("corner.obj", {"--sides", "fine"}), "fine");
    EXPECT_EQ(sides("closed.obj", {"--lut", "8"}), "front");
    EXPECT_EQ(sides("corner.obj", {"--lut", "8"}), "both");
}

TEST(CommandTransfer, RightAngleIsWithinItsBound) {     // the mesh itself: what is left is the mask's
    constexpr double kMask32 = 0.02, kMask128 = 0.006;  // measured 0.0138, 0.0041
    const Scratch scratch;
    writeFile(scratch / "corner.obj", corner());
    const auto error = [&](const char* mask) {
        const Outcome run = nacre({"transfer", scratch / "corner.obj", "-o", scratch / "a.tv", "--mask", mask,
                                   "--coarse", "0", "--reference", "4096", "--json"});
        EXPECT_EQ(run.code, 0) << run.err;
        return json::parse(run.out)["error"]["l2_rel"].get<double>();
    };
    EXPECT_LT(error("32"), kMask32);
    EXPECT_LT(error("128"), kMask128);
}

TEST(CommandTransfer, FrameWithNanIsRefusedByItsNumberAndTheOthersGoOn) {
    const Scratch scratch;
    writeFile(scratch / "a.glb", leapingTetrahedron());
    const Outcome run = nacre({"transfer", scratch / "a.glb", "-o", scratch / "a.tv", "--json"});
    expectFailure(run, 1, "expected finite positions, found others in frame 3, refused; 5 other frames are in");
    const json data = json::parse(run.out);
    EXPECT_EQ(data["frames_refused"], json({3}));
    EXPECT_EQ(data["frames_reused"], 1) << "nothing moves from frame 0 to 1";
    const TransferRecording file = readTransfer(scratch / "a.tv");
    EXPECT_EQ(file.meta["frames_refused"], json({3}));
    std::vector<int> numbers, blocks;
    for (const auto& [number, block] : file.frames) numbers.push_back(number), blocks.push_back(block);
    EXPECT_THAT(numbers, ElementsAre(0, 1, 2, 4, 5));
    EXPECT_THAT(blocks, ElementsAre(0, 0, 1, 2, 3));
    const Scratch none;
    expectFailure(nacre({"transfer", scratch / "a.glb", "-o", none / "a.tv", "--frames", "3:4"}), 1,
                  "expected finite positions, found none in frames 3 to 3");
    EXPECT_EQ(none.fileCount(), 0u);
}

TEST(CommandTransfer, VerticesWithoutNormalAreCountedAndZero) {
    const Scratch scratch;
    writeFile(scratch / "a.obj", corner() + "v 9 9 9\nv 9 9 9.5\nv 9 9 10\nf 73 74 75\n");  // no area
    const Outcome run = nacre({"transfer", scratch / "a.obj", "-o", scratch / "a.tv", "--reference", "16", "--json"});
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(json::parse(run.out)["vertices_without_normal"], 3);
    const TransferRecording file = readTransfer(scratch / "a.tv");
    const std::vector<float>& all = file.blocks[0].coefficients;
    for (std::size_t v = 0; v < file.vertexCount(); ++v) {
        const bool zero = std::all_of(&all[v * 25], &all[v * 25] + 25, [](float c) { return c == 0; });
        EXPECT_EQ(zero, file.blocks[0].positions[v].x == 9) << v;
    }
}

TEST(CommandTransfer, MeshWithoutAnyNormalHasNoError) {
    const Scratch scratch;
    writeFile(scratch / "line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    const std::vector<std::string> words = {"transfer",       scratch / "line.obj", "-o",
                                            scratch / "a.tv", "--reference",        "16"};
    const Outcome run = nacre(words);
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(run.out, AllOf(HasSubstr("no vertex to measure"), HasSubstr("3 vertices: zeros")));
    std::vector<std::string> withJson = words;
    withJson.push_back("--json");
    EXPECT_TRUE(json::parse(nacre(withJson).out)["error"]["l2_rel"].is_null()) << "not 0, which would be perfect";
}

TEST(CommandTransfer, PlyFramesAreColouredByTheLight) {
    const Scratch scratch;
    writeFile(scratch / "corner.obj", corner());
    const std::vector<std::string> words = {"transfer", scratch / "corner.obj", "-o", scratch / "a.tv", "--white", "1",
                                            "--ply"};
    for (const std::string& place : {std::string(scratch / "folder"), std::string(scratch / "c_###.ply")}) {
        std::vector<std::string> all = words;
        all.push_back(place);
        ASSERT_EQ(nacre(all).code, 0) << place;
    }
    const std::string bytes = tests::contents(scratch / "c_000.ply");
    EXPECT_EQ(bytes, tests::contents(scratch / "folder" / "frame_0000.ply"));
    EXPECT_THAT(bytes, AllOf(HasSubstr("element vertex 66\n"), HasSubstr("element face 100\n")));
    // White light: at the edge, whose normal halves the right angle, sin 45 degrees of the sky are left; far from the
    // wall nearly all.
    const std::size_t body = bytes.find("end_header\n") + 11;
    const auto red = [&](std::size_t v) { return static_cast<std::uint8_t>(bytes[body + 15 * v + 12]); };
    EXPECT_NEAR(red(3 * 6), 219, 2) << "sRGB of 0.7071";
    EXPECT_GT(red(5), 230);
}

TEST(CommandTransfer, SeveralEnvironmentsAreBlended) {
    const Scratch scratch;
    writeFile(scratch / "corner.obj", corner());
    for (const auto& [name, exponent] :
         {std::pair("dark.hdr", '\x81'), std::pair("bright.hdr", '\x82')}) {  // radiance 1, 2
        std::string texels = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n";
        for (int i = 0; i < 8; ++i) texels += std::string("\x80\x80\x80") + exponent;
        writeFile(scratch / name, texels);
    }
    const auto mean = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words = {"transfer", scratch / "corner.obj", "-o", scratch / "a.tv", "--order", "2"};
        words.insert(words.end(), more.begin(), more.end());
        const Outcome run = nacre(words);
        EXPECT_EQ(run.code, 0) << run.err;
        return readTransfer(scratch / "a.tv").meta["light"]["coefficients"][0][0].get<double>() /
               std::sqrt(4 * 3.14159265358979);
    };
    const std::string dark = scratch / "dark.hdr", bright = scratch / "bright.hdr";
    EXPECT_NEAR(mean({"--env", dark}), 1, 0.01);
    EXPECT_NEAR(mean({"--env", dark, "--env", bright}), 1.5, 0.015);
    EXPECT_NEAR(mean({"--env", dark, "--env", bright, "--weights", "1,0.25"}), 1.5, 0.015);
    EXPECT_NEAR(mean({"--env", dark, "--env", bright, "--weights", "0,3"}), 6, 0.06);
}

TEST(CommandTransfer, WrongUsageIsTwoInOneLine) {
    const Scratch scratch;
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
        {{"--mask", "48"}, "--mask"},
        {{"--order", "7"}, "0 to 6"},
        {{"--rings", "3"}, "1 to 2"},
        {{"--sides", "back"}, "--sides"},
        {{"--vectors", "sse"}, "--vectors"},
        {{"--lod-angle", "-1"}, "--lod-angle"},
        {{"--lod-error", "-0.1"}, "--lod-error"},
        {{"--lod-error", "nan"}, "found 'nan'"},
        {{"--lod-error", "0", "--coarse", "0"}, "--lod-error: expected levels of detail"},
        {{"--lut", "64", "--lod-error", "0.1"}, "--lod-error: expected no --lut"},
        {{"--nearby", "-1"}, "--nearby"},
        {{"--nearby", "0.5"}, "found '0.5'"},
        {{"--nearby", "nan"}, "--nearby"},
        {{"--lut", "64", "--nearby", "2"}, "--nearby: expected no --lut"},
        {{"--frames", "3"}, "A:B"},
        {{"--frames", "4:4"}, "A:B"},
        {{"--frames", "-1:4"}, "A:B"},
        {{"--frames", "0:4x"}, "A:B"},
        {{"--reference", "0"}, "--reference"},
        {{"--clip", "run"}, "cloth has no clips"},
        {{"--weights", "1"}, "--weights"},
        {{"--lut", "513"}, "0 to 512"},
        {{"--lut", "128", "--sides", "fine"}, "found 'fine'"},
        {{"--lut", "128", "--order", "2"}, "--order: expected no --lut"},
        {{"--turn", "10"}, "expected --ply"},
        {{"--pvs-window", "4"}, "--pvs-window: expected --pvs"},
        {{"--ply", "a#b#.ply"}, "one row of #"},
        {{"--ply", "a.ply"}, "one row of #"},
        {{"--rings", "2", "--coarse", "0"}, "--rings: expected levels of detail"},
        {{"--lod-angle", "0.5", "--coarse", "0"}, "--lod-angle: expected levels of detail"},
        {{"--reference-frames", "3"}, "--reference-frames: expected --reference"},
    };
    for (const auto& [more, fragment] : cases) {
        std::vector<std::string> words = {"transfer", "cloth", "-o", scratch / "a.tv"};
        words.insert(words.end(), more.begin(), more.end());
        expectFailure(nacre(words), 2, fragment);
    }
    expectFailure(nacre({"transfer", "chess", "-o", scratch / "a.tv", "--frames", "400:"}), 2, "chess, which has");
    EXPECT_EQ(scratch.fileCount(), 0u);
}

TEST(CommandTransfer, WhatCannotBeReadOrWrittenIsOneInOneLine) {
    const Scratch scratch;
    writeFile(scratch / "text.obj", "no mesh\n");
    writeFile(scratch / "short.tv", "NACRE_TV");
    const std::string out = scratch / "a.tv";
    expectFailure(nacre({"transfer", scratch / "none.glb", "-o", out}), 1, "none.glb");
    expectFailure(nacre({"transfer", scratch / "text.obj", "-o", out}), 1, "text.obj");
    expectFailure(nacre({"transfer", "cloth", "-o", scratch / "no" / "a.tv"}), 1, "can't write");
    expectFailure(nacre({"transfer", "cloth", "-o", "/dev/full"}), 1, "can't write");
    expectFailure(nacre({"transfer", "cloth", "-o", out, "--env", scratch / "none.hdr"}), 1, "none.hdr");
    expectFailure(nacre({"transfer", "cloth", "-o", out, "--ply", scratch / "no" / "c_#.ply"}), 1, "can't write");
    expectFailure(nacre({"info", scratch / "short.tv"}), 1, "short.tv");
    tests::Surroundings full;
    full.fileSize = 100000;
    expectFailure(nacre({"transfer", "cloth", "-o", out, "--frames", "0:3"}, full), 1, "can't write");
    EXPECT_EQ(scratch.fileCount(), 2u) << "nothing half-written";
}

TEST(CommandTransfer, InterruptLeavesNothing) {
    const Scratch scratch, io;
    const pid_t child = tests::start({"transfer", "cloth", "-o", scratch / "a.tv"}, {}, io);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    ::kill(child, SIGINT);
    EXPECT_EQ(tests::waitFor(child), 128 + SIGINT);
    EXPECT_EQ(scratch.fileCount(), 0u);
}

}  // namespace
}  // namespace nacre
