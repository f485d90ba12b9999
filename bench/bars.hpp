// The figures that the project promises to hold, measured.
#pragma once

#include <string>
#include <vector>

#include "bench/gpu_lab.hpp"
#include "bench/sweep.hpp"

namespace nacre::bench {

/// One figure of one bar, over the materials it speaks of.
struct Bar {
    std::string what;    ///< what was baked, how
    std::string figure;  ///< for instance `l2_rel, median`
    double limit = 0, value = 0;
    bool atLeast = false;    ///< decibels must be ≥ limit, errors ≤ limit
    std::string worst = {};  ///< the material that decides, or how many there were
    bool measured = false;   ///< false: no material at hand
    bool pass() const { return measured && (atLeast ? value >= limit : value <= limit); }
};

struct BarOptions {
    std::uint64_t samples = 200000;
    Progress progress;
};

/// Bakes what the bars ask for from `materials` and fills the table. A bake that fails makes its bar a miss.
/// \param lab  null: no OpenGL, the bar of GLSL against C++ stays unmeasured
std::vector<Bar> measureBars(const std::vector<Material>& materials, GpuLab* lab, const BarOptions& options,
                             std::vector<Measurement>* measurements = nullptr);

/// PASS, MISS or n/a, one line a bar.
std::string barTable(const std::vector<Bar>& bars);

double median(std::vector<double> values);  ///< mean of the two middle ones for even counts. values.size() ≥ 1

}  // namespace nacre::bench
