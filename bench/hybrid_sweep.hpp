// Hybrid rendering: error and time against light samples, virtual lights and pipes; and the bars.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/bars.hpp"
#include "core/progress.hpp"
#include "shading/program.hpp"

namespace nacre::bench {

/// A stage of a scene at one setting of a knob, a frame of 512 × 512.
struct HybridMeasurement {
    std::string scene, stage, knob;
    int value = 0;
    double error = 0;    ///< relative RMSE of means of pixels against rays
    double seconds = 0;  ///< a frame, by one pipe as it comes
};

/// How long a frame takes by several pipes, and what share of it each pass has.
struct PipeMeasurement {
    int pipes = 1;
    std::string compositing, threads;  ///< rasterizer threads a pipe
    double seconds = 0;                ///< median frame
    std::array<double, 5> shares{};    ///< of kHybridPasses
};
inline constexpr std::array kHybridPasses{"shadow", "indirect", "direct", "specular", "composite"};

struct HybridSweep {
    std::vector<HybridMeasurement> errors;
    std::vector<PipeMeasurement> pipes;
};

struct HybridSweepOptions {
    bool quick = false;
    ProgramLoader* loader = nullptr;  ///< null: no OpenGL, nothing is measured
    Progress progress{};
};

/// Draws by `nacre render`, as pipes are processes of that command.
HybridSweep sweepHybrid(const HybridSweepOptions& options);

std::vector<Bar> measureHybridBars(const HybridSweepOptions& options);

/// HYBRID figures 3 to 7 with both ends of all volumes, and with those that 16 rays found: pixels that are wrong, of
/// those whose answer rounding doesn't decide.
struct CountedVerdict {
    int compared = 0, wrong = 0, wrongApproximate = 0;
};
CountedVerdict judgeFigures(ProgramLoader& loader);

/// PSNR [dB] of a soft shadow by 16 points and the edge-stopping filter against 1024 rays a pixel.
double softShadowPsnr(ProgramLoader& loader);

std::string hybridSection(const HybridSweep& sweep);
nlohmann::json hybridJson(const HybridSweep& sweep);

}  // namespace nacre::bench
