// Images of lights in mirrors and panes, without OpenGL.
#include "shading/multipass/virtual_light.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "tests/shading/multipass/specular_fixture.hpp"

namespace nacre {
namespace {

struct Found {
    std::vector<SpecularFace> faces;
    std::vector<VirtualLight> lights;
};

Found find(const SceneDescription& scene, const Light& light, int depth, std::size_t most = 1000) {
    Found out{specularFaces(scene, nodeTransforms(scene, 0)), {}};
    out.lights = virtualLights(out.faces, sendingFaces(scene, out.faces), light, depth, most);
    return out;
}

Light lampAt(const Vec3& at) { return {false, at, Rgb(2), {}}; }

Vec3 moved(const glm::dmat4& m, const Vec3& p) { return Vec3(m * Vec4(p, 1)); }

TEST(VirtualLight, AMirrorsIsBehindIt) {
    test::SpecularScene s;
    s.face("mirror", {.reflection = Rgb(0.5)}, {0, 0, 0});
    const Found found = find(s.scene, lampAt({0.3, 0.2, 2}), 2);
    ASSERT_EQ(found.lights.size(), 1u);
    const VirtualLight& image = found.lights[0];
    EXPECT_LT(glm::length(image.seen.position - Vec3(0.3, 0.2, -2)), 1e-12);
    EXPECT_EQ(image.seen.color, Rgb(1));
    ASSERT_EQ(image.stages.size(), 2u);
    EXPECT_LT(glm::length(moved(image.stages[0].toLast, {0.3, 0.2, 2}) - image.seen.position), 1e-12);
    EXPECT_EQ(image.stages[1].toLast, glm::dmat4(1)) << "what is after the face is where it is";
    EXPECT_FALSE(isRefracted(image));
}

TEST(VirtualLight, ALightInAMirrorsPlaneHasNone) {
    test::SpecularScene s;
    s.face("mirror", {}, {0, 0, 0}, 0.4);
    EXPECT_TRUE(find(s.scene, lampAt(Vec3(std::cos(0.4), 0.3, -std::sin(0.4)) * 3.0), 2).lights.empty());
    EXPECT_EQ(find(s.scene, lampAt({0, 0, -3}), 2).lights.size(), 1u) << "behind it: its back mirrors";
}

TEST(VirtualLight, BeamsThatMissAFaceEndThere) {
    test::SpecularScene s;
    s.face("floor", {}, {0, 0, 0}, -kPi / 2, {1, 0, 0}, Vec3(0.5));
    s.face("wall", {}, {3, 1, 0}, -kPi / 2, {0, 1, 0}, Vec3(0.5));
    const auto paths = [&](const Vec3& at) { return find(s.scene, lampAt(at), 2).lights.size(); };
    EXPECT_EQ(paths({-3, 1, 0}), 3u) << "floor, floor and wall, wall; what the wall reflects goes over the floor";
    EXPECT_EQ(paths({-0.5, 4, 0}), 2u) << "what the floor reflects goes over the wall";
}

TEST(VirtualLight, FacesThatDontBlockOrSpreadSendNothing) {
    test::SpecularScene s;
    SceneSpecular frosted;
    frosted.spread = 0.1;
    s.face("frosted", frosted, {0, 0, 0});
    s.face("open", {}, {0, 0, 1}).castsShadow = false;
    EXPECT_TRUE(find(s.scene, lampAt({0, 0, 2}), 2).lights.empty());
    s.scene.nodes[1].scale = Vec3(1, 0, 1);  // and none has a degenerate one
    s.scene.nodes[1].castsShadow = true;
    EXPECT_TRUE(find(s.scene, lampAt({0, 0, 2}), 2).lights.empty());
}

/// Every straight way from the light to the face goes on straight from its image.
TEST(VirtualLight, AStageIsCarriedAlongItsRays) {
    SceneSpecular glass;
    glass.ior = 1.5;
    test::SpecularScene s;
    s.face("pane", glass, {0, 0, 0}, 0.3);
    s.face("mirror", {}, {0.4, 0, -1.5}, -0.4, {0, 1, 0}, Vec3(2));
    for (const Light& light : {lampAt({0.2, 0.1, 2}), Light{true, glm::normalize(Vec3(0.2, 0.1, 1)), Rgb(1), {}}})
        for (const VirtualLight& image : find(s.scene, light, 2).lights)
            for (std::size_t i = 0; i < image.stages.size(); ++i) {
                const LightStage& stage = image.stages[i];
                const Vec4 seen = stage.toLast * stage.source, last = image.stages.back().source;
                EXPECT_LT(glm::length(seen - last), 1e-9 * (1 + glm::length(last)));
            }
}

TEST(VirtualLight, ParallelLightThroughAPaneIsExact) {
    SceneSpecular glass;
    glass.ior = 2;
    test::SpecularScene s;
    s.face("pane", glass, {0, 0, 0});
    const double angle = 0.8, sine = std::sin(angle) / 2, cosine = std::sqrt(1 - sine * sine);
    const Found found = find(s.scene, {true, {std::sin(angle), 0, std::cos(angle)}, Rgb(1), {}}, 1);
    ASSERT_EQ(found.lights.size(), 2u);  // reflected, refracted
    const VirtualLight& through = found.lights[1];
    EXPECT_TRUE(isRefracted(through));
    EXPECT_LT(glm::length(through.seen.position - Vec3(sine, 0, cosine)), 1e-12);
    EXPECT_NEAR(through.seen.color.r, std::cos(angle) / cosine, 1e-12) << "flux is kept: the beam is wider or narrower";
    ASSERT_EQ(through.weighed.size(), 1u);
    EXPECT_NEAR(through.weighed[0].index, 2, 1e-12);
    const Vec3 before = glm::normalize(through.weighed[0].turn * through.seen.position);
    EXPECT_LT(glm::length(before - Vec3(std::sin(angle), 0, std::cos(angle))), 1e-12);
}

TEST(VirtualLight, RejectsMoreThanThereIsRoomFor) {
    test::SpecularScene s;
    s.face("a", {}, {0, 0, 0}, 0, {0, 1, 0}, Vec3(3));
    s.face("b", {}, {0, 0, 4}, kPi, {0, 1, 0}, Vec3(3));
    EXPECT_EQ(find(s.scene, lampAt({0, 0, 2}), 4).lights.size(), 8u);
    EXPECT_THROW(find(s.scene, lampAt({0, 0, 2}), 4, 7), Error);
    EXPECT_THROW(find(s.scene, lampAt({0, 0, 2}), 5), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
