// Reliefs as ellipses, horizon maps and scatter maps: seconds, bytes and error of each.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/bars.hpp"
#include "bench/bump_reliefs.hpp"
#include "core/progress.hpp"
#include "shading/program.hpp"

namespace nacre::bench {

/// One representation of one relief.
struct BumpMeasurement {
    std::string relief, method, setting;
    int texels = 0;
    bool usual = false;      ///< what the command does when nothing is said; the paper's for the radii-only fit
    double bytesATexel = 0;  ///< in half floats
    double cpuSeconds = 0;   ///< of all threads
    double wallSeconds = 0;
    double misjudged = 0;  ///< share of texels and lights, of shadows; of scatter maps: hit or miss wrong; of light
                           ///< that bounces: relative rmse of all light
    double detail = 0;     ///< horizons: rmse of the worst azimuth [degrees]; scatter maps: beyond one texel; light:
                           ///< without the direct
};

struct BumpSweepOptions {
    bool quick = false;  ///< the synthetic relief alone, few settings
    Progress progress{};
};
std::vector<BumpMeasurement> sweepReliefs(const std::vector<BenchRelief>& reliefs, const BumpSweepOptions& options);

struct BumpBarOptions {
    bool large = true;                ///< the speeds, at the sizes they are promised for
    ProgramLoader* loader = nullptr;  ///< null: no OpenGL, the bar of frame times stays unmeasured
    Progress progress{};
};
/// The figures that bump promises to hold: the worst relief decides about errors, a synthetic one about speed.
std::vector<Bar> measureBumpBars(const std::vector<BenchRelief>& reliefs, const BumpBarOptions& options);

/// Section of the page: error against bytes and against time, and every measurement.
std::string bumpSection(const std::vector<BumpMeasurement>& measurements);
nlohmann::json bumpJson(const BumpMeasurement& measurement);

}  // namespace nacre::bench
