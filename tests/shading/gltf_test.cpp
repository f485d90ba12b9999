// glTF 2.0 as a scene: hierarchy, instances, lights, cameras, key frames, materials; broken files named.
#include <chrono>

#include "shading/scene_import.hpp"
#include "tests/shading/glb_writer.hpp"
#include "tests/shading/scene_files.hpp"

namespace nacre {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;
using tests::GlbWriter;
using tests::triangleGlb;

constexpr double kFloat = 1e-6;  // of numbers near 1 that pass through floats

class Gltf : public tests::SceneFiles {
protected:
    SceneDescription read(GlbWriter& glb) { return SceneFiles::read(glb.bytes(), "s.glb"); }
    std::string errorOf(GlbWriter& glb) { return SceneFiles::errorOf(glb.bytes(), "s.glb"); }
};

json lampAt(int light) { return {{"KHR_lights_punctual", {{"light", light}}}}; }

TEST_F(Gltf, HierarchyInstancesAndNamesUsedTwice) {
    GlbWriter glb = triangleGlb();
    glb.document["nodes"] = {{{"name", "A"}, {"translation", {1, 2, 3}}, {"children", {1, 2}}},
                             {{"name", "A"}, {"mesh", 0}, {"scale", {2, 2, 2}}},
                             {{"mesh", 0}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1}}},
                             {{"name", "of another scene"}, {"mesh", 0}}};
    glb.document["scenes"] = {{{"nodes", {3}}}, {{"nodes", {0}}}};
    glb.document["scene"] = 1;
    const SceneDescription scene = read(glb);
    ASSERT_EQ(scene.nodes.size(), 3u);
    EXPECT_EQ(scene.meshes.size(), 1u) << "one mesh, two instances";
    EXPECT_EQ(scene.meshes[0].name, "leaf");
    EXPECT_EQ(scene.nodes[1].name, "A");
    EXPECT_EQ(scene.nodes[2].name, "node 2");
    const auto places = nodeTransforms(scene, 0);
    EXPECT_EQ(Vec3(places[1] * Vec4(1, 0, 0, 1)), Vec3(3, 2, 3));
    EXPECT_NEAR(glm::length(Vec3(places[2] * Vec4(1, 0, 0, 1)) - Vec3(6, 3, 3)), 0, kFloat) << "a quarter turn, moved";
    EXPECT_EQ(scene.materials[0].name, "grey");
    EXPECT_EQ(scene.lights.size(), 1u) << "it has none of its own";
}

TEST_F(Gltf, LightsAndCameras) {
    GlbWriter glb = triangleGlb();
    glb.document["extensionsUsed"] = {"KHR_lights_punctual"};
    glb.document["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"},
         {"color", {1, 0.5, 0.25}},
         {"intensity", 40},
         {"range", 9},
         {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.4}}}},
        {{"type", "directional"}, {"intensity", 3}}};
    const double h = std::sqrt(0.5);
    glb.document["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.25}}}}};
    glb.document["nodes"] = {
        {{"mesh", 0}},
        {{"name", "L1"}, {"translation", {0, 4, 0}}, {"rotation", {-h, 0, 0, h}}, {"extensions", lampAt(0)}},
        {{"name", "L2"}, {"translation", {1, 0, 0}}, {"extensions", lampAt(0)}},
        {{"name", "sun"}, {"extensions", lampAt(1)}},
        {{"translation", {0, 0, 5}}, {"camera", 0}}};
    const SceneDescription scene = read(glb);
    ASSERT_EQ(scene.lights.size(), 3u) << "a light of two nodes shines twice";
    EXPECT_EQ(scene.lights[0].light.color, Rgb(40, 20, 10));
    EXPECT_EQ(scene.lights[0].light.cone->inner, 0.2);
    EXPECT_EQ(scene.lights[0].light.cone->outer, 0.4);
    EXPECT_TRUE(scene.lights[0].shadow);
    const std::vector<Light> world = lightsInWorld(scene, nodeTransforms(scene, 0));
    EXPECT_EQ(world[0].position, Vec3(0, 4, 0));
    EXPECT_NEAR(glm::length(world[0].cone->axis - Vec3(0, -1, 0)), 0, kFloat) << "turned down";
    EXPECT_EQ(world[1].cone->axis, Vec3(0, 0, -1));
    EXPECT_TRUE(world[2].directional);
    EXPECT_EQ(world[2].position, Vec3(0, 0, 1));
    EXPECT_EQ(scene.camera.eye, Vec3(0, 0, 5));
    EXPECT_EQ(scene.camera.fovY, 0.7);
    EXPECT_EQ(scene.camera.near, 0.25);
    EXPECT_GT(scene.camera.far, 5) << "none in the file: fitted";
    EXPECT_NEAR(scene.camera.target.z, 0, kFloat) << "as far as the scene's middle";
    EXPECT_THAT(notes_, Contains(HasSubstr("range")));
}

TEST_F(Gltf, KeyFrames) {
    GlbWriter glb = triangleGlb();
    const double h = std::sqrt(0.5);
    const auto f = [](double v) { return static_cast<float>(v); };
    const std::size_t times = glb.add<float>({0, 1, 2.5f}, "SCALAR", 1);
    const std::size_t moves = glb.add<float>({0, 0, 0, 1, 0, 0, 1, 2, 0}, "VEC3", 3);
    const std::size_t turns = glb.add<float>({0, 0, 0, 1, 0, f(h), 0, f(h), 0, 1, 0, 0}, "VEC4", 4);
    glb.document["nodes"] = {{{"name", "x"}, {"mesh", 0}}, {{"name", "x"}, {"mesh", 0}}, {{"mesh", 0}}};
    glb.document["scenes"] = {{{"nodes", {0, 1, 2}}}};
    glb.document["animations"] = {
        {{"samplers",
          {{{"input", times}, {"output", moves}}, {{"input", times}, {"output", turns}, {"interpolation", "STEP"}}}},
         {"channels",
          {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}},
           {{"sampler", 1}, {"target", {{"node", 1}, {"path", "rotation"}}}}}}}};
    const SceneDescription scene = read(glb);
    ASSERT_EQ(scene.tracks.size(), 2u);
    EXPECT_NEAR(scene.duration, 2.5, kFloat);
    EXPECT_EQ(scene.tracks[0].node, 1) << "the second of one name";
    EXPECT_FALSE(scene.tracks[0].step);
    EXPECT_TRUE(scene.tracks[1].step);
    const auto place = [&](double time) { return nodeTransforms(scene, time)[1]; };
    EXPECT_NEAR(place(0.5)[3].x, 0.5, kFloat);
    EXPECT_NEAR(place(1.75)[3].y, 1, kFloat);
    EXPECT_NEAR(place(0.9)[0].x, 1, kFloat) << "not turned yet";
    EXPECT_NEAR(place(1.1)[0].z, -1, kFloat) << "a quarter turn at once";
    EXPECT_TRUE(scene.nodes[0].isStatic && scene.nodes[2].isStatic);
    EXPECT_FALSE(scene.nodes[1].isStatic);
}

TEST_F(Gltf, MaterialsAreModels) {
    GlbWriter glb = triangleGlb();
    const std::size_t more = glb.add<float>({0, 0, 1, 1, 0, 1, 0, 1, 1}, "VEC3", 3);
    glb.document["meshes"][0]["primitives"][0]["material"] = 1;
    glb.document["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", more}}}, {"material", 0}});
    glb.document["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", more}}}, {"mode", 0}});
    glb.document["materials"] = {
        {{"name", "gold"},
         {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.75, 0.25, 1}}, {"roughnessFactor", 0.5}}}},
        {{"name", "paint"},
         {"emissiveFactor", {0, 0, 0.5}},
         {"normalTexture", {{"index", 0}}},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0}}}}};
    glb.document["nodes"] = {{{"name", "n"}, {"mesh", 0}}};
    const SceneDescription scene = read(glb);
    ASSERT_EQ(scene.nodes.size(), 3u) << "the node, and one for each primitive of triangles";
    EXPECT_EQ(scene.nodes[1].name, "n/1");
    EXPECT_EQ(scene.nodes[1].material, 1);
    EXPECT_EQ(scene.nodes[2].material, 0);
    EXPECT_THAT(scene.materials[0].model, HasSubstr("f0=1/0.75/0.25"));
    EXPECT_THAT(scene.materials[0].model, HasSubstr("kd=0"));
    EXPECT_THAT(scene.materials[0].model, HasSubstr("0.25"));
    EXPECT_THAT(scene.materials[1].model, HasSubstr("kd=0.5"));
    EXPECT_THAT(scene.materials[1].model, HasSubstr("alphax=1e-04")) << "the least";
    EXPECT_EQ(scene.materials[1].ambient, Rgb(0, 0, 0.5));
    EXPECT_THAT(notes_, Contains(HasSubstr("textures")));
}

TEST_F(Gltf, BrokenFilesAreNamed) {
    GlbWriter cycle;
    cycle.document["nodes"] = {
        {{"name", "root"}, {"children", {1}}}, {{"name", "a"}, {"children", {2}}}, {{"name", "b"}, {"children", {1}}}};
    cycle.document["scenes"] = {{{"nodes", {0}}}};
    EXPECT_THAT(errorOf(cycle), HasSubstr("s.glb: /nodes/2/children/0: expected no cycle, found a > b > a"));
    GlbWriter twice;
    twice.document["nodes"] = {{{"children", {1}}}, json::object(), {{"children", {1}}}};
    EXPECT_THAT(errorOf(twice), HasSubstr("/nodes/1: expected a node under one parent"));
    GlbWriter range;
    range.document["nodes"] = {{{"mesh", 3}}};
    EXPECT_THAT(errorOf(range), HasSubstr("/nodes/0/mesh: expected none"));
    GlbWriter shear;
    shear.document["nodes"] = {{{"matrix", {1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}};
    EXPECT_THAT(errorOf(shear), HasSubstr("/nodes/0/matrix: "));
    GlbWriter needs;
    needs.document["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    EXPECT_THAT(errorOf(needs), HasSubstr("/extensionsRequired/0: "));
    GlbWriter old;
    old.document["asset"]["version"] = "1.0";
    EXPECT_THAT(errorOf(old), HasSubstr("/asset/version: "));
    EXPECT_THAT(SceneFiles::errorOf("glTF", "s.glb"), HasSubstr("s.glb: expected a glTF container"));
    EXPECT_THAT(SceneFiles::errorOf("{\"asset\":", "s.gltf"), HasSubstr("s.gltf: expected JSON"));
    GlbWriter outside = triangleGlb();
    outside.document["accessors"][0]["count"] = 1000;
    outside.document["nodes"] = {{{"mesh", 0}}};
    EXPECT_THAT(errorOf(outside), HasSubstr("s.glb: expected a mesh, found: "));
}

TEST_F(Gltf, EmptyFileIsAnEmptyScene) {
    GlbWriter glb;
    EXPECT_TRUE(read(glb).nodes.empty());
}

// A million triangles within a time that somebody waits for: 0.9 s on one core of a 2 GHz server.
TEST_F(Gltf, AMillionTriangles) {
    constexpr std::uint32_t kEdge = 708;  // squares: 2 · 708² = 1 002 528 triangles
    std::vector<float> positions, normals, uvs;
    std::vector<std::uint32_t> indices;
    for (std::uint32_t j = 0; j <= kEdge; ++j)
        for (std::uint32_t i = 0; i <= kEdge; ++i) {
            const float x = static_cast<float>(i) / kEdge, y = static_cast<float>(j) / kEdge;
            positions.insert(positions.end(), {x, y, 0.05f * std::sin(20 * x) * std::sin(20 * y)});
            normals.insert(normals.end(), {0, 0, 1});
            uvs.insert(uvs.end(), {x, y});
            const std::uint32_t a = j * (kEdge + 1) + i, b = a + kEdge + 1;
            if (i < kEdge && j < kEdge) indices.insert(indices.end(), {a, a + 1, b + 1, a, b + 1, b});
        }
    GlbWriter glb;
    const std::size_t p = glb.add(positions, "VEC3", 3), n = glb.add(normals, "VEC3", 3), t = glb.add(uvs, "VEC2", 2);
    const std::size_t triangles = glb.add(indices, "SCALAR", 1);
    glb.document["meshes"] = {
        {{"primitives",
          {{{"attributes", {{"POSITION", p}, {"NORMAL", n}, {"TEXCOORD_0", t}}}, {"indices", triangles}}}}}};
    glb.document["nodes"] = {{{"mesh", 0}}};
    const auto path = write("million.glb", glb.bytes());
    const auto start = std::chrono::steady_clock::now();
    const SceneDescription scene = readScene(path);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].mesh.triangles.size(), 2 * kEdge * kEdge);
    EXPECT_EQ(scene.meshes[0].mesh.positions.size(), (kEdge + 1) * (kEdge + 1)) << "shared vertices stay shared";
    RecordProperty("seconds", std::to_string(seconds));
    std::printf("a million triangles: %.2f s\n", seconds);
    EXPECT_LT(seconds, 60) << "ten times what a sanitizer's build takes on a busy machine";
}

}  // namespace
}  // namespace nacre
