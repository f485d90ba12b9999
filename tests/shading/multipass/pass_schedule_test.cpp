// Lists of passes, without OpenGL.
#include "shading/multipass/pass_schedule.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "core/error.hpp"
#include "shading/multipass/light_schedule.hpp"
#include "shading/multipass/pass_text.hpp"
#include "shading/scene_bounds.hpp"
#include "tests/shading/multipass/specular_fixture.hpp"

namespace nacre {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

PassSchedule scheduleOf(const SceneDescription& scene, const SpecularOptions& options = {}, int size = 128) {
    const SceneBounds box = boundsAt(scene, 0);
    return makeSchedule(specularFaces(scene, nodeTransforms(scene, 0)), {scene.camera, size, size, box.low, box.high},
                        options);
}

std::map<PassKind, int> countsOf(const PassSchedule& schedule) {
    std::map<PassKind, int> out;
    for (const Pass& pass : schedule.passes) ++out[pass.kind];
    return out;
}

/// As the runner would count in one pixel that every mask covers.
void expectCountsReturn(const PassSchedule& schedule) {
    int value = 0;
    for (const Pass& pass : schedule.passes) {
        EXPECT_EQ(pass.stencil, value);
        value += pass.kind == PassKind::Mask ? 1 : pass.kind == PassKind::Unmask ? -1 : 0;
    }
    EXPECT_EQ(value, 0);
}

TEST(PassSchedule, WithoutFacesItIsOnePass) {
    test::SpecularScene s;
    s.ball({1, 0, 0}, {0, 0, 0});
    const PassSchedule schedule = scheduleOf(s.scene);
    ASSERT_EQ(schedule.passes.size(), 1u);
    EXPECT_EQ(schedule.passes[0].kind, PassKind::Surfaces);
    EXPECT_EQ(schedule.passes[0].scissor, (PixelRect{0, 0, 128, 128}));
}

TEST(PassSchedule, OneMirrorIsMaskedDrawnAndUnmasked) {
    test::SpecularScene s;
    s.face("mirror", {.reflection = Rgb(0.5, 0.6, 0.7)}, {0, 0, 0}, 0.2, {0, 1, 0}, Vec3(0.5));
    const PassSchedule schedule = scheduleOf(s.scene);
    std::vector<PassKind> kinds;
    for (const Pass& pass : schedule.passes) kinds.push_back(pass.kind);
    EXPECT_EQ(kinds, (std::vector<PassKind>{PassKind::Surfaces, PassKind::Mask, PassKind::Clear, PassKind::Surfaces,
                                            PassKind::Unmask}));
    expectCountsReturn(schedule);
    EXPECT_EQ(schedule.views[1].light.factor, Rgb(0.5, 0.6, 0.7));
    EXPECT_FALSE(schedule.views[1].adds);
    const PixelRect scissor = schedule.passes[1].scissor;
    EXPECT_LT(scissor.width, 128) << "about the face alone";
    EXPECT_GT(scissor.x, 0);
    EXPECT_THAT(passListText(schedule, {"mirror"}), HasSubstr("camera > mirror reflects"));
}

TEST(PassSchedule, EachViewAddsEachLight) {
    test::SpecularScene s;
    s.face("mirror", {}, {0, 0, 0}, 0.2, {0, 1, 0}, Vec3(0.5));
    SceneLight lamp;
    lamp.light = {false, {0, 1, 2}, Rgb(1), {}};
    lamp.shadow = SceneShadow{};
    s.scene.lights = {lamp};
    SceneSwitches on;
    on.shadowMethod = ShadowMethod::Volumes;
    on.specular.lightDepth = 1;
    const std::vector<glm::dmat4> nodes = nodeTransforms(s.scene, 0);
    const std::vector<SpecularFace> faces = specularFaces(s.scene, nodes);
    ScheduleInput input{s.scene.camera, 64, 64, Vec3(-1), Vec3(1), {}};
    input.lights =
        scheduledLights(s.scene, on, shadowedLamps(s.scene, on, nodes, lightsInWorld(s.scene, nodes)), faces);
    ASSERT_EQ(input.lights.size(), 2u) << "the lamp, and its image";
    const PassSchedule schedule = makeSchedule(faces, input, on.specular);
    EXPECT_EQ(countsOf(schedule)[PassKind::Light], 4);
    expectCountsReturn(schedule);
    EXPECT_THAT(passListText(schedule, {"mirror"}, {"lamp"}),
                AllOf(HasSubstr("lamp > mirror reflects: add in 1 light volume"), HasSubstr("of 2 parts of the path"),
                      HasSubstr("light passes in each view, at most: 1 of lamps, each with all its points, 1 of")));
    SpecularOptions flat = on.specular;
    flat.keepDepth = false;
    EXPECT_THROW(makeSchedule(faces, input, flat), Error);
    on.shadows = false;
    EXPECT_TRUE(shadowedLamps(s.scene, on, nodes, lightsInWorld(s.scene, nodes)).empty());
}

/// What a pane shows of the side where the lamp is isn't lit by what goes through to the other.
TEST(PassSchedule, ViewsAddTheLightsThatCanReachThem) {
    test::SpecularScene s;
    SceneSpecular glass;
    glass.ior = 1.3;
    glass.partial = false;
    s.face("pane", glass, {0, 0, 0}, 0.2, {0, 1, 0}, Vec3(0.5));
    SceneLight lamp;
    lamp.light = {false, {0, 1, -2}, Rgb(1), {}};
    lamp.shadow = SceneShadow{};
    const auto lights = [&](const Vec3& at) {
        s.scene.lights = {lamp};
        s.scene.lights[0].light.position = at;
        SceneSwitches on;
        on.specular.lightDepth = 1;
        const std::vector<glm::dmat4> nodes = nodeTransforms(s.scene, 0);
        const std::vector<SpecularFace> faces = specularFaces(s.scene, nodes);
        ScheduleInput input{s.scene.camera, 64, 64, Vec3(-1), Vec3(1), {}};
        input.lights =
            scheduledLights(s.scene, on, shadowedLamps(s.scene, on, nodes, lightsInWorld(s.scene, nodes)), faces);
        EXPECT_EQ(input.lights.size(), 1u);
        const PassSchedule schedule = makeSchedule(faces, input, on.specular);
        EXPECT_EQ(schedule.views.size(), 2u);
        return countsOf(schedule)[PassKind::Light];
    };
    EXPECT_EQ(lights({0, 1, -2}), 1) << "towards the camera: what it sees through the pane is on the other side";
    EXPECT_EQ(lights({0, 1, 2}), 2) << "away from the camera";
}

TEST(PassSchedule, TwoFacingMirrorsAreDrawnInTurns) {
    for (const int depth : {0, 1, 2, 8, 30}) {
        SpecularOptions options;
        options.depth = depth;
        test::SpecularScene s;
        s.face("far", {}, {0, 0, -3}, 0, {0, 1, 0}, Vec3(4));
        s.face("near", {}, {0, 0, 4}, kPi, {0, 1, 0}, Vec3(4));
        const PassSchedule schedule = scheduleOf(s.scene, options);
        EXPECT_EQ(schedule.views.size(), depth + 1u) << "one view a level: far, near, far …";
        EXPECT_EQ(schedule.deepest, depth);
        expectCountsReturn(schedule);
        for (int i = 1; i <= depth; ++i) EXPECT_EQ(schedule.views[static_cast<std::size_t>(i)].face, (i + 1) % 2);
    }
}

TEST(PassSchedule, StencilExhaustionIsReported) {
    SpecularOptions options;
    options.depth = 128;
    try {
        scheduleOf(test::hallOfMirrors(), options);
        FAIL() << "expected an error";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("at most 127 with 8 bits"));
    }
    options.depth = 127;
    EXPECT_NO_THROW(scheduleOf(test::hallOfMirrors(), options));
    options.stencilBits = 4;
    options.depth = 8;
    EXPECT_THROW(scheduleOf(test::hallOfMirrors(), options), Error);
    options.depth = 7;
    expectCountsReturn(scheduleOf(test::hallOfMirrors(), options));
}

TEST(PassSchedule, TooManyViewsAreReported) {
    SpecularOptions options;
    options.depth = 8;
    options.most = 4;
    EXPECT_THROW(scheduleOf(test::hallOfMirrors(), options), Error);
}

/// Each view adds all lights: a list with few views can be too long to draw, and to wait for.
TEST(PassSchedule, TooManyLightsInAllViewsAreReported) {
    const SceneDescription scene = test::hallOfMirrors();
    ScheduleInput input{scene.camera, 64, 64, Vec3(-5), Vec3(5), {}};
    input.lights.resize(100);
    SpecularOptions options;
    options.most = 9;
    const auto faces = specularFaces(scene, nodeTransforms(scene, 0));
    options.depth = 1;
    EXPECT_NO_THROW(makeSchedule(faces, input, options));
    options.depth = 2;
    try {
        makeSchedule(faces, input, options);
        FAIL();
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("expected at most 225 passes, found more at depth 2 with 100 lights"));
    }
}

TEST(PassSchedule, CounterLeavesRoomForShadows) {
    constexpr StencilCounter counter;
    EXPECT_EQ(counter.shadowMin(), 128);
    EXPECT_EQ(counter.shadowZero(), 192);
    EXPECT_EQ(counter.deepest(), 127);
    EXPECT_EQ(counter.shadowZero() - counter.mostVolumes(), counter.shadowMin() + 1);
}

/// Views beyond the camera's own.
std::size_t behind(const SceneDescription& scene) { return scheduleOf(scene).views.size() - 1; }

TEST(PassSchedule, CameraOnTheMirrorsPlane) {
    test::SpecularScene s;
    s.face("mirror", {}, {0, -1, 0}, -kPi / 2, {1, 0, 0}, Vec3(5));
    s.scene.camera.eye = {0, -1, 3};
    s.scene.camera.target = {0, -1, 0};
    EXPECT_EQ(behind(s.scene), 0u);
}

TEST(PassSchedule, FaceEdgeOn) {
    test::SpecularScene s;
    s.face("mirror", {}, {0, 0, 0}, kPi / 2);
    s.scene.camera.orthographic = true;
    EXPECT_EQ(behind(s.scene), 0u);
}

TEST(PassSchedule, FacePartlyBehindTheCamera) {
    test::SpecularScene s;
    s.face("floor", {}, {0, -1, 3}, -kPi / 2, {1, 0, 0}, Vec3(8));
    const PassSchedule schedule = scheduleOf(s.scene);
    ASSERT_EQ(schedule.views.size(), 2u);
    EXPECT_EQ(schedule.views[1].scissor.y, 0) << "down to the picture's edge";
    EXPECT_EQ(schedule.views[1].scissor.width, 128);
    EXPECT_LT(schedule.views[1].scissor.height, 70) << "and up to the horizon";
    s.scene.nodes[0].translation = {0, -1, 30};
    EXPECT_EQ(behind(s.scene), 0u) << "all of it behind";
}

TEST(PassSchedule, DegenerateFaceIsNone) {
    test::SpecularScene s;
    s.face("flat", {}, {0, 0, 0}, 0, {0, 1, 0}, {1, 0, 1});
    EXPECT_EQ(scheduleOf(s.scene).faces.size(), 0u);
}

TEST(PassSchedule, AMirrorThatSeesOnlyItself) {
    test::SpecularScene s;
    s.face("mirror", {}, {0, 0, 0});
    EXPECT_EQ(behind(s.scene), 1u) << "its image is empty but for the background";
}

TEST(PassSchedule, MirrorsThatDoNotSeeEachOtherAreLeftOut) {
    test::SpecularScene s;
    s.face("left", {}, {-0.5, 0, 0}, 0, {0, 1, 0}, Vec3(0.4));
    s.face("right", {}, {0.5, 0, 0}, 0, {0, 1, 0}, Vec3(0.4));
    const PassSchedule schedule = scheduleOf(s.scene);
    EXPECT_EQ(schedule.views.size(), 3u);
    EXPECT_EQ(schedule.unseen, 2u);
}

TEST(PassSchedule, PanesReflectAndRefract) {
    const PassSchedule partial = scheduleOf(test::paneScene(1.5, true));
    ASSERT_EQ(partial.views.size(), 3u);
    EXPECT_EQ(partial.views[1].bounce, Bounce::Refracted);
    EXPECT_EQ(partial.views[2].bounce, Bounce::Reflected);
    EXPECT_TRUE(partial.views[1].weighted && partial.views[2].weighted && partial.hasWeights);
    EXPECT_FALSE(partial.views[1].adds);
    EXPECT_TRUE(partial.views[2].adds);
    EXPECT_EQ(countsOf(partial)[PassKind::Weight], 2);
    expectCountsReturn(partial);
    EXPECT_EQ(scheduleOf(test::paneScene(1.5, false)).views.size(), 2u) << "all or nothing";
    EXPECT_EQ(scheduleOf(test::paneScene(1, true)).views.size(), 2u) << "no interface";
    EXPECT_FALSE(scheduleOf(test::paneScene(1, true)).hasWeights);
}

TEST(PassSchedule, FrostedPanesAreDrawnManyTimes) {
    SceneDescription scene = test::paneScene(1.5, false);
    scene.materials[0].specular->spread = 0.1;
    SpecularOptions options;
    options.shears = 5;
    const PassSchedule schedule = scheduleOf(scene, options);
    ASSERT_EQ(schedule.views.size(), 6u);
    Rgb sum(0);
    for (std::size_t i = 1; i < 6; ++i) {
        sum += schedule.views[i].light.factor;
        EXPECT_EQ(schedule.views[i].adds, i > 1);
        EXPECT_EQ(schedule.views[i].shear, static_cast<int>(i) - 1);
    }
    EXPECT_NEAR(sum.r, 1, 1e-12);
    // A second frosted pane splits no further.
    test::SpecularScene s;
    s.scene = scene;
    s.face("second", *scene.materials[0].specular, {0, 0, -0.5});
    EXPECT_EQ(scheduleOf(s.scene, options).views.size(), 1 + 2 * 5 + 5u) << "each alone, and one through the other";
}

// PR94: past the critical angle the face is wholly reflective.
TEST(PassSchedule, PastTheCriticalAngleAllIsReflected) {
    SceneDescription scene = test::paneScene(1 / 1.5, false, 1.2);  // from glass to air, 69 degrees
    const PassSchedule paper = scheduleOf(scene);
    ASSERT_EQ(paper.views.size(), 2u);
    EXPECT_EQ(paper.views[1].bounce, Bounce::Reflected);
    EXPECT_FALSE(paper.hasWeights);
}

TEST(PassSchedule, BallsThatAViewCannotSeeAreKnown) {
    test::SpecularScene s;
    s.face("mirror", {}, {0, 0, 0}, 0, {0, 1, 0}, Vec3(0.2));
    const PassSchedule schedule = scheduleOf(s.scene);
    const ScheduledView &camera = schedule.views[0], &mirror = schedule.views[1];
    EXPECT_TRUE(maySee(camera, 128, 128, {0, 0, 0}, 0.1));
    EXPECT_FALSE(maySee(camera, 128, 128, {3, 0, 0}, 0.1));
    EXPECT_TRUE(maySee(camera, 128, 128, {3, 0, 0}, 2.5)) << "large enough";
    EXPECT_TRUE(maySee(mirror, 128, 128, {0, 0, 1}, 0.1));
    EXPECT_FALSE(maySee(mirror, 128, 128, {0, 0, -1}, 0.1)) << "behind the mirror";
    EXPECT_FALSE(maySee(mirror, 128, 128, {0.7, 0, 1}, 0.1)) << "beside what is seen in it";
    EXPECT_NEAR(nearestDepth(camera.view, {0, 0, 0}, 0.5), 2.5, 1e-12);
    EXPECT_NEAR(nearestDepth(mirror.view, {0, 0, 1}, 0.5), 3.5, 1e-12) << "along the path";
}

TEST(SpecularFaces, MustBePlanar) {
    test::SpecularScene s;
    s.face("mirror", {}, {0, 0, 0});
    EXPECT_NO_THROW(checkSpecular(s.scene));
    s.scene.nodes[0].mesh = 1;
    try {
        checkSpecular(s.scene);
        FAIL() << "expected an error";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("node 'mirror': expected a planar mesh"));
    }
}

TEST(SpecularFaces, FrontIsWhereTrianglesAreCounterClockwise) {
    test::SpecularScene s;
    s.face("mirror", {}, {0, 0, 1}, 0.3);
    s.face("mirrored", {}, {0, 0, 1}, 0.3, {0, 1, 0}, {1, 1, -1});
    const auto faces = specularFaces(s.scene, nodeTransforms(s.scene, 0));
    ASSERT_EQ(faces.size(), 2u);
    EXPECT_GT(faces[0].plane.z, 0);
    EXPECT_EQ(faces[0].outline.size(), 4u);
    EXPECT_NEAR(glm::dot(faces[0].plane, Vec4(0, 0, 1, 1)), 0, 1e-12);
    const Vec3 n = glm::cross(faces[0].outline[1] - faces[0].outline[0], faces[0].outline[2] - faces[0].outline[1]);
    EXPECT_GT(glm::dot(n, Vec3(faces[0].plane)), 0);
    const Mesh moved = transformed(s.scene.meshes[0].mesh, nodeTransforms(s.scene, 0)[1]);
    EXPECT_LT(glm::length(Vec3(faces[1].plane) - Vec3(moved.normals[0])), 1e-6);
}

/// What is left out are a view and all that is seen in it; others keep their passes.
TEST(PassSchedule, HiddenViewsTakeWhatIsSeenInThemAlong) {
    test::SpecularScene s;
    s.face("far", {}, {0, 0, -3}, 0, {0, 1, 0}, Vec3(4));
    s.face("near", {}, {0, 0, 4}, kPi, {0, 1, 0}, Vec3(4));
    SpecularOptions options;
    options.depth = 5;
    const PassSchedule all = scheduleOf(s.scene, options);
    EXPECT_EQ(pathOf(all, 3), (std::vector<int>{0, 2, 0})) << "far, near, far";
    EXPECT_EQ(pathText(all, {"far", "near"}, {0, 3}), "camera > far reflects > near refracts");
    options.hidden = {{0, 2, 0}};
    const PassSchedule some = scheduleOf(s.scene, options);
    EXPECT_EQ(some.views.size(), 3u);
    expectCountsReturn(some);
    options.hidden = {{0}};
    EXPECT_EQ(scheduleOf(s.scene, options).passes.size(), 1u);
    options.hidden = {{2}, {1}};
    EXPECT_EQ(scheduleOf(s.scene, options).passes.size(), all.passes.size()) << "no such views";
}

TEST(PassSchedule, WithoutPartialLightGlassOnlyRefracts) {
    const SceneDescription scene = test::paneScene(1.5, true, 0.3);
    SpecularOptions options;
    EXPECT_EQ(scheduleOf(scene, options).views.size(), 3u);
    options.partial = false;
    const PassSchedule less = scheduleOf(scene, options);
    ASSERT_EQ(less.views.size(), 2u);
    EXPECT_EQ(less.views[1].bounce, Bounce::Refracted);
}

}  // namespace
}  // namespace nacre
