// How long frames take, fit for ratios: interleaved repeats and medians.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace nacre {

/// Wall: between two glFinish. Gpu: GL_TIME_ELAPSED, the GPU's own time (desktop OpenGL).
enum class FrameClock { Wall, Gpu };

struct TimingOptions {
    int repeats = 15;      ///< measurements of each frame, >= 1
    double least = 0.005;  ///< a measurement repeats its frame until about this long [s]: short frames drown in jitter
    FrameClock clock = FrameClock::Wall;
};

/// Median time of each frame [s]. Each is drawn once before (the first draw compiles shaders); then the measurements
/// take turns, so that a slow moment of the machine meets all frames alike.
/// \param frames  each draws one frame and sets the state it needs; glFlush follows each
/// \throws std::invalid_argument when repeats < 1 or a frame is empty; whatever a frame throws
std::vector<double> medianFrameSeconds(std::span<const std::function<void()>> frames,
                                       const TimingOptions& options = {});

}  // namespace nacre
