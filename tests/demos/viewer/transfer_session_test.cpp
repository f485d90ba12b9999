// Moving meshes in the viewer: what a session shows, and the window moved by real events.
#include "demos/viewer/transfer_session.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/error.hpp"
#include "core/file.hpp"
#include "demos/viewer/orbit.hpp"
#include "shading/context.hpp"
#include "tests/demos/viewer/display.hpp"
#include "transfer/cloth.hpp"

namespace nacre {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using tests::Display;
using tests::Scratch;
using tests::Viewer;

/// Five frames of the cloth.
std::string writeCloth(const Scratch& scratch) {
    LiveTransfer live(clothAnimation({.clothVertices = 17, .floorVertices = 9, .frames = 5}), "cloth");
    TransferRecording r;
    r.weldOf = live.transfer().mesh().weldOf;
    r.triangles = live.transfer().mesh().triangles;
    for (int f = 0; f < 5; ++f) {
        live.show(static_cast<std::size_t>(f), std::nullopt);
        r.blocks.push_back({live.positions(), live.coefficients()});
        r.frames.push_back({f, f});
    }
    writeTransfer(r, scratch / "cloth.tv");
    return (scratch / "cloth.tv").string();
}

TEST(TransferSession, DrawsOnlyWhatChanged) {
    const Scratch scratch;
    const Context context;
    TransferSession session({writeCloth(scratch)});
    EXPECT_TRUE(session.playing);
    session.playing = false;
    EXPECT_FALSE(session.draw()) << "it has no size yet";
    session.resize(64, 48);
    EXPECT_TRUE(session.draw());
    EXPECT_FALSE(session.draw());
    session.turnLight(0.5);
    EXPECT_TRUE(session.draw());
    session.light.weights[0] = 0.5;
    EXPECT_TRUE(session.draw());
    session.step(1);
    EXPECT_TRUE(session.draw());
    session.seek(session.time + 0.001);
    EXPECT_FALSE(session.draw()) << "still the same frame";
    session.move(orbited(session.camera, {5, 0}, 48));
    EXPECT_TRUE(session.draw());
    EXPECT_EQ(session.pictures(), 5);
    EXPECT_EQ(session.problem(), "");
    EXPECT_EQ(session.verticesPerSecond(), 0) << "nothing is computed from a file";
}

TEST(TransferSession, PlaysTurnsAndSteps) {
    const Scratch scratch;
    const Context context;
    TransferSession session({writeCloth(scratch)});
    session.turnSpeed = 2;
    session.advance(0.1);
    EXPECT_EQ(session.frame(), 3u);
    EXPECT_NEAR(session.light.turn, 0.2, 1e-12);
    session.advance(2.9);
    EXPECT_NEAR(session.light.turn, 6 - 2 * kPi, 1e-12);
    session.seek(0);
    session.step(-1);
    EXPECT_EQ(session.frame(), 4u);
    EXPECT_FALSE(session.playing);
    session.step(2);
    EXPECT_EQ(session.frame(), 1u);
    session.advance(1);
    EXPECT_EQ(session.frame(), 1u) << "it stands";
}

TEST(TransferSession, LiveComputesWhatFacesTheViewerOnce) {
    const Context context;
    TransferSession session({"chess", true});
    session.playing = false;
    session.resize(64, 48);
    session.draw();
    const std::size_t seen = session.player().cost().computed;
    EXPECT_GT(seen, 300u);
    EXPECT_LT(seen, session.player().vertexCount());
    EXPECT_GT(session.verticesPerSecond(), 0);
    session.turnLight(1);
    EXPECT_TRUE(session.draw());
    EXPECT_EQ(session.player().cost().computed, 0u) << "light alone changes no transfer";
}

TEST(TransferSession, SaysWhatCannotBeRead) {
    const Scratch scratch;
    const Context context;
    writeFile(scratch / "short.tv", "NACRE_TV");
    EXPECT_THROW(TransferSession({(scratch / "short.tv").string()}), Error);
    EXPECT_THROW(TransferSession({"no such mesh", true}), Error);
    EXPECT_THROW(TransferSession({writeCloth(scratch), false, {"none.hdr"}}), Error);
}

TEST(ViewerTransfer, AControlDragTurnsTheLightAndTheFramesPlay) {
    const Scratch scratch;
    const Display display;
    Viewer viewer(display, {writeCloth(scratch), "--size", "200x150", "--no-panel", "--white", "1"});
    viewer.until([](const json& line) { return line["shown"] == 3; });
    display.send({"key", "space"});
    const json first = viewer.until([](const json& line) { return !line["playing"] && line["settled"]; });
    const int left = first["window"][0], top = first["window"][1];
    const auto at = [&](int x, int y) {
        return std::vector<std::string>{"mousemove", std::to_string(left + x), std::to_string(top + y)};
    };
    display.send(at(60, 70));
    display.send({"keydown", "ctrl"});
    display.send({"mousedown", "1"});
    display.send(at(90, 70));
    display.send({"mouseup", "1"});
    display.send({"keyup", "ctrl"});
    const json turned =
        viewer.until([](const json& line) { return std::abs(line["turn"].get<double>() - kPi * 30 / 150) < 1e-9; });
    EXPECT_EQ(turned["camera"], first["camera"]);
    EXPECT_EQ(turned["shown"], first["shown"]);
    display.send({"key", "Right"});
    const int next = (first["shown"].get<int>() + 1) % 5;
    viewer.until([&](const json& line) { return line["shown"] == next; });
    display.send({"key", "Tab"});
    viewer.until([](const json& line) { return line["origin"] > 0 && line["settled"]; });
    display.send({"key", "Escape"});
    EXPECT_EQ(viewer.code(), 0);
}

TEST(ViewerTransfer, WrongUsageIsSaidInOneLine) {
    const Scratch scratch;
    writeFile(scratch / "scene.json", "{}");
    const auto outcome = [](std::vector<std::string> words) {
        words.insert(words.begin(), NACRE_VIEW);
        tests::Child viewer(words, 2, {"DISPLAY=", "WAYLAND_DISPLAY="});
        const std::string line = viewer.line();
        return fmt::format("{} {}{}", viewer.code(), line, viewer.line());
    };
    EXPECT_THAT(outcome({(scratch / "scene.json").string(), "--env", "a.hdr"}),
                HasSubstr("2 nacre view: --env: expected a file that nacre transfer wrote"));
    EXPECT_THAT(outcome({writeCloth(scratch), "--transfer"}),
                HasSubstr("2 nacre view: --transfer: expected a mesh, found the transfer file"));
}

}  // namespace
}  // namespace nacre
