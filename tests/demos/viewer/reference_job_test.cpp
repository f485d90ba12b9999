// The reference's thread: means of passes, failures, and ends that come when they are asked for.
#include "demos/viewer/reference_job.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "core/error.hpp"
#include "factorize/models/models.hpp"
#include "reference/raytrace.hpp"
#include "shading/primitives.hpp"

namespace nacre {
namespace {

ReferenceView smallView() {
    ReferenceView view;
    view.width = view.height = 4;
    return view;
}

void waitFor(const ReferenceJob& job) {
    while (!job.state().done) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

Image constant(float value) {
    Image out(4, 4, 3);
    for (float& v : out.data()) v = value;
    return out;
}

TEST(ReferenceJob, IsTheMeanOfItsPasses) {
    std::atomic<int> woken = 0;
    const ReferenceJob job(
        [](const ReferenceView&, int pass, const auto&) { return constant(static_cast<float>(pass)); }, smallView(), 5,
        [&] { ++woken; });
    waitFor(job);
    EXPECT_EQ(job.state().passes, 5);
    EXPECT_EQ(job.state().problem, "");
    EXPECT_FLOAT_EQ(job.mean().at(1, 2, 0), 2);
    while (woken < 6) std::this_thread::yield();  // once a pass, and at the end
}

TEST(ReferenceJob, AFailureIsAProblem) {
    const ReferenceJob job([](const auto&, int, const auto&) -> Image { throw Error("no truth"); }, smallView(), 5,
                           [] {});
    waitFor(job);
    EXPECT_EQ(job.state().problem, "no truth");
    EXPECT_TRUE(job.mean().empty());
}

TEST(ReferenceJob, StopsWithinAPass) {
    ReferenceJob job(
        [](const auto&, int, const std::function<bool()>& stopped) {
            while (!stopped()) std::this_thread::yield();
            return constant(1);
        },
        smallView(), 1000, [] {});
    job.stop();
    waitFor(job);
    EXPECT_EQ(job.state().passes, 0);
    EXPECT_EQ(job.state().problem, "");
}

TEST(SceneTracer, TracesTheSceneAndKnowsItsVersion) {
    SceneDescription scene;
    scene.meshes = {{"torus", makeTorus()}};
    scene.materials.resize(1);
    scene.materials[0].model = "lambert:kd=0.5";
    scene.nodes.resize(1);
    scene.nodes[0].mesh = scene.nodes[0].material = 0;
    scene.lights.push_back({"sun", -1, Light{}, {}});
    ReferenceView view = smallView();
    view.scene = scene;
    view.width = view.height = 32;
    const ReferenceTracer tracer = sceneTracer(1);
    const auto goesOn = [] { return false; };
    const Image image = tracer(view, 0, goesOn);
    const auto truth = raytrace(scene.meshes[0].mesh, view.camera, {Light{}}, makeModel("lambert:kd=0.5").f,
                                {.width = 32, .height = 32, .supersample = 1});
    double largest = 0;
    for (int i = 0; i < 32 * 32; ++i)
        largest =
            std::max<double>(largest, std::abs(image.at(i % 32, i / 32, 0) - truth.radiance.at(i % 32, i / 32, 0)));
    EXPECT_LT(largest, 1e-4);
    view.scene.materials[0].model = "lambert:kd=0.25";
    EXPECT_EQ(tracer(view, 0, goesOn).at(16, 26, 0), image.at(16, 26, 0)) << "of the version that is known";
    view.materials = 1;
    EXPECT_NEAR(tracer(view, 0, goesOn).at(16, 26, 0), 0.5 * image.at(16, 26, 0), 1e-5);
    EXPECT_THROW(tracer(view, 0, [] { return true; }), Error);
}

/// A lamp behind a board, and a mirror: lit as deep as the picture is, whose default is the library's.
TEST(SceneTracer, FollowsLightAsDeepAsThePicture) {
    ReferenceView view = smallView();
    SceneDescription& scene = view.scene;
    scene.meshes = {{"square", makeQuad(2)}};
    scene.materials.resize(2);
    scene.materials[0].model = "lambert:kd=0.5";
    scene.materials[1].specular = SceneSpecular{};
    scene.nodes.resize(2);
    scene.nodes[0].mesh = scene.nodes[0].material = 0;
    scene.nodes[1].mesh = 0, scene.nodes[1].material = 1;
    scene.nodes[1].translation = {0, 0, 6};
    scene.nodes[1].rotation = glm::angleAxis(kPi, Vec3(0, 1, 0));
    SceneLight lamp;
    lamp.light = {false, {0, 0, 5}, Rgb(20), {}};
    lamp.shadow = SceneShadow{};
    scene.lights = {lamp};
    const ReferenceTracer tracer = sceneTracer(1);
    const auto goesOn = [] { return false; };
    const float sent = tracer(view, 0, goesOn).at(2, 2, 0);
    view.switches.specular.lightDepth = 0;
    EXPECT_GT(sent, 1.3f * tracer(view, 0, goesOn).at(2, 2, 0));
}

}  // namespace
}  // namespace nacre
