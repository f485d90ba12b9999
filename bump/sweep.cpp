#include "bump/sweep.hpp"

#include <cstdint>
#include <cstring>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace nacre {
namespace {

#define NACRE_KERNEL "bump/sweep_kernel.inl"
#include "core/wide.inl"

const auto kHorizon = NACRE_WIDEST(horizon);
const auto kAngles = NACRE_WIDEST(angles);
const auto kRays = NACRE_WIDEST(rays);

}  // namespace

void sweepHorizon(const SweepGrid& grid, const SweepPath& path, int x, int y, SweepHints& hints, float* slopes) {
    kHorizon(grid, path, x, y, hints, slopes);
}

void sweepAngles(float* slopes) { kAngles(slopes); }

void sweepRays(const SweepGrid& grid, const SweepPath& path, float slope, int x, int y, float* distances) {
    kRays(grid, path, slope, x, y, distances);
}

}  // namespace nacre
