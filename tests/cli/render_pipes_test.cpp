// nacre render by several processes, from outside: the same picture, and what happens when one of them dies.
#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/file.hpp"
#include "core/image_file.hpp"
#include "tests/cli/process.hpp"

namespace nacre {
namespace {

using namespace tests;
using nlohmann::json;
using testing::HasSubstr;

std::string room(const Scratch& scratch) {
    writeFile(scratch / "room.json", R"({
        "nacre_scene": 1,
        "meshes": {"square": {"quad": {"size": 2}}, "ball": {"sphere": {"radius": 0.4, "segments": 24, "stacks": 12}}},
        "materials": {"matt": {"model": "lambert:kd=0.7/0.5/0.3"}, "glass": {"specular": {"ior": 1.5}}},
        "nodes": {"floor": {"mesh": "square", "material": "matt", "translation": [0, -1, 0], "axis": [1, 0, 0], "angleDeg": -90},
                  "back": {"mesh": "square", "material": "matt", "translation": [0, 0, -1]},
                  "stone": {"mesh": "ball", "material": "matt", "translation": [-0.5, -0.5, 0]},
                  "ball": {"mesh": "ball", "material": "glass", "translation": [0.4, -0.5, 0]}},
        "lights": {"lamp": {"type": "point", "position": [0, 0.5, 0.5], "intensity": 3, "shadow": true,
                            "area": {"u": [0.3, 0, 0], "v": [0, 0, 0.3]}}},
        "camera": {"eye": [0.3, 0.4, 5], "target": [0, -0.2, 0], "fovYDeg": 30}
    })");
    return scratch / "room.json";
}

std::vector<std::string> rendering(const Scratch& scratch, const std::string& output,
                                   const std::vector<std::string>& more) {
    std::vector<std::string> out = {"render",
                                    room(scratch),
                                    "-o",
                                    scratch / output,
                                    "--size",
                                    "64x48",
                                    "--samples",
                                    "1",
                                    "--shadows",
                                    "volumes",
                                    "--elements",
                                    "256",
                                    "--light-points",
                                    "7",
                                    "--indirect",
                                    "virtual-lights",
                                    "--virtual-lights",
                                    "16",
                                    "--virtual-shadows",
                                    "--specular",
                                    "traced",
                                    "--json"};
    out.insert(out.end(), more.begin(), more.end());
    return out;
}

/// Over the brightest.
double difference(const std::string& a, const std::string& b) {
    const Image x = readImageFile(a).image, y = readImageFile(b).image;
    EXPECT_EQ(x.data().size(), y.data().size());
    double most = 0, bright = 0;
    for (std::size_t i = 0; i < x.data().size(); ++i) {
        most = std::max(most, std::abs(double(x.data()[i]) - double(y.data()[i])));
        bright = std::max(bright, double(x.data()[i]));
    }
    EXPECT_GT(bright, 0.01);
    return most / bright;
}

TEST(CommandRenderPipes, AnyNumberDrawsThePictureOfOne) {
    const Scratch scratch;
    const Outcome alone = nacre(rendering(scratch, "alone.exr", {}));
    ASSERT_EQ(alone.code, 0) << alone.err;
    EXPECT_FALSE(json::parse(alone.out).contains("pipes"));
    for (const std::vector<std::string>& how :
         {std::vector<std::string>{"--pipes", "1"},
          {"--pipes", "2"},
          {"--pipes", "3", "--compositing", "software"},
          {"--pipes", "2", "--compositing", "software", "--latency", "--repeat", "3"}}) {
        const Outcome run = nacre(rendering(scratch, "pipes.exr", how));
        ASSERT_EQ(run.code, 0) << run.err;
        EXPECT_EQ(run.err, "");
        EXPECT_LT(difference(scratch / "alone.exr", scratch / "pipes.exr"), 1.0 / 255) << how[1];
        const json pipes = json::parse(run.out)["pipes"];
        EXPECT_EQ(std::to_string(pipes["count"].get<int>()), how[1]);
        EXPECT_EQ(pipes["draw_seconds"].size(), pipes["count"]);
        double sum = 0;
        for (const char* pass : {"shadow", "indirect", "direct", "specular", "composite"})
            sum += pipes["shares"][pass].get<double>();
        EXPECT_NEAR(sum, 1, 1e-6);
        EXPECT_GT(pipes["shares"]["shadow"], 0);
    }
}

// Sockets would take the numbers of closed standard descriptors, and be overwritten by what a pipe puts there.
TEST(CommandRenderPipes, StandardDescriptorsMayBeClosed) {
    const Scratch scratch;
    Surroundings daemon;
    daemon.closed = true;
    const Outcome run = nacre(rendering(scratch, "pipes.exr", {"--pipes", "3"}), daemon);
    ASSERT_EQ(run.code, 0) << run.out;
    EXPECT_EQ(json::parse(run.out)["pipes"]["draw_seconds"].size(), 3u);
}

TEST(CommandRenderPipes, ShadowsByVolumesAloneAreShared) {
    const Scratch scratch;
    std::string scene = contents(room(scratch));
    const std::string glass = R"("material": "glass")";
    scene.replace(scene.find(glass), glass.size(), R"("material": "matt")");
    writeFile(scratch / "matt.json", scene);
    const auto draw = [&](const std::string& output, const std::vector<std::string>& more) {
        std::vector<std::string> all = {
            "render", scratch / "matt.json", "-o",      scratch / output, "--size", "48x48", "--samples",
            "1",      "--shadows",           "volumes", "--light-points", "6",      "--json"};
        all.insert(all.end(), more.begin(), more.end());
        const Outcome run = nacre(all);
        EXPECT_EQ(run.code, 0) << run.err;
        return json::parse(run.out);
    };
    draw("plain.exr", {});
    const json data = draw("shared.exr", {"--pipes", "2"});
    EXPECT_LT(difference(scratch / "plain.exr", scratch / "shared.exr"), 1.0 / 255);
    EXPECT_EQ(data["pipes"]["count"], 2);
    for (const json& seconds : data["pipes"]["draw_seconds"]) EXPECT_GT(seconds, 0);
    const Outcome mirrors =
        nacre({"render", room(scratch), "-o", scratch / "refused.exr", "--shadows", "volumes", "--pipes", "2"});
    EXPECT_EQ(mirrors.code, 2);
    EXPECT_THAT(mirrors.err, HasSubstr("--pipes: expected --specular traced beside it"));
}

TEST(CommandRenderPipes, SampledShadowsTimeIsShadows) {
    const Scratch scratch;
    for (const char* method : {"sampled-maps", "sampled-volumes"}) {
        const Outcome run =
            nacre({"render", room(scratch), "-o", scratch / "s.png", "--size", "48x48", "--samples", "1", "--specular",
                   "traced", "--shadows", method, "--pipes", "2", "--repeat", "2", "--json"});
        ASSERT_EQ(run.code, 0) << run.err;
        const json shares = json::parse(run.out)["pipes"]["shares"];
        EXPECT_GT(shares["shadow"], 0) << method;
        EXPECT_EQ(shares["indirect"], 0) << method << ": there is none";
    }
}

TEST(CommandRenderPipes, TextSaysWhatIsLeftOut) {
    const Scratch scratch;
    const auto text = [&](const std::vector<std::string>& more) {
        std::vector<std::string> all = {"render", room(scratch), "-o",         scratch / "t.png",
                                        "--size", "16x16",       "--specular", "traced"};
        all.insert(all.end(), more.begin(), more.end());
        const Outcome run = nacre(all);
        EXPECT_EQ(run.code, 0) << run.err;
        return run.out;
    };
    const std::string maps = text({"--pipes", "1"});
    EXPECT_THAT(maps, HasSubstr("note: shadow maps take lamps with an area as their middle"));
    EXPECT_THAT(maps, HasSubstr("1 pipe, "));
    for (const char* method : {"volumes", "sampled-maps"})
        EXPECT_THAT(text({"--shadows", method}), testing::Not(HasSubstr("shadow maps take"))) << method;
}

std::vector<pid_t> childrenOf(pid_t process) {
    const std::string id = std::to_string(process);
    std::ifstream file("/proc/" + id + "/task/" + id + "/children");
    std::vector<pid_t> out;
    for (pid_t child = 0; file >> child;) out.push_back(child);
    return out;
}

/// Sends it to one of three pipes in the midst of many frames.
Outcome disturbed(const Scratch& scratch, int signal, const std::string& patience) {
    const Scratch io;
    const pid_t process =
        start(rendering(scratch, "disturbed.exr", {"--pipes", "3", "--repeat", "60", "--patience", patience}), {}, io);
    std::vector<pid_t> children;
    for (int i = 0; i < 3000 && children.size() < 2; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        children = childrenOf(process);
    }
    EXPECT_EQ(children.size(), 2u);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    if (children.size() == 2) ::kill(children[0], signal);
    Outcome out;
    out.code = waitFor(process);
    out.out = contents(io / "out");
    out.err = contents(io / "err");
    return out;
}

TEST(CommandRenderPipes, TheOthersGoOnWhenOneIsKilledOrStopped) {
    const Scratch scratch;
    ASSERT_EQ(nacre(rendering(scratch, "alone.exr", {})).code, 0);
    for (const int signal : {SIGKILL, SIGSTOP}) {
        const Outcome run = disturbed(scratch, signal, signal == SIGSTOP ? "1" : "30");
        EXPECT_EQ(run.code, 0) << run.err;
        EXPECT_THAT(run.err, HasSubstr("pipe 1 of 3 is gone or later than"));
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
        EXPECT_LT(difference(scratch / "alone.exr", scratch / "disturbed.exr"), 1.0 / 255);
        ASSERT_EQ(json::parse(run.out)["pipes"].count("lost"), 1u);
    }
}

TEST(CommandRenderPipes, RefusesWhatDoesNotFit) {
    const Scratch scratch;
    const auto refused = [&](const std::vector<std::string>& more, const std::string& words) {
        const Outcome run = nacre(rendering(scratch, "refused.exr", more));
        EXPECT_EQ(run.code, 2) << run.err;
        EXPECT_THAT(run.err, HasSubstr(words));
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
        EXPECT_FALSE(std::filesystem::exists(scratch / "refused.exr"));
    };
    refused({"--pipes", "0"}, "--pipes: expected a whole number 1 to 64");
    refused({"--pipes", "2", "--latency"}, "--latency: expected --compositing software beside it");
    refused({"--pipes", "2", "--mpi"}, "--pipes: expected none beside --mpi");
    refused({"--pipes", "2", "--compositing", "hardware"}, "expected binary-swap or software");
    for (const char* flag : {"--compositing", "--patience", "--latency"}) {
        const std::string value = std::string(flag) == "--compositing" ? "software" : "2";
        refused(
            std::string(flag) == "--latency" ? std::vector<std::string>{flag} : std::vector<std::string>{flag, value},
            std::string(flag) + ": expected --pipes or --mpi beside it");
    }
    const Outcome plain = nacre({"render", room(scratch), "-o", scratch / "refused.exr", "--pipes", "2"});
    EXPECT_EQ(plain.code, 2);
    EXPECT_THAT(plain.err,
                HasSubstr("--pipes: expected --indirect virtual-lights, --specular traced or --shadows volumes"));
}

#ifdef NACRE_MPIRUN
/// On this machine alone, by shared memory, with no shell that starts something elsewhere.
std::string startOf(int count, const std::string& program) {
    std::string line = "OMPI_MCA_plm=isolated OMPI_MCA_btl=self,vader OMPI_MCA_btl_vader_single_copy_mechanism=none ";
#ifdef __SANITIZE_ADDRESS__
    line += "ASAN_OPTIONS=detect_leaks=0 ";  // Open MPI keeps what it allocates
#endif
    return line + NACRE_MPIRUN " --allow-run-as-root --oversubscribe -n " + std::to_string(count) + " " + program;
}

class MpiRanks : public ::testing::Test {
protected:
    void SetUp() override {
        if (std::system((startOf(2, "true") + " > /dev/null 2>&1").c_str()) != 0)
            GTEST_SKIP() << "mpirun starts nothing on this machine";
    }
};

Outcome ranks(int count, const std::vector<std::string>& arguments) {
    const Scratch io;
    std::string line = startOf(count, NACRE_COMMAND);
    for (const std::string& argument : arguments) line += " '" + argument + "'";
    line += " > " + (io / "out").string() + " 2> " + (io / "err").string() + " < /dev/null";
    Outcome out;
    const int status = std::system(line.c_str());
    out.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    out.out = contents(io / "out");
    out.err = contents(io / "err");
    return out;
}

TEST_F(MpiRanks, DrawThePictureOfOne) {
    const Scratch scratch;
    ASSERT_EQ(nacre(rendering(scratch, "alone.exr", {})).code, 0);
    for (const int count : {1, 2, 3})
        for (const char* how : {"binary-swap", "software"}) {
            const Outcome run = ranks(count, rendering(scratch, "mpi.exr", {"--mpi", "--compositing", how}));
            ASSERT_EQ(run.code, 0) << run.err;
            EXPECT_LT(difference(scratch / "alone.exr", scratch / "mpi.exr"), 1.0 / 255) << count;
            EXPECT_EQ(json::parse(run.out)["pipes"]["count"], count);
            EXPECT_EQ(run.err.find("--mpi: found one rank") != std::string::npos, count == 1) << run.err;
            std::filesystem::remove(scratch / "mpi.exr");
        }
}

TEST_F(MpiRanks, OneThatFailsEndsAll) {
    const Scratch scratch;
    const Outcome run =
        ranks(2, {"render", "/nowhere/scene.json", "-o", scratch / "a.png", "--indirect", "virtual-lights", "--mpi"});
    EXPECT_EQ(run.code, 1);
    EXPECT_THAT(run.err, HasSubstr("/nowhere/scene.json"));
}
#else
TEST(CommandRenderPipes, WithoutMpiTheOptionSaysSo) {
    const Scratch scratch;
    const Outcome run = nacre(rendering(scratch, "a.exr", {"--mpi"}));
    EXPECT_EQ(run.code, 1);
    EXPECT_THAT(run.err, HasSubstr("--mpi: expected a command built with MPI, found one without"));
}
#endif

}  // namespace
}  // namespace nacre
