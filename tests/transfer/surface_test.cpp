#include "transfer/surface.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace nacre {
namespace {

/// A cube of 8 corners as 12 triangles, outside counter-clockwise; `split` gives each triangle corners of its own.
AnimatedMesh cube(bool split) {
    AnimatedMesh a;
    std::vector<glm::vec3> corners;
    for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1, i >> 1 & 1, i >> 2 & 1);
    const std::vector<glm::uvec3> triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                               {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    if (!split) {
        a.triangles = triangles;
        a.frames = {corners};
        return a;
    }
    a.frames.resize(1);
    for (const glm::uvec3& t : triangles) {
        const auto first = static_cast<std::uint32_t>(a.frames[0].size());
        for (int c = 0; c < 3; ++c) a.frames[0].push_back(corners[t[c]]);
        a.triangles.push_back({first, first + 1, first + 2});
    }
    return a;
}

TEST(Surface, WeldsSeamsIntoAClosedMesh) {
    const WeldedMesh mesh = weldMesh(cube(true), "cube");
    EXPECT_EQ(mesh.vertexCount(), 8u);
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_TRUE(mesh.closed);
    EXPECT_TRUE(weldMesh(cube(false), "cube").closed);
}

TEST(Surface, KeepsApartWhatPartsLater) {
    AnimatedMesh a = cube(true);
    a.frames.push_back(a.frames[0]);
    a.frames[1][0].x -= 1;
    const WeldedMesh mesh = weldMesh(a, "cube");
    EXPECT_EQ(mesh.vertexCount(), 9u);
    EXPECT_FALSE(mesh.closed);
}

TEST(Surface, AFrameThatIsNotFiniteDoesNotTearTheMesh) {
    AnimatedMesh a = cube(true);
    a.frames.insert(a.frames.begin(), a.frames[0]);
    for (glm::vec3& p : a.frames[0]) p = glm::vec3(std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(weldMesh(a, "cube").vertexCount(), 8u);
}

TEST(Surface, FlippedOrDuplicatedTrianglesAreNotClosed) {
    AnimatedMesh flipped = cube(false), twice = cube(false);
    std::swap(flipped.triangles[0].x, flipped.triangles[0].y);
    twice.triangles.push_back(twice.triangles[0]);
    EXPECT_FALSE(weldMesh(flipped, "cube").closed);
    EXPECT_FALSE(weldMesh(twice, "cube").closed);
}

TEST(Surface, NormalsIgnoreHowACubeIsCut) {  // each corner sees three right angles, however its squares are cut
    const AnimatedMesh a = cube(false);
    const std::vector<glm::vec3> normals = vertexNormals(a.triangles, cornersOfVertices(a.triangles, 8), a.frames[0]);
    for (std::size_t v = 0; v < 8; ++v) {
        const glm::vec3 expected = glm::normalize(a.frames[0][v] - glm::vec3(0.5f));
        EXPECT_LT(glm::length(normals[v] - expected), 1e-6) << v;
    }
}

TEST(Surface, NoTriangleNoNormal) {
    const std::vector<glm::vec3> positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 5, 5}};
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}};
    for (const glm::vec3& n : vertexNormals(triangles, cornersOfVertices(triangles, 4), positions))
        EXPECT_EQ(n, glm::vec3(0));
}

}  // namespace
}  // namespace nacre
