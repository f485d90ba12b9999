// Memory of sweeps, used again from azimuth to azimuth: where a page's first touch is dear (virtual machines), fresh
// arrays cost as much as the work in them.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <vector>

namespace nacre {

/// What the turned map of one azimuth lies in.
class SweepMemory {
public:
    /// `count` values of no meaning, the caller's until the next call.
    float* need(std::size_t count);

private:
    struct Free {
        void operator()(float* values) const { std::free(values); }
    };
    std::unique_ptr<float[], Free> values_;
    std::size_t count_ = 0;
};

/// For tasks that run side by side: as much as has been in use at the same time.
class SweepMemories {
public:
    std::unique_ptr<SweepMemory> take();
    void giveBack(std::unique_ptr<SweepMemory> memory);

private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<SweepMemory>> idle_;
};

}  // namespace nacre
