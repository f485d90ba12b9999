// What a run found, as JSON for programs and as a page for people.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/bars.hpp"
#include "bench/bump_sweep.hpp"
#include "bench/environment_sweep.hpp"
#include "bench/hybrid_sweep.hpp"
#include "bench/shadow_sweep.hpp"
#include "bench/specular_sweep.hpp"
#include "bench/sweep.hpp"
#include "bench/transfer_sweep.hpp"

namespace nacre::bench {

struct Report {
    std::string version, machine, renderer;  ///< renderer: empty without OpenGL
    bool quick = false;
    double seconds = 0;  ///< the whole run took
    std::vector<std::string> notes;
    std::vector<Bar> bars;
    std::vector<Measurement> measurements;
    std::vector<EnvironmentMeasurement> environments;
    std::vector<BumpMeasurement> bumps;
    std::vector<ShadowMeasurement> shadows;
    std::vector<TransferMeasurement> transfers;
    std::vector<SpecularMeasurement> speculars;
    HybridSweep hybrid;
};

/// Numbers that aren't finite become the strings "inf", "-inf" and "nan".
nlohmann::json reportJson(const Report& report);

/// A complete HTML document: the bars, then for each group of materials error against bytes and against cost, medians
/// and single materials. No script, nothing fetched.
std::string reportPage(const Report& report);

/// The measurements of one setting over a group of materials.
struct SettingSummary {
    Setting setting;
    std::string form;
    int fetches = 0;
    std::size_t materials = 0;
    double bytes = 0, seconds = 0, costRatio = 0;  ///< medians; costRatio 0 when not measured
    double l2 = 0, l2Low = 0, l2High = 0, logRms = 0, grazing = 0, psnr = 0, psnrLow = 0;
};
/// In order of first appearance. Settings that gave the same bytes, fetches and errors as an earlier one of the same
/// method (a knob the method lacks) are left out.
std::vector<SettingSummary> summarise(const std::vector<Measurement>& measurements, Group group);

}  // namespace nacre::bench
