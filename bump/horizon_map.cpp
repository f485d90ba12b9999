#include "bump/horizon_map.hpp"

#include <fmt/format.h>

#include "bump/sweep.hpp"
#include "core/error.hpp"

namespace nacre {

std::vector<float> horizonSlopes(const HeightMap& map, double azimuth, unsigned threads) {
    validateHeightMap(map);
    require(std::isfinite(azimuth), fmt::format("horizonSlopes: expected a finite azimuth, found {}", azimuth));
    const SweepGrid grid(map, azimuth);
    const SweepPath path = sweepPath(grid, reachOf(map));
    std::vector<float> out(map.heights.texelCount());
    sweepTexels(
        grid, threads, [&](int x, int y, float* slopes) { sweepHorizon(grid, path, x, y, slopes); }, out);
    for (std::size_t i = 0; i < out.size(); ++i)
        if (std::isnan(map.heights.data()[i])) out[i] = 0;
    return out;
}

HorizonMap makeHorizonMap(const HeightMap& map, int azimuths, unsigned threads) {
    require(azimuths >= 1, fmt::format("makeHorizonMap: expected 1 azimuth or more, found {}", azimuths));
    HorizonMap out;
    for (int k = 0; k < azimuths; ++k) {
        const std::vector<float> slopes = horizonSlopes(map, 2 * kPi * k / azimuths, threads);
        out.elevation.emplace_back(map.width(), map.height(), 1);
        for (std::size_t i = 0; i < slopes.size(); ++i) out.elevation.back().data()[i] = std::atan(slopes[i]);
    }
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
