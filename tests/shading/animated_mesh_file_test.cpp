#include "shading/animated_mesh_file.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "core/error.hpp"
#include "core/file.hpp"
#include "shading/hand_motion.hpp"
#include "shading/md2_frames.hpp"
#include "tests/core/scratch.hpp"
#include "tests/shading/glb_writer.hpp"
#include "tests/shading/iqm_writer.hpp"

namespace nacre {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using tests::GlbWriter;
using tests::messageOf;
using tests::Scratch;

constexpr float kSingle = 1e-5f;  // a few operations in the importer's single precision
const float kNan = std::numeric_limits<float>::quiet_NaN();

/// A triangle in a skin of two joints of one name, the second at height 1; its tip at height 2 has `weights` of both.
/// A clip "bend" turns the second joint by 90 degrees about z at each of `times` but the first.
struct TwoBones {
    std::vector<float> times = {0, 1}, weights = {0, 1};
    std::vector<float> turn = {0, 0, 0.70710678f, 0.70710678f};

    std::string bytes() const {
        GlbWriter out;
        const std::size_t positions = out.add<float>({0, 0, 0, 1, 0, 0, 0, 2, 0}, "VEC3", 3);
        const std::size_t shares = out.add<float>({1, 0, 0, 0, 1, 0, 0, 0, weights[0], weights[1], 0, 0}, "VEC4", 4);
        // Joints are 8-bit: 0, 0, 0, 0 | 0, 0, 0, 0 | 0, 1, 0, 0
        const std::size_t joints = out.add<std::uint32_t>({0, 0, 0x100}, "VEC4", 1);
        out.document["accessors"][joints]["componentType"] = 5121;
        const std::size_t inverse = out.add<float>(
            {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1}, "MAT4",
            16);
        const std::size_t input = out.add<float>(times, "SCALAR", 1);
        std::vector<float> turns;
        for (std::size_t i = 0; i < times.size(); ++i)
            for (std::size_t c = 0; c < 4; ++c) turns.push_back(i ? turn[c] : c == 3 ? 1.0f : 0.0f);
        const std::size_t output = out.add<float>(turns, "VEC4", 4);
        const auto n = [](std::size_t i) { return json(i); };
        json& d = out.document;
        d["meshes"] = {
            {{"primitives",
              {{{"attributes", {{"POSITION", n(positions)}, {"JOINTS_0", n(joints)}, {"WEIGHTS_0", n(shares)}}}}}}}};
        d["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {9, 9, 9}}},  // a skin's own place counts for nothing
                      {{"name", "joint"}, {"children", {2}}},
                      {{"name", "joint"}, {"translation", {0, 1, 0}}}};
        d["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", n(inverse)}}};
        d["scenes"] = {{{"nodes", {0, 1}}}};
        d["scene"] = 0;
        d["animations"] = {{{"name", "bend"},
                            {"samplers", {{{"input", n(input)}, {"output", n(output)}}}},
                            {"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "rotation"}}}}}}}};
        return out.bytes();
    }
};

class AnimatedMeshFile : public ::testing::Test {
protected:
    std::filesystem::path write(const std::string& name, const std::string& bytes) {
        writeFile(scratch_ / name, bytes);
        return scratch_ / name;
    }
    std::string errorOf(const std::filesystem::path& path, const AnimatedMeshOptions& options = {}) {
        return messageOf<Error>([&] { loadAnimatedMesh(path, options); });
    }
    Scratch scratch_;
};

TEST_F(AnimatedMeshFile, TwoBonesBendAsComputedByHand) {
    const AnimatedMesh mesh = loadAnimatedMesh(write("two.glb", TwoBones().bytes()), {"bend", 2, {}});
    ASSERT_EQ(mesh.frames.size(), 3u);
    const float s = std::sqrt(0.5f);
    EXPECT_LT(glm::length(mesh.frames[0][2] - glm::vec3(0, 2, 0)), kSingle);
    EXPECT_LT(glm::length(mesh.frames[1][2] - glm::vec3(-s, 1 + s, 0)), kSingle);
    EXPECT_LT(glm::length(mesh.frames[2][2] - glm::vec3(-1, 1, 0)), kSingle);
    EXPECT_LT(glm::length(mesh.frames[2][1] - glm::vec3(1, 0, 0)), kSingle);
}

TEST_F(AnimatedMeshFile, WeightsThatDontSumToOneAreDividedAndTold) {
    TwoBones file;
    file.weights = {0.25f, 0.25f};
    std::string told;
    const AnimatedMesh mesh =
        loadAnimatedMesh(write("w.glb", file.bytes()), {"", 1, [&](const std::string& line) { told += line; }});
    EXPECT_LT(glm::length(mesh.frames[1][2] - glm::vec3(-0.5f, 1.5f, 0)), kSingle);  // halfway, not drawn to the origin
    EXPECT_THAT(told, HasSubstr("don't sum to 1"));
}

TEST_F(AnimatedMeshFile, AClipOfNoLengthIsOneFrame) {
    TwoBones file;
    file.times = {0};
    EXPECT_EQ(loadAnimatedMesh(write("still.glb", file.bytes())).frames.size(), 1u);
    EXPECT_EQ(animationClips(scratch_ / "still.glb").at(0).seconds, 0);
}

TEST_F(AnimatedMeshFile, ANanKeyBreaksItsFramesAlone) {
    TwoBones file;
    file.turn = {kNan, 0, 0, 1};
    const AnimatedMesh mesh = loadAnimatedMesh(write("nan.glb", file.bytes()), {"", 2, {}});
    ASSERT_EQ(mesh.frames.size(), 3u);
    EXPECT_LT(glm::length(mesh.frames[0][2] - glm::vec3(0, 2, 0)), kSingle);
    EXPECT_TRUE(std::isnan(mesh.frames[1][2].x));
    EXPECT_TRUE(std::isnan(mesh.frames[2][2].x));
    EXPECT_FALSE(std::isnan(mesh.frames[2][1].x));
}

TEST_F(AnimatedMeshFile, TimesOutOfOrderAreRefused) {
    TwoBones file;
    file.times = {0, 2, 1};
    EXPECT_THAT(errorOf(write("order.glb", file.bytes())),
                HasSubstr("expected finite times in order, found 1 as key 2"));
    file.times = {0, kNan};
    EXPECT_THAT(errorOf(write("nan.glb", file.bytes())), HasSubstr("expected finite times in order"));
    file.times = {0, 1e9f};
    EXPECT_THAT(errorOf(write("long.glb", file.bytes())), HasSubstr("expected 1 to 100000 frames"));
}

TEST_F(AnimatedMeshFile, AnUnknownClipListsThoseThatAre) {
    const auto path = write("two.glb", TwoBones().bytes());
    EXPECT_THAT(errorOf(path, {"walk", 0, {}}), HasSubstr("expected a clip of bend (1 s), found \"walk\""));
    EXPECT_NO_THROW(loadAnimatedMesh(path, {"0", 0, {}}));
    EXPECT_THROW(loadAnimatedMesh(path, {"", -1, {}}), std::invalid_argument);
    const auto still = write("t.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    EXPECT_EQ(loadAnimatedMesh(still).frames.size(), 1u);
    EXPECT_TRUE(animationClips(still).empty());
    EXPECT_THAT(errorOf(still, {"walk", 0, {}}), HasSubstr("expected no clip"));
}

TEST_F(AnimatedMeshFile, CutFilesAreRefused) {
    const std::string bytes = TwoBones().bytes();
    for (std::size_t part = 0; part < 16; ++part)
        EXPECT_THAT(errorOf(write("cut.glb", bytes.substr(0, bytes.size() * part / 16))), HasSubstr("cut.glb: "));
    EXPECT_THAT(errorOf(scratch_ / "missing.glb"), HasSubstr("missing.glb"));
}

TEST_F(AnimatedMeshFile, MorphTargetsAndMovingNodes) {
    GlbWriter out;
    const auto n = [](std::size_t i) { return json(i); };
    const std::size_t positions = out.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
    const std::size_t target = out.add<float>({0, 0, 0, 0, 0, 0, 0, 0, 4}, "VEC3", 3);
    const std::size_t times = out.add<float>({0, 1}, "SCALAR", 1), weights = out.add<float>({0, 1}, "SCALAR", 1);
    const std::size_t moves = out.add<float>({0, 0, 0, 2, 0, 0}, "VEC3", 3);
    json& d = out.document;
    d["meshes"] = {
        {{"primitives", {{{"attributes", {{"POSITION", n(positions)}}}, {"targets", {{{"POSITION", n(target)}}}}}}}}};
    d["nodes"] = {{{"mesh", 0}}};
    d["scenes"] = {{{"nodes", {0}}}};
    d["scene"] = 0;
    d["animations"] = {
        {{"samplers", {{{"input", n(times)}, {"output", n(weights)}}, {{"input", n(times)}, {"output", n(moves)}}}},
         {"channels",
          {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}},
           {{"sampler", 1}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    const AnimatedMesh mesh = loadAnimatedMesh(write("morph.glb", out.bytes()), {"", 2, {}});
    ASSERT_EQ(mesh.frames.size(), 3u);
    EXPECT_LT(glm::length(mesh.frames[1][2] - glm::vec3(1, 1, 2)), kSingle);
    EXPECT_LT(glm::length(mesh.frames[2][2] - glm::vec3(2, 1, 4)), kSingle);
    EXPECT_LT(glm::length(mesh.frames[2][0] - glm::vec3(2, 0, 0)), kSingle);
}

TEST_F(AnimatedMeshFile, IqmByItsContent) {
    const std::vector<std::uint8_t> bytes = tests::IqmWriter().bytes();
    const auto path = write("model.any", {bytes.begin(), bytes.end()});
    EXPECT_EQ(loadAnimatedMesh(path, {"bend", 20, {}}).frames.size(), 3u);
}

/// One triangle, whose vertices are 1 byte each along an axis; frames "run1", "run2", "wave1".
std::string md2() {
    const auto word = [](std::uint32_t v) { return std::string(reinterpret_cast<const char*>(&v), 4); };
    const auto number = [](float v) { return std::string(reinterpret_cast<const char*>(&v), 4); };
    const std::string texture(12, '\0'), triangle("\0\0\1\0\2\0\0\0\1\0\2\0", 12);
    std::string frames;
    for (const char* name : {"run1", "run2", "wave1"}) {
        std::string title = name;
        const char far = title == "run2" ? 2 : 1;
        title.resize(16, '\0');
        for (int i = 0; i < 3; ++i) frames += number(1);
        for (int i = 0; i < 3; ++i) frames += number(0);
        frames += title;
        frames += std::string("\0\0\0\0", 4) + std::string({far, 0, 0, 0}) + std::string({0, far, 0, 0});
    }
    std::string out = "IDP2";
    for (const std::size_t v : {8ul, 64ul, 64ul, 52ul, 0ul, 3ul, 3ul, 1ul, 0ul, 3ul, 68ul, 68ul, 80ul, 92ul,
                                92ul + frames.size(), 156ul + frames.size()})
        out += word(static_cast<std::uint32_t>(v));
    return out + texture + triangle + frames + std::string(64, 0);  // as many bytes of drawing commands
}

TEST_F(AnimatedMeshFile, Md2FramesAreClipsByTheirNames) {
    const auto path = write("x.md2", md2());
    const std::vector<AnimationClip> clips = animationClips(path);
    ASSERT_EQ(clips.size(), 2u);
    EXPECT_EQ(clips[0].name, "run");
    EXPECT_DOUBLE_EQ(clips[0].seconds, 0.1);
    const AnimatedMesh mesh = loadAnimatedMesh(path, {"run", 20, {}});
    ASSERT_EQ(mesh.frames.size(), 3u);
    float extent[3];
    for (std::size_t f = 0; f < 3; ++f) {
        extent[f] = 0;
        for (const glm::vec3& p : mesh.frames[f]) extent[f] = std::max(extent[f], glm::length(p));
    }
    EXPECT_NEAR(extent[0], 1, kSingle);
    EXPECT_NEAR(extent[1], 1.5, kSingle);
    EXPECT_NEAR(extent[2], 2, kSingle);
    EXPECT_EQ(loadAnimatedMesh(path, {"wave", 0, {}}).frames.size(), 1u);
    for (std::size_t size = 0; size < md2().size(); size += 7)
        EXPECT_THAT(errorOf(write("cut.md2", md2().substr(0, size))), HasSubstr("cut.md2: ")) << size;
}

TEST(HandMotion, LeavesOtherRigsAlone) {
    Rig rig;
    rig.nodes.push_back({"wrist", -1, Mat4(1)});
    EXPECT_FALSE(addCurl(rig));
    EXPECT_TRUE(rig.clips.empty());
}

/// Files of others, where demos/fetch.sh put them.
class RealMotion : public ::testing::TestWithParam<std::tuple<const char*, std::size_t, std::size_t>> {};

TEST_P(RealMotion, StaysInOnePiece) {
    const auto& [file, frames, triangles] = GetParam();
    const std::filesystem::path path = std::filesystem::path(NACRE_SOURCE_DIR "/build/data/animated") / file;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing: demos/fetch.sh";
    const AnimatedMesh mesh = loadAnimatedMesh(path);
    EXPECT_EQ(mesh.frames.size(), frames);
    EXPECT_EQ(mesh.triangles.size(), triangles);
    // Wrong matrices tear a mesh: its edges then grow with the mesh's size, all together.
    const auto edges = [&](const std::vector<glm::vec3>& p) {
        double sum = 0;
        for (const glm::uvec3& t : mesh.triangles) sum += glm::length(p[t.x] - p[t.y]);
        return sum;
    };
    bool moves = false;
    for (const std::vector<glm::vec3>& frame : mesh.frames) {
        EXPECT_NEAR(edges(frame) / edges(mesh.frames[0]), 1, 0.25);
        moves = moves || glm::length(frame[frame.size() / 3] - mesh.frames[0][frame.size() / 3]) > 0;
    }
    EXPECT_TRUE(moves);
}
INSTANTIATE_TEST_SUITE_P(Files, RealMotion,
                         ::testing::Values(std::tuple("Testwuson.X", 30, 3732),
                                           std::tuple("BCN_Epileptic.X", 100, 5126),
                                           std::tuple("mrfixit.iqm", 101, 2988), std::tuple("faerie.md2", 40, 654),
                                           std::tuple("sydney.md2", 40, 679), std::tuple("hand.glb", 61, 2314)));

}  // namespace
}  // namespace nacre
