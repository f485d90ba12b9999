// Bounds and cameras of scenes, scenes put into others, and what manifests name.
#include "shading/scene_bounds.hpp"
#include "shading/scene_manifest.hpp"
#include "shading/scene_merge.hpp"
#include "tests/shading/scene_files.hpp"

namespace nacre {
namespace {

using ::testing::HasSubstr;
using tests::messageOf;

constexpr double kRounding = 1e-12;

/// A node at `place` with a mesh from (0, 0, 0) to (1, 2, 3).
SceneDescription boxAt(const Vec3& place) {
    SceneDescription scene;
    scene.meshes.resize(1);
    scene.meshes[0].mesh.positions = {{0, 0, 0}, {1, 2, 3}};
    scene.materials.resize(1);
    scene.nodes.resize(1);
    scene.nodes[0].mesh = scene.nodes[0].material = 0;
    scene.nodes[0].translation = place;
    return scene;
}

TEST(SceneBounds, FollowNodesAndTheirTracks) {
    SceneDescription scene = boxAt({5, 0, 0});
    EXPECT_EQ(boundsAt(scene, 0).low, Vec3(5, 0, 0));
    EXPECT_EQ(boundsAt(scene, 0).high, Vec3(6, 2, 3));
    EXPECT_NEAR(boundsAt(scene, 0).radius(), 0.5 * std::sqrt(14.0), kRounding);
    scene.tracks = {
        {0, SceneTrack::Path::Translation, {0, 0.001, 2}, {{0, 0, 0, 0}, {-9, 0, 0, 0}, {7, 0, 0, 0}}, false}};
    scene.duration = 2;
    EXPECT_EQ(boundsOf(scene).low.x, -9) << "a key frame between the moments";
    EXPECT_GT(boundsOf(scene).high.x, 6);
    EXPECT_TRUE(boundsOf(SceneDescription()).empty);
}

TEST(SceneBounds, CameraSeesThemAndDepthHoldsThem) {
    const SceneBounds bounds = boundsOf(boxAt({100, -50, 3}));
    const Camera camera = cameraSeeing(bounds);
    const glm::dmat4 clip = camera.projection(1) * camera.view();
    for (int i = 0; i < 8; ++i) {
        const Vec4 p = clip * Vec4(i & 1 ? bounds.low.x : bounds.high.x, i & 2 ? bounds.low.y : bounds.high.y,
                                   i & 4 ? bounds.low.z : bounds.high.z, 1);
        EXPECT_LE(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), p.w);
    }
    Camera inside;
    inside.eye = bounds.centre();
    inside.near = 0.25;
    inside.far = 0;
    EXPECT_EQ(withDepth(inside, bounds).near, 0.25) << "what is given stays";
    EXPECT_GT(withDepth(inside, bounds).far, bounds.radius());
    inside.near = 0;
    EXPECT_GT(withDepth(inside, bounds).near, 0);
    SceneBounds plain;  // kilometres of floor about what is looked at
    plain.add({-8000, 0, -8000});
    plain.add({8000, 1, 8000});
    inside.target = inside.eye + Vec3(0, 0, -5);
    EXPECT_LT(withDepth(inside, plain).near, 0.2);
    EXPECT_GT(withDepth(inside, plain).near, 0.01);
    EXPECT_EQ(withDepth(inside, SceneBounds()).far, Camera().far);
    EXPECT_EQ(cameraSeeing(SceneBounds()).eye, Camera().eye);
}

TEST(SceneBounds, CamerasTurnAndMoveButKeepTheirDistance) {
    Camera camera;
    camera.eye = {0, 0, 0};
    camera.target = {0, 0, -4};
    glm::dmat4 turn(0);  // x becomes z, z becomes −x, twice as large
    turn[0] = {0, 0, 2, 0};
    turn[1] = {0, 2, 0, 0};
    turn[2] = {-2, 0, 0, 0};
    turn[3] = {1, 2, 3, 1};
    const Camera moved = cameraAt(camera, turn);
    EXPECT_EQ(moved.eye, Vec3(1, 2, 3));
    EXPECT_NEAR(glm::length(moved.target - Vec3(5, 2, 3)), 0, kRounding);
    EXPECT_EQ(moved.up, Vec3(0, 1, 0));
}

TEST(SceneMerge, ShiftsEveryIndex) {
    SceneDescription to = boxAt({}), from = boxAt({});
    to.assets.resize(3);
    to.lights.resize(2);
    from.assets.resize(5);
    from.assets[0].name = "first";
    from.lights.resize(1);
    from.materials[0].brdf = 1;
    from.materials[0].relief = SceneRelief{};
    from.materials[0].relief->asset = 2;
    from.materials[0].relief->indirectLight = 0;
    from.materials[0].surrounding = SceneSurrounding{};
    from.materials[0].surrounding->diffuse.asset = 3;
    from.materials[0].surrounding->table = 4;
    from.tracks = {{0, SceneTrack::Path::Scale, {0}, {{1, 1, 1, 0}}, false}};
    const MergedParts parts = mergeParts(to, from, "p/");
    mergeInstance(to, from, parts, 0, -1);
    mergeInstance(to, from, parts, 0, 0);
    markMoving(to);
    EXPECT_EQ(to.assets[3].name, "p/first");
    const SceneMaterial& m = to.materials[1];
    EXPECT_EQ(m.brdf, 4);
    EXPECT_EQ(m.relief->asset, 5);
    EXPECT_EQ(m.relief->indirectLight, 2);
    EXPECT_EQ(m.surrounding->diffuse.asset, 6);
    EXPECT_EQ(m.surrounding->reflection.asset, -1);
    EXPECT_EQ(m.surrounding->table, 7);
    ASSERT_EQ(to.nodes.size(), 3u);
    EXPECT_EQ(to.nodes[2].parent, 0);
    EXPECT_EQ(to.nodes[1].mesh, 1);
    EXPECT_EQ(to.nodes[1].material, 1);
    EXPECT_EQ(to.nodes[2].material, 0);
    EXPECT_EQ(to.lights[3].node, 0) << "a light of no node moves with the one that imports it";
    EXPECT_EQ(to.tracks[1].node, 2);
    EXPECT_TRUE(to.nodes[0].isStatic);
    EXPECT_FALSE(to.nodes[2].isStatic);
}

class Manifest : public tests::SceneFiles {};

TEST_F(Manifest, NamesEachFileOnceAndRefusesTwoRecipes) {
    write("in.json",
          R"({"assets": {"a": {"file": "sub/../a.exr", "bake": {"verb": "envmap", "source": "c_%s.hdr"}}}, "x": 1})");
    write("c_px.hdr", "");
    write("c_nx.hdr", "");
    const auto out = write(
        "out.json",
        R"({"assets": {"b": {"file": "b.exr"}}, "nodes": {"n": {"import": "in.json"}, "m": {"import": "in.json"}}})");
    const std::vector<SceneAsset> assets = readManifest(out);
    ASSERT_EQ(assets.size(), 2u);
    EXPECT_EQ(assets[1].name, "m/a");
    EXPECT_EQ(assets[1].file, scratch_ / "a.exr");
    EXPECT_EQ(assets[1].bake->inputs.size(), 2u) << "the faces that are there";
    write("out.json", R"({"assets": {"b": {"file": "a.exr"}}, "nodes": {"n": {"import": "in.json"}}})");
    EXPECT_THAT(messageOf<Error>([&] { readManifest(out); }), HasSubstr("in.json: /assets/a: "));
    write("out.json", R"({"assets": {}, "nodes": {"n": {"import": "out.json"}}})");
    EXPECT_THAT(messageOf<Error>([&] { readManifest(out); }), HasSubstr("/nodes/n/import: expected no cycle"));
    write("out.json", R"({"assets": {"f": {"file": "f.exr", "bake": {"verb": "fresnel", "source": "x"}}}})");
    EXPECT_THAT(messageOf<Error>([&] { readManifest(out); }), HasSubstr("/assets/f/bake/source: "));
    write("out.json",
          R"({"assets": {"f": {"file": "f.exr", "bake": {"verb": "fresnel", "options": {"--output": "x"}}}}})");
    EXPECT_THAT(messageOf<Error>([&] { readManifest(out); }), HasSubstr("/assets/f/bake/options/--output: "));
}

}  // namespace
}  // namespace nacre
