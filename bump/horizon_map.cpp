#include "bump/horizon_map.hpp"

#include <fmt/format.h>

#include "bump/sweep.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"

namespace nacre {

void sweepHorizons(const HeightMap& map, double azimuth, unsigned threads, bool angles, SweepMemories& memories,
                   std::span<float> out) {
    std::unique_ptr<SweepMemory> memory = memories.take();
    const SweepGrid grid(map, azimuth, *memory);
    // What repeats further away hides less.
    const SweepPath path = sweepPath(grid, std::min(reachOf(map), grid.repeatsFrom()));
    const auto sweep = [&](int x, int y, SweepHints& hints, float* slopes) {
        sweepHorizon(grid, path, x, y, hints, slopes);
        if (angles) sweepAngles(slopes);
    };
    sweepTexels(grid, threads, sweep, out);
    memories.giveBack(std::move(memory));
}

std::vector<float> horizonSlopes(const HeightMap& map, double azimuth, unsigned threads) {
    validateHeightMap(map);
    require(std::isfinite(azimuth), fmt::format("horizonSlopes: expected a finite azimuth, found {}", azimuth));
    SweepMemories memories;
    std::vector<float> out(map.heights.texelCount());
    sweepHorizons(map, azimuth, threads, false, memories, out);
    return out;
}

HorizonMap makeHorizonMap(const HeightMap& map, int azimuths, unsigned threads) {
    require(azimuths >= 1, fmt::format("makeHorizonMap: expected 1 azimuth or more, found {}", azimuths));
    validateHeightMap(map);
    HorizonMap out;
    out.elevation.resize(static_cast<std::size_t>(azimuths));
    SweepMemories memories;
    // Azimuths side by side: so turning the map for each is shared out too.
    parallelFor(static_cast<std::size_t>(azimuths), threads, [&](std::size_t k) {
        out.elevation[k] = Image(map.width(), map.height(), 1);
        sweepHorizons(map, 2 * kPi * static_cast<double>(k) / azimuths, azimuths > 1 ? 1 : threads, true, memories,
                      out.elevation[k].data());
    });
    return out;
}

double horizonElevation(const HorizonMap& map, int x, int y, double azimuth) {
    const int n = map.azimuths();
    const double place = azimuth / (2 * kPi) * n, low = std::floor(place);
    const int k = wrapIndex(static_cast<int>(low), n, Wrap::Repeat);
    const double t = place - low;
    return (1 - t) * map.elevation[k].at(x, y, 0) + t * map.elevation[(k + 1) % n].at(x, y, 0);
}

}  // namespace nacre
