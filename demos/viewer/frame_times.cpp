#include "demos/viewer/frame_times.hpp"

#include <algorithm>
#include <numeric>

namespace nacre {

static constexpr int kWarm = 3;  // the first frames compile

void FrameTimes::add(double seconds) {
    // A jump is taken at once: another scene, or another size.
    const bool jump = smoothed_ == 0 || seconds > 10 * smoothed_ || seconds < 0.1 * smoothed_;
    smoothed_ = jump ? seconds : smoothed_ + 0.2 * (seconds - smoothed_);
    if (benchmark_ == 0) return;
    seconds_.push_back(seconds);
    if (seconds_.size() <= kWarm) cpuStart_ = std::clock();
}

bool FrameTimes::done() const {
    return benchmark_ > 0 && seconds_.size() >= static_cast<std::size_t>(benchmark_ + kWarm);
}

nlohmann::json FrameTimes::result() const {
    const double cpu = static_cast<double>(std::clock() - cpuStart_) / CLOCKS_PER_SEC;
    std::vector<double> times(seconds_.begin() + kWarm, seconds_.end());
    std::sort(times.begin(), times.end());
    const auto count = static_cast<double>(times.size());
    return {{"frames", times.size()},
            {"frames_per_second", count / std::accumulate(times.begin(), times.end(), 0.0)},
            {"median_ms", 1e3 * times[times.size() / 2]},
            {"slowest_ms", 1e3 * times.back()},
            {"cpu_ms", 1e3 * cpu / count}};
}

}  // namespace nacre
