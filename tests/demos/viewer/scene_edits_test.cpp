#include "demos/viewer/scene_edits.hpp"

#include <gmock/gmock.h>

#include "core/asset.hpp"
#include "core/file.hpp"
#include "demos/viewer/orbit.hpp"
#include "shading/primitives.hpp"
#include "tests/core/scratch.hpp"

namespace nacre {
namespace {

using ::testing::HasSubstr;
using tests::messageOf;

TEST(SceneEdits, AMaterialForEachTextOnce) {
    SceneDescription scene;
    scene.materials.resize(1);
    scene.materials[0].ambient = Rgb(0.2);
    const int first = materialFor(scene, "lambert:kd=0.5", 0);
    EXPECT_EQ(first, 1);
    EXPECT_EQ(scene.materials[1].model, "lambert:kd=0.5");
    EXPECT_EQ(scene.materials[1].ambient, Rgb(0.2));
    EXPECT_EQ(materialFor(scene, "lambert:kd=0.5", 0), first);
    EXPECT_THAT(messageOf<std::invalid_argument>([&] { materialFor(scene, "no-such-model", 0); }),
                HasSubstr("no-such-model"));
    EXPECT_THAT(messageOf<std::invalid_argument>([&] { materialFor(scene, "gone.exr", 0); }),
                HasSubstr("gone.exr: expected a file"));
    EXPECT_EQ(scene.materials.size(), 2u);
}

TEST(SceneEdits, FindsBakedAssetsAmongOtherFiles) {
    const tests::Scratch scratch;
    Asset asset;
    asset.kind = "fresnel";
    asset.meta["kind"] = "fresnel";
    asset.textures.push_back({.name = "fresnel", .mapping = "cos", .image = Image(4, 1, 1)});
    writeAsset(asset, scratch / "b.exr");
    writeAsset(asset, scratch / "a.exr");
    writeFile(scratch / "broken.exr", "no EXR");
    writeFile(scratch / "text.txt", "text");
    const auto found = findAssets({scratch.folder(), scratch / "absent", scratch.folder()});
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].file, scratch / "a.exr");
    EXPECT_EQ(found[1].kind, "fresnel");
    SceneDescription scene;
    EXPECT_EQ(assetFor(scene, scratch / "a.exr"), 0);
    EXPECT_EQ(assetFor(scene, scratch / "b.exr"), 1);
    EXPECT_EQ(assetFor(scene, scratch.folder() / "." / "a.exr"), 0);
    EXPECT_EQ(scene.assets[1].name, "b");
}

TEST(SceneEdits, PicksTheNearestMesh) {
    SceneDescription scene;
    scene.meshes = {{"quad", makeQuad(1, 1)}};
    scene.materials.resize(1);
    for (const double z : {0.0, 1.0}) {
        SceneNode node;
        node.mesh = node.material = 0;
        node.translation = {z, 0, z};  // the nearer one covers the right half
        node.scale = Vec3(2, 2, 1);
        scene.nodes.push_back(node);
    }
    const Camera camera;
    const auto nodes = nodeTransforms(scene, 0);
    const Vec2 size(200, 100);
    const auto at = [&](const Vec3& point) {
        return nodeAt(scene, nodes, camera, Vec2(inPicture(camera, point, size)), size);
    };
    EXPECT_EQ(at({-0.4, 0.1, 0}), 0);
    EXPECT_EQ(at({0.3, 0.1, 1}), 1);
    EXPECT_EQ(at({0, 5, 0}), -1);
}

}  // namespace
}  // namespace nacre
