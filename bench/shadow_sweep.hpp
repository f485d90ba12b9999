// Shadow maps against rays: error over resolution, bits, near/far and time; and the bars.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/bars.hpp"
#include "bench/shadow_scenes.hpp"
#include "core/progress.hpp"
#include "shading/program.hpp"

namespace nacre::bench {

/// One map of one light in one scene; a picture of 512 × 512.
struct ShadowMeasurement {
    std::string scene, light, method, setting;
    int size = 1024, bits = 32;                ///< of the map
    double nearToFar = 0;                      ///< 0: fitted
    bool usual = false;                        ///< what a scene file gets when nothing is said
    double acne = 0, leaks = 0, boundary = 0;  ///< shares of pixels that face the light, see reference/shadow_error.hpp
    double bytes = 0;
    double updateMs = 0, frame = 0;  ///< drawing the map; a frame as a multiple of the unshadowed one's; 0: not timed
    double misjudged() const { return acne + leaks + boundary; }
};

struct ShadowSweepOptions {
    bool quick = false;               ///< the synthetic scene alone, few settings
    ProgramLoader* loader = nullptr;  ///< null: no OpenGL, depth codes alone
    Progress progress{};
};
std::vector<ShadowMeasurement> sweepShadows(const std::vector<ShadowBenchScene>& scenes,
                                            const ShadowSweepOptions& options);

/// What shadows promise. Errors: the worst scene and light decide. Frames: the worst scene's; spot light, 1024², 32
/// bits, the usual filter, Torrance–Sparrow per pixel, the map not redrawn.
std::vector<Bar> measureShadowBars(const std::vector<ShadowBenchScene>& scenes, const ShadowSweepOptions& options);

/// Section of the page.
std::string shadowSection(const std::vector<ShadowMeasurement>& measurements);
nlohmann::json shadowJson(const ShadowMeasurement& measurement);

}  // namespace nacre::bench
