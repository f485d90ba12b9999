#include "demos/teapot.hpp"

#include <gtest/gtest.h>

namespace nacre {
namespace {

/// Shading normals of a 50 × 50 patch against the flat facets: the spout's lip, the tightest curve, turns by 25° in
/// one.
constexpr float kFacetCosine = 0.9f;
constexpr std::size_t kRevolvedPatches = 24;  // the first in the mesh

glm::vec3 facet(const Mesh& mesh, const glm::uvec3& t) {
    return cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]);
}

TEST(Teapot, NormalsAndTangentsAreUnitOrthogonalAndMatchTheFacets) {
    const Mesh mesh = makeTeapot(50);
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
    ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        EXPECT_NEAR(length(mesh.normals[i]), 1, 1e-5) << i;
        EXPECT_NEAR(length(glm::vec3(mesh.tangents[i])), 1, 1e-5) << i;
        EXPECT_NEAR(dot(glm::vec3(mesh.tangents[i]), mesh.normals[i]), 0, 1e-5) << i;
    }
    for (const glm::uvec3& t : mesh.triangles)
        EXPECT_GT(dot(normalize(facet(mesh, t)), mesh.normals[t.x]), kFacetCosine) << t.x;
}

TEST(Teapot, PointsOutward) {  // of the body: away from the axis; the signed volume of the whole is positive
    const Mesh mesh = makeTeapot(4);
    double volume = 0;
    for (const glm::uvec3& t : mesh.triangles) volume += dot(mesh.positions[t.x], facet(mesh, t)) / 6;
    EXPECT_GT(volume, 15);  // a body of radius 2 and about 2 high holds about 20
    for (std::size_t i = 0; i < kRevolvedPatches * 5 * 5; ++i) {
        const glm::vec3 p = mesh.positions[i];
        if (std::abs(p.y - 0.9f) > 1e-5f || std::abs(std::hypot(p.x, p.z) - 2) > 0.01f) continue;
        EXPECT_GT(dot(mesh.normals[i], p - glm::vec3(0, p.y, 0)), 1.9f) << i;
    }
}

TEST(Teapot, PolesHaveTheAxisAsNormal) {
    const Mesh mesh = makeTeapot(3);
    int poles = 0;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::vec3 p = mesh.positions[i];
        if (std::hypot(p.x, p.z) > 1e-6f) continue;
        ++poles;
        EXPECT_NEAR(mesh.normals[i].y, p.y > 1 ? 1 : -1, 1e-6) << i;
    }
    EXPECT_EQ(poles, 2 * 4 * 4);  // two poles, four patches, a row of four vertices each
}

TEST(Teapot, HasTheSizeOfNewellsControlPoints) {
    const Mesh mesh = makeTeapot(10);
    glm::vec3 low(1e9f), high(-1e9f);
    for (const glm::vec3& p : mesh.positions) low = min(low, p), high = max(high, p);
    EXPECT_NEAR(low.x, -3, 1e-5);      // handle
    EXPECT_NEAR(high.x, 3.434, 2e-3);  // spout's tip: inside its control polygon, whose corner is 3.525
    EXPECT_NEAR(low.y, 0, 1e-5);
    EXPECT_NEAR(high.y, 3.15, 1e-5);
    EXPECT_NEAR(high.z, 2, 1e-5);
    EXPECT_NEAR(low.z, -2, 1e-5);
    EXPECT_EQ(mesh.triangles.size(), 32u * 200u - 8u * 10u);
}

TEST(Teapot, RejectsNoSegments) { EXPECT_THROW(makeTeapot(0), std::invalid_argument); }

}  // namespace
}  // namespace nacre
