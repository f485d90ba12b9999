// Images of lights in mirrors and panes, without OpenGL.
#include "shading/multipass/virtual_light.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "core/fresnel.hpp"
#include "core/sampling.hpp"
#include "reference/scattered_light.hpp"
#include "tests/shading/multipass/specular_fixture.hpp"

namespace nacre {
namespace {

struct Found {
    std::vector<SpecularFace> faces;
    std::vector<VirtualLight> lights;
};

Found find(const SceneDescription& scene, const Light& light, int depth, std::size_t most = 100000, int shears = 32) {
    Found out{specularFaces(scene, nodeTransforms(scene, 0)), {}};
    SpecularOptions options;
    options.lightDepth = depth;
    options.most = most;
    options.shears = shears;
    out.lights = virtualLights(out.faces, sendingFaces(scene, out.faces), light, options);
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

TEST(VirtualLight, FacesThatDontBlockSendNothing) {
    test::SpecularScene s;
    s.face("second", {}, {0, 0, 0}).castsShadow = false;
    s.face("open", {}, {0, 0, 1}).castsShadow = false;
    EXPECT_TRUE(find(s.scene, lampAt({0, 0, 2}), 2).lights.empty());
    s.scene.nodes[1].scale = Vec3(1, 0, 1);  // and none has a degenerate one
    s.scene.nodes[1].castsShadow = true;
    EXPECT_TRUE(find(s.scene, lampAt({0, 0, 2}), 2).lights.empty());
}

/// Sums over the images of a frosted face against points of the face: where all are exact, and with facets far away.
TEST(VirtualLight, ScatteringFacesHaveManyImages) {
    SceneSpecular frosted, glossy, rough;
    frosted.ior = 1, frosted.spread = 0.15;
    glossy.spread = 0.15, glossy.reflection = Rgb(0.5);
    rough.ior = 1.5, rough.roughness = 0.15;
    const Light lamp{false, {0.2, 0.1, 2}, Rgb(3), {}}, far{false, {6, 3, 30}, Rgb(2000), {}};
    for (const auto& [specular, light, z, off] :
         {std::tuple{frosted, lamp, -1.0, 0.02}, {glossy, lamp, 1.0, 0.02}, {rough, far, -1.0, 0.04}}) {
        test::SpecularScene s;
        s.face("face", specular, {0, 0, 0}, 0.1, {0, 1, 0}, Vec3(0.6));
        s.square(Rgb(0), {0.8, 0, 0.5 * z}, 0, {0, 1, 0}, Vec3(0.5));
        const std::vector<glm::dmat4> nodes = nodeTransforms(s.scene, 0);
        const SceneRays rays(s.scene, nodes);
        const ScatteredLight truth(s.scene, nodes, rays);
        const Found found = find(s.scene, light, 1, 100000, 4096);
        EXPECT_GE(found.lights.size(), 4096u);
        double open = 0;  // at the first of them
        for (const Vec3& point : {Vec3(0.1, 0, z), Vec3(0.5, -0.4, z), Vec3(-0.6, 0.7, 1.3 * z)}) {
            double ours = 0, want = 0;
            std::uint64_t i = 0;
            truth.follow(
                light, point, true, 300000,
                [&] {
                    ++i;
                    return Vec2(radicalInverse(i, 2), radicalInverse(i, 3));
                },
                [&](const LightArrival& a) { want += a.irradiance.r; });
            for (const VirtualLight& image : found.lights) {
                const LightBounce bounce = image.bounces[0];
                const Vec3 to = image.seen.position - point, d = glm::normalize(to);
                const Vec3 p = point - glm::dot(found.faces[0].plane, Vec4(point, 1)) /
                                           glm::dot(Vec3(found.faces[0].plane), to) * to;
                const Vec3 local = glm::inverse(nodes[0]) * Vec4(p, 1);
                const bool ahead = glm::dot(image.stages[1].within[0], Vec4(point, 1)) > 0;
                if (!ahead || std::abs(local.x) > 1 || std::abs(local.y) > 1) continue;
                if (rays.shadowed(point, glm::normalize(p - point), glm::length(p - point))) continue;
                const double stretch = glm::length(image.toLamp * d);
                double share = 1 / (stretch * stretch * stretch);
                for (const WeighedBounce& w : image.weighed) {
                    const Vec3 before = glm::normalize(w.turn * d);
                    const double reflected = fresnelDielectric(std::abs(glm::dot(before, w.normal)), std::abs(w.index));
                    share *= w.index < 0 ? reflected : 1 - reflected;
                }
                EXPECT_EQ(bounce.face, 0);
                ours += share * image.seen.color.r / glm::dot(to, to);
            }
            if (open == 0) open = want;
            EXPECT_NEAR(ours / open, want / open, off) << z << " " << point.x;
        }
    }
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
