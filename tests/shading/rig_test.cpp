#include "shading/rig.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "core/error.hpp"
#include "tests/core/scratch.hpp"

namespace nacre {
namespace {

using ::testing::HasSubstr;

/// A triangle on two nodes, its last vertex in a skin of the second.
Rig skinned() {
    Rig rig;
    rig.nodes = {{"root", -1, Mat4(1)}, {"bone", 0, Mat4(1)}};
    RigPart part;
    part.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    part.triangles = {{0, 1, 2}};
    part.bones = {{1, Mat4(1)}};
    part.influences = {{2, 0, 1.0}};
    rig.parts = {part};
    return rig;
}

template <class Change>
std::string errorOf(Change change) {
    Rig rig = skinned();
    change(rig);
    return tests::messageOf<Error>([&] { animateRig(rig, nullptr, 0, "x", {}); });
}

TEST(Rig, WithoutAClipOneFrame) {
    std::string told;
    const AnimatedMesh mesh = animateRig(skinned(), nullptr, 0, "x", [&](const std::string& line) { told += line; });
    ASSERT_EQ(mesh.frames.size(), 1u);
    EXPECT_EQ(mesh.framesPerSecond, 30);
    EXPECT_THAT(told, HasSubstr("2 vertices of a skin have no bone"));
}

TEST(Rig, RotationsTakeTheShortWay) {  // q and -q are one rotation
    Rig rig = skinned();
    const glm::dquat quarter = glm::angleAxis(kPi / 2, Vec3(0, 0, 1));
    rig.clips = {
        {"turn", 1, 2, {{1, {{0}, {Vec3(0)}}, {{0, 1}, {glm::dquat(1, 0, 0, 0), -quarter}}, {{0}, {Vec3(1)}}}}, {}}};
    const AnimatedMesh mesh = animateRig(rig, &rig.clips[0], 0, "x", {});
    ASSERT_EQ(mesh.frames.size(), 3u);
    EXPECT_LT(glm::length(Vec3(mesh.frames[1][2]) - Vec3(-std::sqrt(0.5), std::sqrt(0.5), 0)), 1e-6);
}

TEST(Rig, RefusesWhatDoesNotFit) {
    EXPECT_THAT(errorOf([](Rig& r) { r.parts[0].influences[0].weight = -1; }), HasSubstr("expected weights >= 0"));
    EXPECT_THAT(errorOf([](Rig& r) { r.parts[0].influences[0].weight = std::numeric_limits<double>::quiet_NaN(); }),
                HasSubstr("expected weights >= 0"));
    EXPECT_THAT(errorOf([](Rig& r) { r.parts[0].influences[0].vertex = 3; }), HasSubstr("vertices below 3"));
    EXPECT_THAT(errorOf([](Rig& r) { r.parts[0].bones[0].node = 2; }), HasSubstr("bones that are nodes"));
    EXPECT_THAT(errorOf([](Rig& r) { r.parts[0].triangles[0].x = 3; }), HasSubstr("triangles of vertices below 3"));
    EXPECT_THAT(errorOf([](Rig& r) { r.parts[0].triangles.clear(); }), HasSubstr("expected triangles, found none"));
    EXPECT_THAT(errorOf([](Rig& r) { r.parts[0].targets = {{{}, 0}}; }), HasSubstr("morph target of 3 vertices"));
    EXPECT_THAT(errorOf([](Rig& r) { r.nodes[0].parent = 1; }), HasSubstr("parents before their children"));
}

}  // namespace
}  // namespace nacre
