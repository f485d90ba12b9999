#include "shading/primitives.hpp"

#include <gtest/gtest.h>

#include <set>

#include "shading/mesh_attributes.hpp"

namespace nacre {
namespace {

constexpr double kFloat = 2e-6;  // unit vectors rounded to single precision

double signedVolume(const Mesh& mesh) {
    double sum = 0;
    for (const glm::uvec3& t : mesh.triangles)
        sum +=
            glm::dot(Vec3(mesh.positions[t.x]), glm::cross(Vec3(mesh.positions[t.y]), Vec3(mesh.positions[t.z]))) / 6;
    return sum;
}

double area(const Mesh& mesh) {
    double sum = 0;
    for (const glm::uvec3& t : mesh.triangles) {
        const Vec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        sum += glm::length(glm::cross(b - a, c - a)) / 2;
    }
    return sum;
}

void expectSoundAttributes(Mesh mesh) {
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
    ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        EXPECT_NEAR(glm::length(Vec3(mesh.normals[i])), 1, kFloat);
        EXPECT_NEAR(glm::length(Vec3(mesh.tangents[i])), 1, kFloat);
        EXPECT_NEAR(glm::dot(Vec3(mesh.normals[i]), Vec3(mesh.tangents[i])), 0, kFloat);
        EXPECT_EQ(mesh.tangents[i].w, 1.0f);
    }
    for (const glm::uvec3& t : mesh.triangles) {  // counter-clockwise from outside
        const Vec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        EXPECT_GT(glm::dot(glm::cross(b - a, c - a), Vec3(mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z])),
                  0);
    }
    EXPECT_EQ(removeDegenerateTriangles(mesh), 0u);
}

TEST(Primitives, AttributesAreSound) {
    for (TangentDirection direction : {TangentDirection::Circular, TangentDirection::Radial}) {
        expectSoundAttributes(makeTorus(1, 0.4f, 24, 16, direction));
        expectSoundAttributes(makeSphere(2, 16, 8, direction));
        expectSoundAttributes(makeDisk(1, 12, 4, direction));
    }
    expectSoundAttributes(makeQuad(2, 3));
    expectSoundAttributes(makeSphere(1, 3, 2));  // the least
    expectSoundAttributes(makeTorus(1, 0.4f, 3, 3));
}

// Closed surfaces enclose, and open ones cover, what geometry says: 2π²Rr², 4π/3 r³, πr².
TEST(Primitives, VolumesAndAreas) {
    EXPECT_NEAR(signedVolume(makeTorus(1, 0.4f, 200, 200)), 2 * kPi * kPi * 0.16, 2e-3);
    EXPECT_NEAR(signedVolume(makeSphere(1, 256, 128)), 4 * kPi / 3, 2e-3);
    EXPECT_NEAR(area(makeDisk(1, 256, 4)), kPi, 1e-3);
    EXPECT_NEAR(area(makeQuad(2, 5)), 4, 1e-6);
    EXPECT_EQ(makeTorus().triangles.size(), 2u * 200 * 200);
}

// HSE figure 3: circular tangents run around the axis, radial ones away from it.
TEST(Primitives, TangentsFollowTheirDirection) {
    const Mesh circular = makeDisk(1, 12, 4, TangentDirection::Circular),
               radial = makeDisk(1, 12, 4, TangentDirection::Radial);
    for (std::size_t i = 0; i < circular.positions.size(); ++i) {
        const Vec3 p(circular.positions[i]);
        if (glm::length(p) < 0.1) continue;
        EXPECT_NEAR(glm::dot(Vec3(circular.tangents[i]), glm::cross(Vec3(0, 0, 1), p) / glm::length(p)), 1, kFloat);
        EXPECT_NEAR(glm::dot(Vec3(radial.tangents[i]), p / glm::length(p)), 1, kFloat);
    }
    const Mesh ball = makeSphere(1, 16, 8, TangentDirection::Circular),
               down = makeSphere(1, 16, 8, TangentDirection::Radial);
    for (std::size_t i = 0; i < ball.positions.size(); ++i) {
        const Vec3 n(ball.normals[i]), around = glm::cross(Vec3(0, 1, 0), n);
        if (glm::length(around) < 0.1) continue;
        EXPECT_NEAR(glm::dot(Vec3(ball.tangents[i]), glm::normalize(around)), 1, kFloat);
        EXPECT_NEAR(glm::dot(Vec3(down.tangents[i]), glm::normalize(Vec3(0, -1, 0) + n * n.y)), 1, kFloat);
    }
}

TEST(Primitives, RejectBadSizes) {
    EXPECT_THROW(makeTorus(0), std::invalid_argument);
    EXPECT_THROW(makeTorus(1, 0.4f, 2), std::invalid_argument);
    EXPECT_THROW(makeSphere(-1), std::invalid_argument);
    EXPECT_THROW(makeSphere(1, 3, 1), std::invalid_argument);
    EXPECT_THROW(makeDisk(std::nanf("")), std::invalid_argument);
    EXPECT_THROW(makeQuad(1, 0), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
