// Light that frosted and rough faces scatter on: flux, limits, what blocks.
#include "reference/scattered_light.hpp"

#include <gtest/gtest.h>

#include "core/sampling.hpp"

namespace nacre {
namespace {

/// A square of edge 2 about the origin, facing +z, and whatever else.
struct Scene {
    explicit Scene(const SceneSpecular& specular) {
        Mesh m;
        m.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
        m.normals.assign(4, {0, 0, 1});
        m.tangents.assign(4, {1, 0, 0, 1});
        m.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        m.triangles = {{0, 1, 2}, {0, 2, 3}};
        scene.meshes = {{"square", m}};
        scene.materials.resize(2);
        scene.materials[0].specular = specular;
        scene.nodes.resize(1);
        scene.nodes[0].mesh = scene.nodes[0].material = 0;
    }
    Rgb irradiance(const Light& light, const Vec3& point, const Vec3& normal, int count = 100000) const {
        const std::vector<glm::dmat4> nodes = nodeTransforms(scene, 0);
        const SceneRays rays(scene, nodes);
        std::uint64_t i = 0;
        Rgb sum(0);
        ScatteredLight(scene, nodes, rays)
            .follow(
                light, point, true, count,
                [&] {
                    ++i;
                    return Vec2(radicalInverse(i, 2), radicalInverse(i, 3));
                },
                [&](const LightArrival& a) { sum += a.irradiance * std::max(0.0, glm::dot(a.toLight, normal)); });
        return sum;
    }
    SceneDescription scene;
};

/// All flux that meets the face arrives on a large plane behind it, or before it for a mirror.
TEST(ScatteredLight, KeepsTheFlux) {
    SceneSpecular frosted, glossy, rough;
    frosted.ior = 1, frosted.spread = 0.2;
    glossy.spread = 0.2;
    rough.ior = 1.5, rough.partial = false, rough.roughness = 0.3;
    const Light sun{true, glm::normalize(Vec3(0.3, 0, 1)), Rgb(1), {}};
    const double in = 4 * sun.position.z;  // of irradiance 1, on 2 x 2
    for (const auto& [specular, z, kept] : {std::tuple{frosted, -1.0, 1.0}, {glossy, 1.0, 1.0}, {rough, -1.0, 0.98}}) {
        const Scene s(specular);
        double sum = 0;
        constexpr int kCells = 20;
        constexpr double kEdge = 10.0;
        for (int y = 0; y < kCells; ++y)
            for (int x = 0; x < kCells; ++x) {
                const Vec3 p(kEdge * ((x + 0.5) / kCells - 0.5), kEdge * ((y + 0.5) / kCells - 0.5), z);
                sum += s.irradiance(sun, p, {0, 0, z > 0 ? -1 : 1}, 4000).r * sqr(kEdge / kCells);
            }
        EXPECT_NEAR(sum / in, kept, 0.03) << z;  // facets hide a little of each other, which bounces no more
    }
}

TEST(ScatteredLight, WhatStandsBeforeOrAfterTheFaceBlocks) {
    SceneSpecular frosted;
    frosted.ior = 1, frosted.spread = 0.2;
    Scene s(frosted);
    const Light lamp{false, {0, 0, 2}, Rgb(3, 2, 1), {}};
    const double open = s.irradiance(lamp, {0, 0, -1}, {0, 0, 1}).r;
    EXPECT_GT(open, 0);
    EXPECT_EQ(s.irradiance(lamp, {0, 0, 1}, {0, 0, -1}), Rgb(0)) << "nothing is reflected at an index of 1";
    for (const double z : {1.0, -0.5}) {
        Scene blocked = s;
        SceneNode board;
        board.mesh = 0, board.material = 1;
        board.translation = {1, 0, z};
        blocked.scene.nodes.push_back(board);
        EXPECT_NEAR(blocked.irradiance(lamp, {0, 0, -1}, {0, 0, 1}).r / open, 0.5, 0.02) << "half of all ways, " << z;
    }
    s.scene.nodes[0].castsShadow = false;
    EXPECT_EQ(s.irradiance(lamp, {0, 0, -1}, {0, 0, 1}), Rgb(0)) << "it blocks nothing, it sends nothing";
}

}  // namespace
}  // namespace nacre
