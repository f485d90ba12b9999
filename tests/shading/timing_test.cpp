#include "shading/timing.hpp"

#include <gtest/gtest.h>

#include "gpu_evaluate.hpp"
#include "shading/draw.hpp"
#include "shading/render_target.hpp"

namespace nacre {
namespace {

// A shader with 200 times the work takes longer by both clocks; the frames take turns.
TEST(Timing, MoreWorkTakesLonger) {
    test::context();
    const ProgramLoader loader;
    const auto compile = [&](int steps) {
        return loader.compile("fullscreen.vert.glsl",
                              {"work",
                               "out vec4 color;\nvoid main() {\n    vec2 z = gl_FragCoord.xy * 1e-3;\n"
                               "    for (int i = 0; i < STEPS; ++i) z = sin(z.yx + 1.0);\n"
                               "    color = vec4(z, 0.0, 1.0);\n}\n"},
                              {{"STEPS", std::to_string(steps)}});
    };
    const Program slight = compile(2), heavy = compile(400);
    const RenderTarget target({.width = 64, .height = 64, .depth = false});
    const VertexArray empty;
    std::string order;
    const auto frame = [&](const Program& program, char name) {
        return std::function<void()>([&, name] {
            target.bind();
            program.use();
            drawFullscreen(empty);
            if (order.empty() || order.back() != name) order += name;
        });
    };
    const std::function<void()> frames[] = {frame(slight, 's'), frame(heavy, 'h')};
    for (FrameClock clock : {FrameClock::Wall, FrameClock::Gpu}) {
        SCOPED_TRACE(clock == FrameClock::Wall ? "wall" : "gpu");
        order.clear();
        const auto seconds = medianFrameSeconds(frames, {.repeats = 7, .least = 0.0005, .clock = clock});
        ASSERT_EQ(seconds.size(), 2u);
        EXPECT_GT(seconds[0], 0);
        EXPECT_GT(seconds[1], seconds[0]);     // no factor: the machine may be busy with other work
        EXPECT_EQ(order, "shshshshshshshsh");  // once to warm up, seven times measured
    }
}

TEST(Timing, RejectsNothingToMeasure) {
    const std::function<void()> frames[] = {std::function<void()>()};
    EXPECT_THROW(medianFrameSeconds(frames), std::invalid_argument);
    EXPECT_THROW(medianFrameSeconds({}, {.repeats = 0}), std::invalid_argument);
    EXPECT_TRUE(medianFrameSeconds({}).empty());
}

}  // namespace
}  // namespace nacre
