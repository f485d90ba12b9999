// Stages of a picture by rays: one bounce against a closed form, and that the stages are the whole.
#include "reference/scene_components.hpp"

#include <gtest/gtest.h>

namespace nacre {
namespace {

Mesh square(float half) {
    Mesh mesh;
    mesh.positions = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.tangents.assign(4, {1, 0, 0, 1});
    mesh.uvs.assign(4, {0, 0});
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

/// A floor that the lamp doesn't reach under a lit ceiling, with a mirror on the floor's left half. The camera is
/// between both.
SceneDescription room() {
    SceneDescription scene;
    scene.meshes = {{"floor", square(2)}, {"ceiling", square(0.7f)}};
    scene.materials.resize(2);
    scene.materials[1].specular.emplace();
    scene.nodes.resize(3);
    for (SceneNode& node : scene.nodes) node.mesh = node.material = 0;
    scene.nodes[1].mesh = 1;
    scene.nodes[1].translation = {0, 0, 1};
    scene.nodes[1].rotation = glm::angleAxis(kPi, Vec3(1, 0, 0));
    scene.nodes[2].translation = {-2.6, 0, 0.01};
    scene.nodes[2].material = 1;
    scene.lights.resize(1);
    scene.lights[0].light = {true, {0, 0, -1}, Rgb(3, 2, 1), {}};
    scene.camera.eye = {0, 0, 0.95};
    scene.camera.orthographic = true;
    scene.camera.near = 0.01;
    return scene;
}

SceneTruths truths() {
    SceneTruths out;
    out.materials.resize(2);
    out.materials[0].brdf = [](const Vec3&, const Vec3&) { return Rgb(0.5 / kPi); };
    return out;
}

SceneComponents trace(const SceneDescription& scene) {
    SceneTraceOptions options{.width = 15, .height = 15, .supersample = 2};
    options.interreflectionPaths = 4096;
    return traceComponents(scene, scene.camera, truths(), options);
}

TEST(SceneComponents, OneBounceHasTheFormFactorOfTheCeiling) {
    const SceneComponents parts = trace(room());
    const double x = 0.7 / std::sqrt(1 + 0.49), factor = 4 / kPi * x * std::atan(x);
    for (int c = 0; c < 3; ++c) {
        const double expected = 0.5 * 0.5 * (3 - c) * factor / kPi;
        EXPECT_NEAR(parts.indirect.at(7, 7, c), expected, 5e-3 * expected) << c;  // 2e-3 less about the middle
        EXPECT_EQ(parts.direct.at(7, 7, c), 0);
    }
}

TEST(SceneComponents, TheirSumIsTheWholeAndTagsAreTheMirrors) {
    const SceneComponents parts = trace(room());
    double traced = 0;
    for (int y = 0; y < 15; ++y)
        for (int x = 0; x < 15; ++x) {
            const Rgb sum = parts.direct.rgb(x, y) + parts.indirect.rgb(x, y) + parts.traced.rgb(x, y);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], parts.blended.at(x, y, c), 1e-5);
            // the mirror's edge is at x = -0.6, a fifth of the picture from its left
            EXPECT_EQ(parts.tagged.at(x, y, 0), x < 3 ? 1 : 0) << x;
            if (x >= 3) {
                EXPECT_EQ(parts.traced.rgb(x, y), Rgb(0));
            }
            traced += parts.traced.at(x, y, 0);
        }
    EXPECT_GT(traced, 0) << "the mirror shows the lit ceiling";
}

}  // namespace
}  // namespace nacre
