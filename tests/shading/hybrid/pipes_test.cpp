// Several pipes draw what one does; those that die or are late are left out, and the frame says so.
#include <gmock/gmock.h>

#include <atomic>
#include <thread>

#include "../gpu_evaluate.hpp"
#include "core/error.hpp"
#include "core/light_area.hpp"
#include "hybrid_fixture.hpp"
#include "shading/hybrid/hybrid_renderer.hpp"
#include "shading/primitives.hpp"

namespace nacre {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr int kSize = 48;
constexpr float kOrder = 2e-6f;  // of the brightest: sums in another order

/// A ball between a floor, a wall and a square lamp; a second lamp, and a third without shadow.
SceneDescription room() {
    SceneDescription scene = test::emptyRoom();
    scene.materials[0].ambient = Rgb(0.01);
    test::addSquare(scene, 2, {0, 0, 0}, {0, 1, 0});
    test::addSquare(scene, 2, {0, 1, -2}, {0, 0, 1});
    scene.meshes.push_back({"ball", makeSphere(0.4f, 24, 12)});
    SceneNode& ball = scene.nodes.emplace_back();
    ball.mesh = static_cast<int>(scene.meshes.size()) - 1, ball.material = 0;
    ball.translation = {0, 0.7, 0};
    test::addLight(scene, {false, {0.5, 2.5, 0.5}, Rgb(3), {}});
    scene.lights.back().area = LightArea{{0.3, 0, 0}, {0, 0, 0.3}};
    test::addLight(scene, {false, {-1, 1.5, 1}, Rgb(1, 0.5, 0.2), {}});
    test::addLight(scene, {false, {1, 1, 1}, Rgb(0.2), {}}, false);
    scene.camera.eye = {1.5, 2, 3};
    scene.camera.target = {0, 0.5, 0};
    return scene;
}

struct Setting {
    int pipes = 2;
    CrewOptions crew{};
    SoftShadows soft = SoftShadows::Regenerated;
    int lightPoints = 5;
    HybridOptions options{VirtualLightOptions{.count = 12, .shadows = true, .elements = {512}}};
    /// Called by each pipe but the first before its part of a frame, counted from 1.
    std::function<void(int pipe, int frame)> before{};
    std::function<std::unique_ptr<PipeLink>(std::unique_ptr<PipeLink>)> wrap{};
};

void prepare(HybridRenderer& renderer, const Setting& s) {
    renderer.direct().switches.shadowMethod = ShadowMethod::Volumes;
    renderer.direct().switches.softShadows = s.soft;
    renderer.direct().switches.lightPoints = s.lightPoints;
}

void runPipe(std::unique_ptr<PipeLink> link, const SceneDescription& scene, const Setting& s) {
    const Context context;
    ProgramLoader loader;
    HybridRenderer renderer(loader, scene, test::materialsOf(scene));
    prepare(renderer, s);
    PipeCrew crew(*link, s.crew);
    for (int frame = 1; const auto time = crew.await(); ++frame) {
        if (s.before) s.before(link->self(), frame);
        renderer.drawShare(kSize, kSize, s.options, *time, crew);
    }
}

/// Pipes as threads, for as long as this lives. The first is the test's own thread.
class Pipes {
public:
    Pipes(const SceneDescription& scene, const Setting& s) : setting_(s) {
        test::context().makeCurrent();
        std::vector<std::vector<int>> sockets = connectedSockets(s.pipes);
        link_ = std::make_unique<SocketLink>(0, std::move(sockets[0]));
        for (int i = 1; i < s.pipes; ++i) {
            std::unique_ptr<PipeLink> link =
                std::make_unique<SocketLink>(i, std::move(sockets[static_cast<std::size_t>(i)]));
            if (s.wrap) link = s.wrap(std::move(link));
            threads_.emplace_back([&scene, &s, link = std::move(link)]() mutable {
                try {
                    runPipe(std::move(link), scene, s);
                } catch (const std::exception&) {  // its end of the ways has gone with it
                }
            });
        }
        renderer_.emplace(loader_, scene, test::materialsOf(scene));
        prepare(*renderer_, s);
        crew_.emplace(*link_, s.crew);
    }
    ~Pipes() {
        crew_.reset();
        link_.reset();
        for (std::thread& thread : threads_) thread.join();
    }
    std::future<HybridFrame> start() {
        crew_->begin(0);
        return renderer_->start(kSize, kSize, setting_.options, 0, *crew_);
    }
    HybridFrame frame() { return start().get(); }
    PipeCrew& crew() { return *crew_; }

private:
    const Setting& setting_;
    ProgramLoader loader_;
    std::unique_ptr<PipeLink> link_;
    std::vector<std::thread> threads_;
    std::optional<HybridRenderer> renderer_;
    std::optional<PipeCrew> crew_;
};

HybridPicture drawnByOne(const SceneDescription& scene, const Setting& s, const std::vector<DrawShare>& shares = {{}}) {
    test::context().makeCurrent();
    ProgramLoader loader;
    HybridRenderer renderer(loader, scene, test::materialsOf(scene));
    prepare(renderer, s);
    HybridPicture out = renderer.draw(kSize, kSize, s.options);
    if (shares.size() == 1 && shares[0].end == 1) return out;
    std::fill(out.direct.data().begin(), out.direct.data().end(), 0.0f);
    const RenderTarget target({.width = kSize, .height = kSize});
    for (const DrawShare& share : shares) {
        renderer.direct().switches.share = share;
        renderer.direct().render(target);
        const Image part = target.read();
        for (std::size_t i = 0; i < part.data().size(); ++i) out.direct.data()[i] += part.data()[i];
    }
    return out;
}

float brightest(const Image& image) { return *std::max_element(image.data().begin(), image.data().end()); }

float difference(const Image& a, const Image& b) {
    EXPECT_EQ(a.data().size(), b.data().size());
    float out = 0;
    for (std::size_t i = 0; i < a.data().size(); ++i) out = std::max(out, std::abs(a.data()[i] - b.data()[i]));
    return out / std::max(brightest(b), 1e-20f);
}

void expectSame(const HybridPicture& a, const HybridPicture& b, const std::string& where) {
    EXPECT_LT(difference(a.direct, b.direct), kOrder) << where;
    EXPECT_LT(difference(a.indirect, b.indirect), kOrder) << where;
    EXPECT_LT(difference(a.blended, b.blended), kOrder) << where;
}

TEST(Pipes, AnyNumberDrawsThePictureOfOne) {
    const SceneDescription scene = room();
    const HybridPicture one = drawnByOne(scene, {});
    EXPECT_GT(brightest(one.direct), 0.1);
    EXPECT_GT(brightest(one.indirect), 0.01);
    for (const Compositing how : {Compositing::BinarySwap, Compositing::Software})
        for (const int count : {1, 2, 3, 4, 5}) {
            Setting s;
            s.pipes = count, s.crew.compositing = how;
            Pipes pipes(scene, s);
            for (int frame = 0; frame < 2; ++frame) {
                const HybridFrame out = pipes.frame();
                expectSame(out.picture, one, std::to_string(count));
                EXPECT_EQ(out.report.pipes.size(), static_cast<std::size_t>(count));
                EXPECT_GT(*std::min_element(out.report.pipes.begin(), out.report.pipes.end()), 0);
            }
            EXPECT_THAT(pipes.crew().takeNotes(), ElementsAre());
        }
}

TEST(Pipes, MorePipesThanSamples) {
    const SceneDescription scene = room();
    Setting s;
    s.pipes = 7, s.lightPoints = 1;
    s.options.virtualLights->count = 2;
    Pipes pipes(scene, s);
    expectSame(pipes.frame().picture, drawnByOne(scene, s), "3 points, 2 virtual lights");
}

TEST(Pipes, AnEmptyRoomIsBlack) {
    SceneDescription scene = test::emptyRoom();
    test::addLight(scene, {false, {0, 0, 1}, Rgb(1), {}});
    for (const Compositing how : {Compositing::BinarySwap, Compositing::Software}) {
        Setting s;
        s.crew.compositing = how;
        Pipes pipes(scene, s);
        EXPECT_EQ(brightest(pipes.frame().picture.blended), 0);
    }
}

TEST(Pipes, LampsThatAreDimmedByLevelsStayWhole) {
    const SceneDescription scene = room();
    Setting s;
    s.soft = SoftShadows::Levels;
    s.pipes = 3;
    Pipes pipes(scene, s);
    expectSame(pipes.frame().picture, drawnByOne(scene, s), "levels");
}

TEST(Pipes, ShadowMapsAreTheFirstPipes) {
    const SceneDescription scene = room();
    test::context();
    ProgramLoader loader;
    SceneRenderer renderer(loader, scene);
    const RenderTarget target({.width = kSize, .height = kSize});
    renderer.switches.share = DrawShare::equal(1, 2);
    renderer.render(target);
    EXPECT_EQ(brightest(target.read()), 0);
}

/// The frame lacks what the third of three pipes would have drawn, the next one is whole again.
void expectLeftOut(Pipes& pipes, const SceneDescription& scene, const Setting& s, const std::string& doing) {
    const HybridPicture one = drawnByOne(scene, s);
    expectSame(pipes.frame().picture, one, "before");
    EXPECT_THAT(pipes.crew().takeNotes(), ElementsAre());
    const HybridFrame lacking = pipes.frame();
    const std::vector<DrawShare> shares{pipes.crew().share(0), pipes.crew().share(1)};
    EXPECT_THAT(pipes.crew().takeNotes(), ElementsAre(HasSubstr(doing)));
    EXPECT_LT(lacking.report.pipes[2], 0);
    EXPECT_GT(lacking.report.pipes[1], 0);
    EXPECT_LT(difference(lacking.picture.direct, drawnByOne(scene, s, shares).direct), kOrder);
    EXPECT_GT(difference(lacking.picture.direct, one.direct), 0.01);
    EXPECT_EQ(pipes.crew().present(), 2);
    expectSame(pipes.frame().picture, one, "after");
    EXPECT_THAT(pipes.crew().takeNotes(), ElementsAre());
}

TEST(Pipes, OneThatDiesIsLeftOut) {
    const SceneDescription scene = room();
    for (const Compositing how : {Compositing::BinarySwap, Compositing::Software}) {
        Setting s;
        s.pipes = 3, s.crew.compositing = how;
        s.before = [](int pipe, int frame) {
            if (pipe == 2 && frame == 2) throw Error("dies");
        };
        Pipes pipes(scene, s);
        expectLeftOut(pipes, scene, s, "pipe 2 of 3 is gone or later than 30 s");
    }
}

TEST(Pipes, OneThatAnswersLateIsLeftOut) {
    const SceneDescription scene = room();
    for (const Compositing how : {Compositing::BinarySwap, Compositing::Software}) {
        Setting s;
        s.pipes = 3, s.crew.compositing = how, s.crew.patience = 4;  // slow under sanitizers
        std::atomic<bool> goOn = false;
        s.before = [&goOn](int pipe, int frame) {
            while (pipe == 2 && frame == 2 && !goOn) std::this_thread::sleep_for(std::chrono::milliseconds(10));
        };
        Pipes pipes(scene, s);
        expectLeftOut(pipes, scene, s, "later than 4 s");
        goOn = true;
    }
}

/// Breaks off at a pipe's n-th exchange of images.
class Breaking final : public PipeLink {
public:
    Breaking(std::unique_ptr<PipeLink> link, int left) : link_(std::move(link)), left_(left) {}
    int self() const override { return link_->self(); }
    int count() const override { return link_->count(); }
    bool exchange(int peer, PipeWay way, std::span<const std::byte> out, std::span<std::byte> in,
                  PipeClock::time_point deadline) override {
        if (way == PipeWay::Image && self() == 2 && left_-- == 0) throw Error("dies");
        return link_->exchange(peer, way, out, in, deadline);
    }

private:
    std::unique_ptr<PipeLink> link_;
    int left_;
};

TEST(Pipes, OneThatDiesWhileImagesArePutTogetherHasTheRestDrawAgain) {
    const SceneDescription scene = room();
    const HybridPicture one = drawnByOne(scene, {});
    // Of three pipes the last gives its image away, of four it swaps twice and then gives rows: before each of these.
    for (const auto& [count, exchanges] : {std::pair{3, std::vector{2}}, {4, std::vector{2, 3, 4, 5}}})
        for (const int exchange : exchanges) {
            Setting s;
            s.pipes = count;
            s.wrap = [exchange](std::unique_ptr<PipeLink> link) {
                return std::make_unique<Breaking>(std::move(link), exchange);
            };
            Pipes pipes(scene, s);
            const std::string where = std::to_string(count) + " pipes, exchange " + std::to_string(exchange);
            expectSame(pipes.frame().picture, one, where);
            EXPECT_THAT(pipes.crew().takeNotes(), ElementsAre(HasSubstr("drawn again"))) << where;
            EXPECT_EQ(pipes.crew().present(), count - 1) << where;
            expectSame(pipes.frame().picture, one, where);
        }
}

TEST(Pipes, AFrameOfLatencyIsTheSameFrame) {
    const SceneDescription scene = room();
    Setting s;
    s.crew.compositing = Compositing::Software;
    const HybridPicture one = drawnByOne(scene, s);
    Pipes pipes(scene, s);
    std::future<HybridFrame> before = pipes.start();
    for (int frame = 0; frame < 3; ++frame) {
        std::future<HybridFrame> next = pipes.start();
        expectSame(before.get().picture, one, "late");
        before = std::move(next);
    }
    before.get();
}

TEST(Pipes, SharesTakeEachThingOnceAndAreEven) {
    for (const int parts : {1, 2, 3, 5, 8})
        for (const std::size_t things : {4u, 16u, 64u}) {
            std::vector<int> taken(things, 0);
            for (int part = 0; part < parts; ++part) {
                int own = 0;
                for (std::size_t i = 0; i < things; ++i) {
                    const bool takes = DrawShare::equal(part, parts).takes(i);
                    taken[i] += takes, own += takes;
                }
                EXPECT_NEAR(own, double(things) / parts, 1.5) << things << " among " << parts;
            }
            EXPECT_THAT(taken, testing::Each(1));
        }
}

/// Takes its time before a pipe tells what it found.
class Slow final : public PipeLink {
public:
    explicit Slow(std::unique_ptr<PipeLink> link) : link_(std::move(link)) {}
    int self() const override { return link_->self(); }
    int count() const override { return link_->count(); }
    bool exchange(int peer, PipeWay way, std::span<const std::byte> out, std::span<std::byte> in,
                  PipeClock::time_point deadline) override {
        if (way == PipeWay::Order && in.size() == sizeof(std::uint64_t))  // how many virtual lights there are
            std::this_thread::sleep_for(std::chrono::milliseconds(300));
        return link_->exchange(peer, way, out, in, deadline);
    }

private:
    std::unique_ptr<PipeLink> link_;
};

TEST(Pipes, ASlowOneGetsLess) {
    const SceneDescription scene = room();
    const HybridPicture one = drawnByOne(scene, {});
    for (const Compositing how : {Compositing::BinarySwap, Compositing::Software}) {
        Setting s;
        s.crew.compositing = how;
        s.wrap = [](std::unique_ptr<PipeLink> link) { return std::make_unique<Slow>(std::move(link)); };
        Pipes pipes(scene, s);
        const auto itsPart = [&] { return pipes.crew().share(1).end - pipes.crew().share(1).begin; };
        for (int frame = 0; frame < 20 && itsPart() >= 0.4; ++frame)  // the first ones compile programs
            expectSame(pipes.frame().picture, one, "shares move");
        EXPECT_LT(itsPart(), 0.4);
        EXPECT_EQ(pipes.crew().share(1).end, 1);
    }
}

TEST(Pipes, RowsAfterTheSwapCoverEachOnce) {
    for (const int height : {1, 2, 7, 48})
        for (const int count : {1, 2, 4, 8}) {
            std::vector<int> covered(static_cast<std::size_t>(height), 0);
            for (int i = 0; i < count; ++i) {
                const ImageRows rows = rowsAfterSwap(height, i, count);
                for (int y = rows.first; y < rows.first + rows.count; ++y) ++covered[static_cast<std::size_t>(y)];
            }
            EXPECT_THAT(covered, testing::Each(1));
        }
}

TEST(Pipes, RefuseWhatTheyCantBe) {
    SocketLink alone(0, {-1, -1});
    EXPECT_THROW(PipeCrew(alone, {.patience = 0}), std::invalid_argument);
    EXPECT_THROW(SocketLink(2, {-1, -1}), std::invalid_argument);
    EXPECT_THROW(alone.exchange(0, PipeWay::Order, {}, {}, PipeClock::now()), std::invalid_argument);
}

TEST(HybridRenderer, PointsOfALampInsideAnObjectLightNothingOutside) {
    // Half of the lamp is inside a closed body: the floor has the light of the other half alone.
    SceneDescription scene = test::emptyRoom();
    test::addSquare(scene, 2, {0, 0, 0}, {0, 1, 0});
    scene.meshes.push_back({"body", makeSphere(0.3f, 24, 12)});
    SceneNode& body = scene.nodes.emplace_back();
    body.mesh = 1, body.material = 0;
    body.translation = {0.5, 1.5, 0};
    test::addLight(scene, {false, {0, 1.5, 0}, Rgb(1), {}});
    scene.lights.back().area = LightArea{{0.5, 0, 0}, {0, 0, 0.0}};
    scene.camera.eye = {-1.5, 1, 0};
    scene.camera.target = {-1.5, 0, 0};
    scene.camera.up = {0, 0, 1};
    scene.camera.fovY = 0.2;
    Setting s;
    s.lightPoints = 16;
    s.options.virtualLights.reset();
    const Image drawn = drawnByOne(scene, s).direct;
    double expected = 0;
    int inside = 0;
    for (const Light& p : pointsOfArea(scene.lights[0].light, *scene.lights[0].area, 16)) {
        const Vec3 to = p.position - Vec3(-1.5, 0, 0), fromBody = p.position - body.translation;
        // A ray from the floor's left side meets the body only on the way to what is in it or behind it.
        const double along = glm::dot(body.translation - Vec3(-1.5, 0, 0), glm::normalize(to));
        const double off = glm::length(body.translation - Vec3(-1.5, 0, 0) - along * glm::normalize(to));
        inside += glm::length(fromBody) < 0.3;
        if (glm::length(fromBody) < 0.3 || (off < 0.3 && along < glm::length(to))) continue;
        expected += 0.5 / kPi * p.color.r * to.y / std::pow(glm::length(to), 3);
    }
    EXPECT_GE(inside, 3);
    const float middle = drawn.at(kSize / 2, kSize / 2, 0);
    EXPECT_NEAR(middle, expected, 0.01 * expected);
}

}  // namespace
}  // namespace nacre
