// Scenes as values: where nodes and lights are at a time, and meshes moved into the world.
#include "core/scene_description.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>

namespace nacre {
namespace {

constexpr double kRounding = 1e-12;
constexpr double kFloat = 1e-6;

void expectNear(const Vec3& a, const Vec3& b, double tolerance = kRounding) {
    EXPECT_NEAR(glm::length(a - b), 0, tolerance);
}
Vec3 apply(const glm::dmat4& m, const Vec3& p) { return Vec3(m * Vec4(p, 1)); }

SceneNode nodeAt(int parent, const Vec3& translation) {
    SceneNode node;
    node.parent = parent;
    node.translation = translation;
    return node;
}

SceneTrack track(SceneTrack::Path path, std::vector<double> times, std::vector<glm::dvec4> values, bool step = false) {
    return {0, path, std::move(times), std::move(values), step};
}

TEST(NodeTransforms, TranslationAfterRotationAfterScaleAndParents) {
    SceneDescription scene;
    scene.nodes = {nodeAt(-1, {1, 0, 0}), nodeAt(0, {0, 1, 0})};
    scene.nodes[0].scale = {2, 3, 4};
    scene.nodes[0].rotation = glm::angleAxis(kPi / 2, Vec3(0, 0, 1));
    const auto places = nodeTransforms(scene, 0);
    expectNear(apply(places[0], {1, 1, 1}), {1 - 3, 2, 4});
    expectNear(apply(places[1], {0, 0, 0}), {1 - 3, 0, 0});
}

TEST(NodeTransforms, TracksHoldTheirEndsAndRepeat) {
    SceneDescription scene;
    scene.nodes = {nodeAt(-1, {9, 9, 9})};
    scene.tracks = {track(SceneTrack::Path::Translation, {1, 3}, {{0, 0, 0, 0}, {4, 0, 0, 0}})};
    scene.duration = 5;
    const auto x = [&](double time) { return nodeTransforms(scene, time)[0][3].x; };
    EXPECT_EQ(x(0), 0) << "before its first key";
    EXPECT_EQ(x(1), 0);
    EXPECT_EQ(x(2), 2);
    EXPECT_EQ(x(3), 4);
    EXPECT_EQ(x(4.5), 4) << "after its last key";
    EXPECT_EQ(x(5), 0) << "from the start again";
    EXPECT_EQ(x(7), x(2));
    EXPECT_EQ(x(-3), x(2));
    scene.tracks[0].step = true;
    EXPECT_EQ(x(2.99), 0);
    EXPECT_EQ(x(3), 4);
    scene.duration = 0;
    EXPECT_EQ(x(7), 4) << "without a duration nothing repeats";
}

TEST(NodeTransforms, RotationsTakeTheShorterWayAtConstantSpeed) {
    SceneDescription scene;
    scene.nodes = {nodeAt(-1, {})};
    const auto about = [](double angle, double sign) {
        return glm::dvec4(0, sign * std::sin(angle / 2), 0, sign * std::cos(angle / 2));
    };
    // −q is the same rotation as q.
    for (const double sign : {1., -1.}) {
        scene.tracks = {track(SceneTrack::Path::Rotation, {0, 1}, {about(0, 1), about(2, sign)})};
        for (const double time : {0.25, 0.5, 0.75}) {
            const double angle = 2 * time;
            expectNear(apply(nodeTransforms(scene, time)[0], {0, 0, 1}), {std::sin(angle), 0, std::cos(angle)});
        }
    }
    scene.tracks = {track(SceneTrack::Path::Scale, {0, 1}, {{1, 1, 1, 0}, {3, 1, 1, 0}})};
    expectNear(apply(nodeTransforms(scene, 0.5)[0], {1, 1, 1}), {2, 1, 1});
}

TEST(NodeTransforms, RejectsParentsBehindTheirChildrenAndBadTimes) {
    SceneDescription scene;
    scene.nodes = {nodeAt(1, {}), nodeAt(-1, {})};
    EXPECT_THROW(nodeTransforms(scene, 0), std::invalid_argument);
    scene.nodes = {nodeAt(0, {})};
    EXPECT_THROW(nodeTransforms(scene, 0), std::invalid_argument) << "its own parent";
    scene.nodes.clear();
    EXPECT_TRUE(nodeTransforms(scene, 0).empty());
    EXPECT_THROW(nodeTransforms(scene, std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
    EXPECT_THROW(nodeTransforms(scene, std::numeric_limits<double>::infinity()), std::invalid_argument);
}

TEST(LightsInWorld, MoveAndTurnButKeepTheirIntensity) {
    SceneDescription scene;
    scene.nodes = {nodeAt(-1, {1, 2, 3})};
    scene.nodes[0].scale = Vec3(2);
    scene.nodes[0].rotation = glm::angleAxis(kPi / 2, Vec3(1, 0, 0));  // −z becomes +y
    SceneLight sun, lamp, fixed;
    sun.node = lamp.node = 0;
    sun.light.position = {0, 0, -1};
    lamp.light.directional = false;
    lamp.light.position = {1, 0, 0};
    lamp.light.color = Rgb(5);
    lamp.light.cone = SpotCone{{0, 0, -1}, 0.1, 0.2};
    fixed.light.position = {0, 1, 0};
    scene.lights = {sun, lamp, fixed};
    const std::vector<Light> world = lightsInWorld(scene, nodeTransforms(scene, 0));
    expectNear(world[0].position, {0, 1, 0});
    expectNear(world[1].position, {3, 2, 3});
    expectNear(world[1].cone->axis, {0, 1, 0});
    EXPECT_EQ(world[1].color, Rgb(5));
    EXPECT_EQ(world[1].cone->outer, 0.2);
    expectNear(world[2].position, {0, 1, 0});
}

/// A tilted triangle with the frame of a plane.
Mesh triangle() {
    const glm::vec3 a(0, 0, 0), b(2, 0, 1), c(0, 1, 1), n = glm::normalize(glm::cross(b - a, c - a));
    Mesh mesh;
    mesh.positions = {a, b, c};
    mesh.normals.assign(3, n);
    mesh.tangents.assign(3, glm::vec4(glm::normalize(b - a), 1));
    mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
}

TEST(Transformed, NormalsStayAcrossAndTangentsAlong) {
    for (const Vec3& scale : {Vec3(1), Vec3(1, 2, 5), Vec3(-1, 2, 1), Vec3(-1, -1, -3)}) {
        const glm::dmat4 m = glm::translate(glm::dmat4(1), Vec3(3, -1, 2)) *
                             glm::mat4_cast(glm::angleAxis(0.8, glm::normalize(Vec3(1, 2, 3)))) *
                             glm::scale(glm::dmat4(1), scale);
        const Mesh mesh = transformed(triangle(), m);
        const glm::uvec3 t = mesh.triangles[0];
        const Vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        const Vec3 n = glm::normalize(glm::cross(b - a, c - a));
        expectNear(mesh.normals[0], n, kFloat);
        const Vec3 along = glm::normalize(Vec3(mesh.positions[1] - mesh.positions[0]));
        expectNear(Vec3(mesh.tangents[0]), along, kFloat);
        EXPECT_EQ(mesh.tangents[0].w, glm::determinant(glm::dmat3(m)) < 0 ? -1 : 1);
        // ∂P/∂v stays on the side that w · n × t says.
        const Vec3 bitangent = static_cast<double>(mesh.tangents[0].w) * glm::cross(Vec3(mesh.normals[0]), along);
        EXPECT_GT(glm::dot(bitangent, Vec3(mesh.positions[2] - mesh.positions[0])), 0) << scale.x << ' ' << scale.y;
        EXPECT_EQ(mesh.uvs, triangle().uvs);
    }
}

TEST(Transformed, EmptyStaysEmpty) { EXPECT_TRUE(transformed(Mesh(), glm::dmat4(2)).positions.empty()); }

}  // namespace
}  // namespace nacre
