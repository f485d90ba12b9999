// Transfer vectors played: pictures against the sums in C++.
#include "shading/transfer_player.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "gpu_evaluate.hpp"
#include "transfer/cloth.hpp"

namespace nacre {
namespace {

constexpr int kSize = 64;

/// A square before the camera, order 1; frame 7 has V = y_00's part, frame 9 stands as 7 does, frame 10 has x's.
TransferRecording square() {
    TransferRecording r;
    r.order = 1;
    r.framesPerSecond = 10;
    r.weldOf = {0, 1, 2, 3};
    r.triangles = {{0, 1, 2}, {0, 2, 3}};
    for (const std::size_t c : {0, 3}) {  // y_11 is x
        TransferRecording::Block block{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, std::vector<float>(16, 0)};
        for (std::size_t v = 0; v < 4; ++v) block.coefficients[4 * v + c] = 0.5f;
        r.blocks.push_back(block);
    }
    r.frames = {{7, 0}, {9, 0}, {10, 1}};
    return r;
}

/// White of 2, and of 4 that leans to +z by 3.
PlayedLight twoLights(double a, double b, double turn = 0) {
    return {{{Rgb(2), Rgb(0), Rgb(0), Rgb(0)}, {Rgb(4), Rgb(0), Rgb(3), Rgb(0)}}, {a, b}, turn};
}

Image picture(TransferPlayer& player, std::size_t frame, const PlayedLight& light) {
    ProgramLoader loader;
    const RenderTarget target({.width = kSize, .height = kSize});
    target.clear();
    player.draw(loader, target, cameraAround(player.bounds(), 0, 0), frame, light);
    return target.read(4);
}

double middle(TransferPlayer& player, std::size_t frame, const PlayedLight& light) {
    return picture(player, frame, light).at(kSize / 2, kSize / 2, 1);
}

TEST(TransferPlayer, BlendsAndTurnsTheLight) {
    test::context();
    TransferPlayer player(square());
    EXPECT_DOUBLE_EQ(middle(player, 0, twoLights(1, 0)), 1);
    EXPECT_DOUBLE_EQ(middle(player, 1, twoLights(0.5, 0.25)), 1);
    EXPECT_DOUBLE_EQ(middle(player, 1, twoLights(0.5, 1)), 2.5);
    EXPECT_NEAR(middle(player, 2, twoLights(1, 1)), 0, 1e-6);  // the light leans to z, the transfer to x
    EXPECT_NEAR(middle(player, 2, twoLights(1, 1, kPi / 2)), 1.5, 1e-5);
    EXPECT_NEAR(middle(player, 2, twoLights(1, 1, -kPi / 2)), -1.5, 1e-5);
    EXPECT_NEAR(middle(player, 2, twoLights(1, 0.5, kPi / 6)), 0.375, 1e-5);
}

TEST(TransferPlayer, FramesRepeatAndKeepTheirNumbers) {
    test::context();
    const TransferPlayer player(square());
    EXPECT_EQ(player.frameCount(), 3u);
    EXPECT_EQ(player.frameNumber(1), 9);
    EXPECT_DOUBLE_EQ(player.duration(), 0.3);
    EXPECT_EQ(player.frameAt(0), 0u);
    EXPECT_EQ(player.frameAt(0.1), 1u);
    EXPECT_EQ(player.frameAt(0.29), 2u);
    EXPECT_EQ(player.frameAt(0.3), 0u);
    EXPECT_EQ(player.frameAt(-0.05), 2u);
    EXPECT_EQ(player.vertexCount(), 4u);
    EXPECT_EQ(player.order(), 1);
}

TEST(TransferPlayer, LiveIsTheRecordingWhereTheViewerLooks) {
    constexpr double kGroups =
        0.02;  // of white 1: which level stands for a blocker depends on who is computed together
    test::context();
    LiveTransfer live(clothAnimation({.frames = 12}), "cloth");
    TransferRecording recording;
    recording.weldOf = live.transfer().mesh().weldOf;
    recording.triangles = live.transfer().mesh().triangles;
    recording.blocks = {{live.frames()[11], live.transfer().compute(live.frames()[11]).coefficients}};
    recording.frames = {{11, 0}};
    TransferPlayer here(std::move(live)), file(std::move(recording));
    const PlayedLight light{{whiteLight(4)}, {1}};
    ProgramLoader loader;
    const Camera camera = cameraAround(here.bounds(), 0.4, 0.5);
    const auto draw = [&](TransferPlayer& player, std::size_t frame) {
        const RenderTarget target({.width = kSize, .height = kSize});
        target.clear();
        player.draw(loader, target, camera, frame, light);
        return target.read();
    };
    const Image a = draw(here, 11), b = draw(file, 0);
    EXPECT_GT(here.cost().computed, 500u);
    EXPECT_EQ(file.cost().computed, 0u);
    double worst = 0, most = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            worst = std::max(worst, maxComponent(glm::abs(a.rgb(x, y) - b.rgb(x, y))));
            most = std::max(most, maxComponent(b.rgb(x, y)));
        }
    EXPECT_LT(worst, kGroups);
    EXPECT_GT(most, 0.5);
    draw(here, 11);
    EXPECT_EQ(here.cost().computed, 0u) << "the same frame, seen from the same place";
}

TEST(TransferPlayer, RefusesFramesAndLightsThatAreNotThere) {
    test::context();
    TransferPlayer player(square());
    EXPECT_THROW(picture(player, 3, twoLights(1, 1)), std::invalid_argument);
    EXPECT_THROW(picture(player, 0, {{whiteLight(4)}, {1}}), std::invalid_argument);
    EXPECT_THROW(picture(player, 0, {}), std::invalid_argument);
    EXPECT_THROW(picture(player, 0, {{whiteLight(1)}, {1, 1}}), std::invalid_argument);
}

TEST(TransferPlayer, CameraAroundSeesTheBoxFromThere) {
    SceneBounds bounds;
    bounds.add({-1, 0, -1});
    bounds.add({1, 2, 1});
    const Camera standard = cameraSeeing(bounds), side = cameraAround(bounds, kPi / 2, 0);
    EXPECT_EQ(side.target, bounds.centre());
    EXPECT_NEAR(glm::length(side.eye - side.target), glm::length(standard.eye - standard.target), 1e-12);
    EXPECT_NEAR(glm::dot(glm::normalize(side.eye - side.target), Vec3(1, 0, 0)), 1, 1e-12);
    EXPECT_GT(side.near, 0);
}

}  // namespace
}  // namespace nacre
