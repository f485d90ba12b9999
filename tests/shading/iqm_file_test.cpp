#include "shading/iqm_file.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "tests/core/scratch.hpp"
#include "tests/shading/iqm_writer.hpp"

namespace nacre {
namespace {

using ::testing::HasSubstr;
using tests::IqmWriter;
using tests::messageOf;

constexpr double kSixteenBits = 1e-4;  // a quaternion's components are 16-bit numbers

std::string errorOf(const std::vector<std::uint8_t>& bytes) {
    return messageOf<Error>([&] { parseIqm(bytes, "x.iqm"); });
}

TEST(IqmFile, BendsAtItsJointWithYUp) {
    const Rig rig = parseIqm(IqmWriter().bytes(), "x.iqm");
    ASSERT_EQ(rig.clips.size(), 1u);
    EXPECT_EQ(rig.clips[0].name, "bend");
    EXPECT_EQ(rig.nodes[2].name, "high");
    const AnimatedMesh mesh = animateRig(rig, &rig.clips[0], 0, "x.iqm", {});
    ASSERT_EQ(mesh.frames.size(), 2u);
    EXPECT_EQ(mesh.framesPerSecond, 10);
    // The file's z is y here: the tip stands 1 above the joint at height 1, then lies along the file's -y, our +z.
    EXPECT_LT(glm::length(mesh.frames[0][2] - glm::vec3(0, 2, 0)), kSixteenBits);
    EXPECT_LT(glm::length(mesh.frames[1][2] - glm::vec3(0, 1, 1)), kSixteenBits);
    EXPECT_LT(glm::length(mesh.frames[1][1] - glm::vec3(1, 0, 0)), kSixteenBits);
    EXPECT_EQ(mesh.triangles[0], glm::uvec3(0, 2, 1));  // the file's run clockwise
}

TEST(IqmFile, WeightsThatDontSumToOneAreDividedAndTold) {
    IqmWriter file;
    file.weights[8] = 100;
    const Rig rig = parseIqm(file.bytes(), "x.iqm");
    std::string told;
    const AnimatedMesh mesh =
        animateRig(rig, &rig.clips[0], 0, "x.iqm", [&](const std::string& line) { told += line; });
    EXPECT_LT(glm::length(mesh.frames[1][2] - glm::vec3(0, 1, 1)), kSixteenBits);
    EXPECT_THAT(told, HasSubstr("weights of 1 vertices don't sum to 1"));
}

TEST(IqmFile, EveryCutIsRefused) {
    const std::vector<std::uint8_t> bytes = IqmWriter().bytes();
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_THAT(errorOf({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}),
                    HasSubstr("x.iqm: expected"))
            << size;
}

TEST(IqmFile, RefusesWhatDoesNotFit) {
    IqmWriter file;
    file.secondParent = 1;
    EXPECT_THAT(errorOf(file.bytes()), HasSubstr("joint 1: expected a parent before it, found 1"));
    file = {};
    file.clipFrames = 3;
    EXPECT_THAT(errorOf(file.bytes()), HasSubstr("expected frames below 2"));
    file.clipFrames = 0;
    EXPECT_THAT(errorOf(file.bytes()), HasSubstr("found 0 from 0"));
    file = {};
    file.rate = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(errorOf(file.bytes()), HasSubstr("a rate of 0 or"));
    std::vector<std::uint8_t> bytes = IqmWriter().bytes();
    bytes[16] = 1;
    EXPECT_THAT(errorOf(bytes), HasSubstr("expected version 2, found 1"));
    EXPECT_FALSE(isIqm(std::span(bytes).first(15)));
}

}  // namespace
}  // namespace nacre
