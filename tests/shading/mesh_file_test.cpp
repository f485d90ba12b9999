#include "shading/mesh_file.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include "core/error.hpp"
#include "core/file.hpp"
#include "shading/mesh_attributes.hpp"
#include "shading/primitives.hpp"

namespace nacre {
namespace {

using ::testing::HasSubstr;

class MeshFile : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() / ("nacre_mesh_test_" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    LoadedMesh load(const std::string& name, const std::string& text) {
        writeFile(folder_ / name, text);
        return loadMesh(folder_ / name);
    }
    std::string errorOf(const std::string& name, const std::string& text) {
        try {
            load(name, text);
        } catch (const Error& error) {
            return error.what();
        }
        return "(no error)";
    }
    std::filesystem::path folder_;
};

const char* const kTetrahedronOff = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

/// Sound normals and tangents, whatever the file had.
void expectComplete(const Mesh& mesh) {
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        EXPECT_NEAR(glm::length(mesh.normals[i]), 1, 1e-5);
        EXPECT_NEAR(glm::length(glm::vec3(mesh.tangents[i])), 1, 1e-5);
        EXPECT_NEAR(glm::dot(mesh.normals[i], glm::vec3(mesh.tangents[i])), 0, 1e-5);
    }
}

TEST_F(MeshFile, OffGetsSmoothNormals) {
    const LoadedMesh loaded = load("t.off", kTetrahedronOff);
    EXPECT_EQ(loaded.mesh.triangles.size(), 4u);
    EXPECT_TRUE(loaded.report.madeNormals);
    EXPECT_EQ(loaded.report.standInNormals, 0u);
    expectComplete(loaded.mesh);
    for (std::size_t i = 0; i < loaded.mesh.positions.size(); ++i)  // away from the middle
        EXPECT_GT(glm::dot(loaded.mesh.normals[i], loaded.mesh.positions[i] - glm::vec3(0.25f)), 0);
}

TEST_F(MeshFile, ObjKeepsItsNormalsAndUvs) {
    const LoadedMesh loaded = load("q.obj",
                                   "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 0 1\nvt -1 1\nvt -1 0\nvn 0 0 2\n"
                                   "f 1/1/1 2/2/1 3/3/1 4/4/1\n");
    EXPECT_EQ(loaded.mesh.triangles.size(), 2u);
    EXPECT_FALSE(loaded.report.madeNormals);
    expectComplete(loaded.mesh);
    for (std::size_t i = 0; i < loaded.mesh.positions.size(); ++i) {  // uv turned a quarter: u grows along −y
        EXPECT_EQ(loaded.mesh.normals[i], glm::vec3(0, 0, 1));
        EXPECT_EQ(loaded.mesh.tangents[i], glm::vec4(0, -1, 0, 1));
    }
}

TEST_F(MeshFile, MirroredUvsGiveNegativeHandedness) {
    const LoadedMesh loaded =
        load("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 -1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1\n");
    for (const glm::vec4& t : loaded.mesh.tangents) EXPECT_EQ(t, glm::vec4(1, 0, 0, -1));
}

TEST_F(MeshFile, PlyAndGltfLoad) {
    EXPECT_EQ(load("t.ply",
                   "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                   "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
                  .mesh.triangles.size(),
              1u);
    // 3 positions, then 3 16-bit indices
    const std::string buffer = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA";
    const LoadedMesh gltf = load(
        "t.gltf",
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[0,0,5]}],)"
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
        R"("buffers":[{"byteLength":42,"uri":"data:application/octet-stream;base64,)" +
            buffer +
            R"("}],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],)"
            R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},)"
            R"({"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}]})");
    ASSERT_EQ(gltf.mesh.triangles.size(), 1u);
    EXPECT_EQ(gltf.mesh.positions[0].z, 5.0f);  // the node's transformation is applied
}

TEST_F(MeshFile, DegenerateAndDuplicatedTriangles) {
    const LoadedMesh loaded =
        load("d.off", "OFF\n4 5 0\n0 0 0\n1 0 0\n0 1 0\n2 0 0\n3 0 1 2\n3 0 1 2\n3 0 0 1\n3 0 1 3\n3 1 1 1\n");
    EXPECT_EQ(loaded.mesh.triangles.size(), 2u);
    EXPECT_GE(loaded.report.degenerateTriangles, 1u);
    expectComplete(loaded.mesh);
}

TEST_F(MeshFile, ErrorsNameTheFile) {
    EXPECT_THAT(errorOf("empty.obj", "# nothing\n"), HasSubstr("empty.obj"));
    EXPECT_THAT(errorOf("flat.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n"), HasSubstr("flat.off"));
    EXPECT_THAT(
        errorOf("nan.ply",
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                "element face 1\nproperty list uchar int vertex_indices\nend_header\nnan 0 0\n1 0 0\n0 1 0\n"
                "3 0 1 2\n"),
        HasSubstr("nan.ply"));
    EXPECT_THAT(errorOf("what.xyz", "no mesh"), HasSubstr("what.xyz: expected a mesh"));
    EXPECT_THAT(errorOf("broken.gltf", "{"), HasSubstr("broken.gltf: expected a mesh"));
    EXPECT_THROW(loadMesh(folder_), Error);
    EXPECT_THROW(loadMesh(folder_ / "missing.obj"), Error);
}

TEST_F(MeshFile, FitToBox) {
    Mesh mesh = load("t.off", kTetrahedronOff).mesh;
    for (glm::vec3& p : mesh.positions) p = p * glm::vec3(10, 5, 1) + 100.0f;
    fitToBox(mesh, 2);
    glm::vec3 low(9), high(-9);
    for (const glm::vec3& p : mesh.positions) low = glm::min(low, p), high = glm::max(high, p);
    EXPECT_NEAR(high.x - low.x, 2, 1e-5);
    EXPECT_NEAR(high.y - low.y, 1, 1e-5);
    EXPECT_NEAR(glm::length(low + high), 0, 1e-5);
    Mesh point;
    EXPECT_THROW(fitToBox(point), std::invalid_argument);
    point.positions.assign(3, glm::vec3(1));
    EXPECT_THROW(fitToBox(point), std::invalid_argument);
}

// Made normals come near the exact ones: second order in the tessellation, seams and poles included.
TEST(MeshAttributes, MadeNormalsMatchTheSphere) {
    Mesh mesh = makeSphere(1, 64, 32);
    const std::vector<glm::vec3> exact = mesh.normals;
    EXPECT_EQ(makeNormals(mesh), 0u);
    for (std::size_t i = 0; i < exact.size(); ++i) EXPECT_GT(glm::dot(exact[i], mesh.normals[i]), 0.9999f) << i;
    makeTangents(mesh);
    const Mesh fresh = makeSphere(1, 64, 32);
    for (std::size_t i = 0; i < exact.size(); ++i) {
        if (std::abs(exact[i].y) > 0.9f) continue;
        EXPECT_GT(glm::dot(glm::vec3(fresh.tangents[i]), glm::vec3(mesh.tangents[i])), 0.99f) << i;
        EXPECT_EQ(mesh.tangents[i].w, 1.0f);
    }
}

TEST(MeshAttributes, UnusedVerticesGetTheStandIn) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {7, 7, 7}};
    mesh.triangles = {{0, 1, 2}};
    EXPECT_EQ(makeNormals(mesh), 1u);
    EXPECT_EQ(mesh.normals[0], glm::vec3(1, 0, 0));
    EXPECT_EQ(mesh.normals[3], glm::vec3(0, 0, 1));
    EXPECT_EQ(tangentAround({0, 1, 0}), glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(tangentAround({0, 0, 1}), glm::vec4(1, 0, 0, 1));
    mesh.triangles = {{0, 1, 9}};
    EXPECT_THROW(removeDegenerateTriangles(mesh), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
