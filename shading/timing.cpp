#include "shading/timing.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/error.hpp"
#include "shading/gl_objects.hpp"

namespace nacre {
namespace {

/// Each frame is flushed by itself: a tile renderer may drop a frame that the next one of the same batch covers.
void drawFrames(const std::function<void()>& frame, int count) {
    for (int i = 0; i < count; ++i) {
        frame();
        glFlush();
    }
}

double wallSeconds(const std::function<void()>& frame, int count) {
    glFinish();
    const auto start = std::chrono::steady_clock::now();
    drawFrames(frame, count);
    glFinish();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / count;
}

double querySeconds(const std::function<void()>& frame, int count) {
    const Query query;
    glBeginQuery(GL_TIME_ELAPSED, query.name());
    drawFrames(frame, count);
    glEndQuery(GL_TIME_ELAPSED);
    GLuint64 nanoseconds = 0;
    glGetQueryObjectui64v(query.name(), GL_QUERY_RESULT, &nanoseconds);
    return static_cast<double>(nanoseconds) * 1e-9 / count;
}

double median(std::vector<double> values) {
    const std::size_t half = values.size() / 2;
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(half), values.end());
    if (values.size() % 2 == 1) return values[half];
    return 0.5 * (values[half] + *std::max_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(half)));
}

}  // namespace

std::vector<double> medianFrameSeconds(std::span<const std::function<void()>> frames, const TimingOptions& options) {
    require(options.repeats >= 1, "medianFrameSeconds: repeats must be >= 1");
    for (const auto& frame : frames) require(static_cast<bool>(frame), "medianFrameSeconds: empty frame");
    std::vector<int> counts;
    for (const auto& frame : frames) {
        wallSeconds(frame, 1);
        const double once = std::max(wallSeconds(frame, 1), 1e-7);
        counts.push_back(static_cast<int>(std::clamp(std::ceil(options.least / once), 1.0, 1000.0)));
    }
    std::vector<std::vector<double>> measured(frames.size());
    for (int repeat = 0; repeat < options.repeats; ++repeat)
        for (std::size_t i = 0; i < frames.size(); ++i)
            measured[i].push_back(options.clock == FrameClock::Wall ? wallSeconds(frames[i], counts[i])
                                                                    : querySeconds(frames[i], counts[i]));
    std::vector<double> out;
    for (auto& values : measured) out.push_back(median(std::move(values)));
    return out;
}

}  // namespace nacre
