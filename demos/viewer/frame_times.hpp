// How long frames took.
#pragma once

#include <ctime>
#include <nlohmann/json.hpp>
#include <vector>

namespace nacre {

class FrameTimes {
public:
    /// \param benchmark  frames to measure after the first few, which compile; 0: no end
    explicit FrameTimes(int benchmark) : benchmark_(benchmark) {}

    void add(double seconds);
    double smoothed() const { return smoothed_; }  ///< [s]
    bool done() const;
    /// Of a benchmark that is done: frames, frames_per_second, median_ms, slowest_ms, and cpu_ms of all cores.
    nlohmann::json result() const;

private:
    int benchmark_;
    double smoothed_ = 0;
    std::vector<double> seconds_;
    std::clock_t cpuStart_ = 0;
};

}  // namespace nacre
