// nacre render of a transfer file, from outside.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "core/file.hpp"
#include "core/image_file.hpp"
#include "tests/cli/process.hpp"
#include "transfer/transfer_file.hpp"

namespace nacre {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using tests::nacre;
using tests::Outcome;
using tests::Scratch;

void expectFailure(const Outcome& outcome, int code, const std::string& fragment) {
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(::testing::StartsWith("nacre: "), HasSubstr(fragment)));
}

/// 8 × 4 texels of radiance 1 on one side of x = 0 alone, or everywhere.
void writeHdr(const std::string& path, bool half) {
    std::string texels = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n";
    for (int i = 0; i < 32; ++i) texels += half && i % 8 < 4 ? std::string(4, '\0') : std::string("\x80\x80\x80\x81");
    writeFile(path, texels);
}

class CommandRenderTransfer : public ::testing::Test {
protected:
    CommandRenderTransfer() {
        const Outcome run = nacre({"transfer", "cloth", "-o", file(), "--frames", "20:23", "--coarse", "0"});
        EXPECT_EQ(run.code, 0) << run.err;
        writeHdr(half(), true);
        writeHdr(white(), false);
    }
    std::string file() const { return input_ / "cloth.tv"; }
    std::string half() const { return input_ / "half.hdr"; }
    std::string white() const { return input_ / "white.hdr"; }
    std::vector<std::string> words(const std::string& output, const std::vector<std::string>& more) const {
        std::vector<std::string> out = {"render", file(), "-o", output, "--size", "96x64", "--json"};
        out.insert(out.end(), more.begin(), more.end());
        return out;
    }
    /// The picture of one frame, linear.
    Image picture(const std::vector<std::string>& more) const {
        const Scratch scratch;
        const Outcome run = nacre(words(scratch / "a.exr", more));
        EXPECT_EQ(run.code, 0) << run.err;
        return readImageFile(scratch / "a.exr").image;
    }
    const Scratch input_;
};

double worstDifference(const Image& a, const Image& b) {
    double worst = 0;
    for (std::size_t i = 0; i < a.data().size(); ++i)
        worst = std::max<double>(worst, std::abs(a.data()[i] - b.data()[i]));
    return worst;
}

TEST_F(CommandRenderTransfer, AFrameIsDrawnAndComparedWithRays) {
    const Scratch scratch;
    const Outcome run =
        nacre(words(scratch / "a.png", {"--frame", "22", "--env", half(), "--reference", "--vertex-rays", "512"}));
    ASSERT_EQ(run.code, 0) << run.err;
    const json data = json::parse(run.out);
    ASSERT_EQ(data["frames"].size(), 1u);
    EXPECT_EQ(data["frames"][0]["frame"], 22);
    EXPECT_GT(data["frames"][0]["error"]["psnr"], 35);
    EXPECT_LT(data["frames"][0]["error"]["total"], 0.03);
    EXPECT_GT(data["frames"][0]["error"]["total"], 0);
    EXPECT_EQ(data["vertices"], 1378);
    for (const char* name : {"a.png", "a-reference.png", "a-difference.png"})
        EXPECT_TRUE(std::filesystem::exists(scratch / name)) << name;
    EXPECT_EQ(scratch.fileCount(), 3u);
}

TEST_F(CommandRenderTransfer, FramesAreNumberedAsTheAnimationIs) {
    const Scratch scratch;
    ASSERT_EQ(nacre(words(scratch / "c_###.png", {})).code, 0);
    EXPECT_EQ(scratch.fileCount(), 3u);
    for (const char* name : {"c_020.png", "c_021.png", "c_022.png"})
        EXPECT_TRUE(std::filesystem::exists(scratch / name)) << name;
    const Scratch some;
    ASSERT_EQ(nacre(words(some / "#.png", {"--frames", "21:"})).code, 0);
    EXPECT_EQ(some.fileCount(), 2u);
    const Scratch first;
    const json data = json::parse(nacre(words(first / "a.png", {})).out);
    EXPECT_EQ(data["frames"][0]["frame"], 20);
}

TEST_F(CommandRenderTransfer, TheLightTurnsAndBlends) {
    const std::vector<std::string> halfLight = {"--env", half()};
    const Image still = picture(halfLight), round = picture({"--env", half(), "--turned", "360"}),
                other = picture({"--env", half(), "--turned", "180"}),
                both = picture({"--env", half(), "--env", white(), "--weights", "2,0"}),
                asWhite = picture({"--env", half(), "--env", white(), "--weights", "0,1"});
    constexpr double kFloat = 1e-4;
    EXPECT_LT(worstDifference(still, round), kFloat);
    EXPECT_GT(worstDifference(still, other), 0.2);
    Image twice = still, sum = still;
    for (float& v : twice.data()) v *= 2;
    for (std::size_t i = 0; i < sum.data().size(); ++i) sum.data()[i] += other.data()[i];
    EXPECT_LT(worstDifference(twice, both), kFloat);
    EXPECT_LT(worstDifference(sum, asWhite), 0.02) << "both halves are the whole, but for the file's 8 bits";
    // Frame 21 is 0.7 s on: 128.57 degrees a second make a quarter.
    EXPECT_LT(worstDifference(picture({"--env", half(), "--frame", "21", "--turn", "128.571428571"}),
                              picture({"--env", half(), "--frame", "21", "--turned", "90"})),
              kFloat);
}

TEST_F(CommandRenderTransfer, IsSeenFromWhereTheViewSays) {
    EXPECT_GT(worstDifference(picture({}), picture({"--view", "120,30"})), 0.2);
    EXPECT_LT(worstDifference(picture({}), picture({"--view", "19.290046219188735,20.68369524129331"})), 0.05);
}

TEST_F(CommandRenderTransfer, WrongUsageIsTwoInOneLine) {
    const Scratch scratch;
    const auto expectUsage = [&](const std::vector<std::string>& more, const std::string& fragment) {
        expectFailure(nacre(words(scratch / "a.png", more)), 2, fragment);
    };
    expectUsage({"--frame", "19"}, "expected frames of 20 to 22, found 19:20");
    expectUsage({"--frames", "23:"}, "expected frames of 20 to 22, found 23:");
    expectUsage({"--frames", "20:22"}, "expected a name with #");
    expectUsage({"--frames", "5"}, "expected A:B");
    expectUsage({"--weights", "1"}, "0 --env");
    expectUsage({"--view", "10,90"}, "AZIMUTH,ELEVATION");
    expectUsage({"--turn", "nan"}, "expected a finite number");
    expectUsage({"--time", "1"}, "--time: expected a scene, found the transfer file");
    expectUsage({"--shares"}, "--shares: expected a scene");
    expectFailure(nacre({"render", file(), "-o", scratch / "a.gif"}), 2, ".exr or .png");
    writeFile(input_ / "scene.json", "{}");
    expectFailure(nacre({"render", input_ / "scene.json", "-o", scratch / "a.png", "--env", half()}), 2,
                  "--env: expected a file that nacre transfer wrote, found");
    EXPECT_EQ(scratch.fileCount(), 0u);
}

TEST_F(CommandRenderTransfer, DamagedAndMissingFilesAreOneInOneLine) {
    const Scratch scratch;
    const std::string out = scratch / "a.png";
    std::string bytes = tests::contents(file());
    writeFile(input_ / "short.tv", bytes.substr(0, bytes.size() - 5));
    bytes[bytes.size() - 1] = '\x7f', bytes[bytes.size() - 2] = '\xff';
    writeFile(input_ / "nan.tv", bytes);
    expectFailure(nacre({"render", input_ / "short.tv", "-o", out}), 1, "short.tv");
    expectFailure(nacre({"render", input_ / "nan.tv", "-o", out}), 1, "nan.tv");
    expectFailure(nacre({"render", file(), "-o", out, "--env", input_ / "none.hdr"}), 1, "none.hdr");
    expectFailure(nacre({"render", file(), "-o", scratch / "no" / "a.png"}), 1, "can't write");
    EXPECT_EQ(scratch.fileCount(), 0u);
}

}  // namespace
}  // namespace nacre
