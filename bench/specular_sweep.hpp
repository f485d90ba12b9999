// Multi-pass pictures against rays: error and time over recursion depth, samples of frosted glass, light depth and
// levels of quality; and the bars.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/bars.hpp"
#include "core/progress.hpp"
#include "shading/program.hpp"

namespace nacre::bench {

/// One picture, one sample a pixel, and the same points traced to the full depth.
struct SpecularMeasurement {
    std::string scene, knob, setting;
    bool usual = false;      ///< what a scene gets when nothing is said
    double rmsOverMean = 0;  ///< ImageDifference's
    double psnr = 0;         ///< [dB], of the pictures as shown
    double ms = 0;           ///< a frame, median
    double tracedMs = 0;     ///< our reference at the setting's own depths and samples, one ray a pixel, all cores
    std::size_t passes = 0, views = 0, lights = 0;
};

struct SpecularSweepOptions {
    bool quick = false;               ///< small pictures, few settings
    ProgramLoader* loader = nullptr;  ///< null: nothing is measured
    std::filesystem::path scenes;     ///< holds NAME.json: demos/scenes
    Progress progress{};
};
std::vector<SpecularMeasurement> sweepSpecular(const SpecularSweepOptions& options);

/// What multi-pass pictures promise. The scene that is worst decides.
std::vector<Bar> measureSpecularBars(const SpecularSweepOptions& options);

/// Section of the page.
std::string specularSection(const std::vector<SpecularMeasurement>& measurements);
nlohmann::json specularJson(const SpecularMeasurement& measurement);

}  // namespace nacre::bench
