#include "bump/horizon_map.hpp"

#include <fmt/format.h>

#include "bump/sweep.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"

namespace nacre {

/// atan(x), x ≥ 0, to 1e-7 (Abramowitz & Stegun 4.4.49): the library's takes a tenth of a bake.
static float arcTangent(float x) {
    const float t = x > 1 ? 1 / x : x, s = t * t;
    float sum = 0.0028662257f;
    for (const float c : {-0.0161657367f, 0.0429096138f, -0.0752896400f, 0.1065626393f, -0.1420889944f, 0.1999355085f,
                          -0.3333314528f, 1.0f})
        sum = sum * s + c;
    const float angle = sum * t;
    return x > 1 ? static_cast<float>(kPi / 2) - angle : angle;
}

std::vector<float> horizonSlopes(const HeightMap& map, double azimuth, unsigned threads) {
    validateHeightMap(map);
    require(std::isfinite(azimuth), fmt::format("horizonSlopes: expected a finite azimuth, found {}", azimuth));
    const SweepGrid grid(map, azimuth);
    const SweepPath path = sweepPath(grid, reachOf(map));
    std::vector<float> out(map.heights.texelCount());
    const auto sweep = [&](int x, int y, SweepHints& hints, float* slopes) {
        sweepHorizon(grid, path, x, y, hints, slopes);
    };
    sweepTexels(grid, threads, sweep, out);
    for (std::size_t i = 0; i < out.size(); ++i)
        if (std::isnan(map.heights.data()[i])) out[i] = 0;
    return out;
}

HorizonMap makeHorizonMap(const HeightMap& map, int azimuths, unsigned threads) {
    require(azimuths >= 1, fmt::format("makeHorizonMap: expected 1 azimuth or more, found {}", azimuths));
    validateHeightMap(map);
    HorizonMap out;
    out.elevation.resize(static_cast<std::size_t>(azimuths));
    // Azimuths side by side: so turning the map for each is shared out too.
    parallelFor(static_cast<std::size_t>(azimuths), threads, [&](std::size_t k) {
        std::vector<float> slopes =
            horizonSlopes(map, 2 * kPi * static_cast<double>(k) / azimuths, azimuths > 1 ? 1 : threads);
        for (float& slope : slopes) slope = arcTangent(slope);
        out.elevation[k] = Image(map.width(), map.height(), 1);
        out.elevation[k].data() = std::move(slopes);
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
