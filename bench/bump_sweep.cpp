#include "bench/bump_sweep.hpp"

#include <fmt/format.h>

#include <chrono>

#include "bench/bump_gpu.hpp"
#include "bench/environment_sweep.hpp"
#include "bump/bump_asset.hpp"
#include "bump/horizon_ellipses.hpp"
#include "bump/horizon_map.hpp"
#include "bump/scatter_map.hpp"
#include "bump/scattered_light.hpp"
#include "reference/bump_error.hpp"
#include "reference/scattered_light_error.hpp"

namespace nacre::bench {
namespace {

struct Times {
    double wall = 0, cpu = 0;
};

template <class Work>
Times timed(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    const double cpu = processCpuSeconds();
    work();
    return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), processCpuSeconds() - cpu};
}

/// Decides as a shader with these ellipses, at texel centres.
double misjudgedBy(const EllipseMap& map, const LitSamples& samples) {
    return measureLit(samples, [&](int x, int y, const Vec3& l) { return ellipseValue(map.at(x, y), l) >= 0; })
        .misjudged;
}

double misjudgedBy(const HorizonMap& map, const LitSamples& samples) {
    return measureLit(samples,
                      [&](int x, int y, const Vec3& l) {
                          return std::asin(l.z) >= horizonElevation(map, x, y, std::atan2(l.y, l.x));
                      })
        .misjudged;
}

BumpMeasurement begin(const BenchRelief& relief, const std::string& method, const std::string& setting, double bytes) {
    BumpMeasurement m;
    m.relief = relief.name;
    m.texels = static_cast<int>(relief.map.heights.texelCount());
    m.method = method;
    m.setting = setting;
    m.bytesATexel = bytes;
    return m;
}

BumpMeasurement measureEllipses(const BenchRelief& relief, int directions, EllipseFit fit, const LitSamples& samples) {
    constexpr double kBytes = 12;  // six halves
    const bool full = fit == EllipseFit::Full;
    BumpMeasurement m =
        begin(relief, full ? "ellipses" : "ellipses, radii only", fmt::format("{} directions", directions), kBytes);
    EllipseMap map;
    const Times times = timed([&] { map = fitEllipses(relief.map, {.directions = directions, .fit = fit}); });
    m.wallSeconds = times.wall, m.cpuSeconds = times.cpu;
    m.usual = directions == EllipseOptions{}.directions;
    m.misjudged = misjudgedBy(map, samples);
    return m;
}

BumpMeasurement measureHorizonMap(const BenchRelief& relief, int azimuths, const LitSamples& samples) {
    BumpMeasurement m = begin(relief, "horizon map", fmt::format("{} azimuths", azimuths), 2.0 * azimuths);
    HorizonMap map;
    const Times times = timed([&] { map = makeHorizonMap(relief.map, azimuths); });
    m.wallSeconds = times.wall, m.cpuSeconds = times.cpu;
    m.misjudged = misjudgedBy(map, samples);
    m.detail = measureHorizons(drawHorizonSamples(relief.map, azimuths, 4000), map).rmseDegWorst;
    return m;
}

/// A lamp that stands low: there is more to bounce.
const Vec3 kLamp = glm::normalize(Vec3(1, 0.4, 0.6));
constexpr int kScattered = 512;  // directions of the scatter map behind it

ReliefLightSamples lightTruth(const BenchRelief& relief, int paths) {
    ReliefLightOptions options;  // albedo 0.7, 3 bounces
    options.light = kLamp;
    options.paths = paths;
    return drawReliefLightSamples(relief.map, options, 300);
}

BumpMeasurement measureLight(const BenchRelief& relief, const ScatterMap& scatter, const ReliefLightSamples& truth,
                             int paths) {
    BumpMeasurement m = begin(relief, "bounced light", fmt::format("{} paths", paths), 6);
    ScatteredLight light;
    const Times times = timed([&] { light = scatterLight(relief.map, scatter, {.light = kLamp, .paths = paths}); });
    m.wallSeconds = times.wall, m.cpuSeconds = times.cpu;
    m.usual = paths == ScatteredLightOptions{}.paths;
    const ScatteredLightError error = measureScatteredLight(truth, light);
    m.misjudged = error.total;
    m.detail = error.indirect;
    return m;
}

BumpMeasurement measureScatterMap(const BenchRelief& relief, int directions) {
    BumpMeasurement m = begin(relief, "scatter map", fmt::format("{} directions", directions), 2.0 * directions);
    ScatterMap map;
    const Times times = timed([&] { map = makeScatterMap(relief.map, {.directions = directions}); });
    m.wallSeconds = times.wall, m.cpuSeconds = times.cpu;
    const SeenError error = measureSeen(drawSeenSamples(relief.map, map.directions, 4000), map);
    m.misjudged = error.hitMismatch;
    m.detail = error.beyondOneTexel;
    return m;
}

void raise(Bar& bar, double value, const std::string& where) {
    if (bar.measured && (bar.atLeast ? value >= bar.value : value <= bar.value)) return;
    bar.value = value;
    bar.worst = where;
    bar.measured = true;
}

/// Speeds as they are promised: horizons of 1024², rays and ellipses of 512², synthetic.
void measureSpeeds(const Progress& progress, Bar& horizons, Bar& rays, Bar& bake, Bar& axes, Bar& others) {
    constexpr int kRuns = 3;  // the best: other work on the machine can only slow it down
    const BenchRelief large{"synthetic 1024", syntheticRelief(1024)}, middle{"synthetic 512", syntheticRelief(512)};
    HorizonMap map;
    double best = 0;
    for (int run = 0; run < kRuns; ++run) {
        report(progress, fmt::format("horizons of 1024, run {}", run + 1), 0);
        const Times times = timed([&] { map = makeHorizonMap(large.map, 16); });
        best = std::max(best, 16e-6 * static_cast<double>(large.map.heights.texelCount()) / times.wall);
    }
    raise(horizons, best, large.name);
    const HorizonError error = measureHorizons(drawHorizonSamples(large.map, 16), map);
    raise(axes, error.rmseDegAlongAxes, large.name);
    raise(others, error.rmseDegWorst, large.name);
    best = 0;
    for (int run = 0; run < kRuns; ++run) {
        report(progress, fmt::format("rays of 512, run {}", run + 1), 0);
        const Times times = timed([&] { makeScatterMap(middle.map, {.directions = 64}); });
        best = std::max(best, 64e-6 * static_cast<double>(middle.map.heights.texelCount()) / times.wall);
    }
    raise(rays, best, middle.name);
    report(progress, "ellipses of 512", 0);
    raise(bake, timed([&] { fitEllipses(middle.map, {.directions = 128}); }).wall, middle.name);
}

double threadDifferences(const HeightMap& map) {
    std::size_t differences = 0;
    const auto compare = [&](const std::vector<float>& a, const std::vector<float>& b) {
        for (std::size_t i = 0; i < a.size(); ++i) differences += a[i] != b[i];
    };
    compare(horizonSlopes(map, 0.5, 1), horizonSlopes(map, 0.5, 7));
    const Vec3 direction = glm::normalize(Vec3(1, 2, 0.7));
    compare(rayDistances(map, direction, 1), rayDistances(map, direction, 7));
    const EllipseMap one = fitEllipses(map, {.directions = 32, .threads = 1}),
                     seven = fitEllipses(map, {.directions = 32, .threads = 7});
    compare(one.shape.data(), seven.shape.data());
    compare(one.offset.data(), seven.offset.data());
    return static_cast<double>(differences);
}

}  // namespace

std::vector<BumpMeasurement> sweepReliefs(const std::vector<BenchRelief>& reliefs, const BumpSweepOptions& options) {
    const std::vector<int> directions = options.quick ? std::vector{32, 128} : std::vector{16, 32, 64, 128, 256};
    const std::vector<int> azimuths = options.quick ? std::vector{8, 16} : std::vector{4, 8, 16, 32, 64, 128};
    const std::vector<int> scattered = options.quick ? std::vector{16} : std::vector{16, 64, 256};
    std::vector<BumpMeasurement> out;
    for (std::size_t i = 0; i < (options.quick ? std::min<std::size_t>(1, reliefs.size()) : reliefs.size()); ++i) {
        const BenchRelief& relief = reliefs[i];
        report(options.progress, "shadows of " + relief.name, 0);
        const LitSamples samples = drawLitSamples(relief.map, 20000);
        for (const int count : directions)
            for (const EllipseFit fit : {EllipseFit::Full, EllipseFit::Radii})
                out.push_back(measureEllipses(relief, count, fit, samples));
        for (const int count : azimuths) out.push_back(measureHorizonMap(relief, count, samples));
        for (const int count : scattered) out.push_back(measureScatterMap(relief, count));
        report(options.progress, "light that bounces in " + relief.name, 0);
        const ReliefLightSamples truth = lightTruth(relief, options.quick ? 400 : 4000);
        const ScatterMap scatter = makeScatterMap(relief.map, {.directions = options.quick ? 128 : kScattered});
        for (const int paths : options.quick ? std::vector{100} : std::vector{12, 25, 50, 100, 200, 400})
            out.push_back(measureLight(relief, scatter, truth, paths));
    }
    for (const int size : options.quick ? std::vector{128} : std::vector{128, 256, 512, 1024}) {
        report(options.progress, fmt::format("seconds of {}", size), 0);
        const BenchRelief relief{fmt::format("synthetic {}", size), syntheticRelief(size)};
        out.push_back(measureHorizonMap(relief, 16, drawLitSamples(relief.map, 4000)));
        out.push_back(measureScatterMap(relief, 64));
        out.push_back(measureEllipses(relief, 128, EllipseFit::Full, drawLitSamples(relief.map, 4000)));
    }
    return out;
}

std::vector<Bar> measureBumpBars(const std::vector<BenchRelief>& reliefs, const BumpBarOptions& options) {
    Bar axes{"horizon map, 16 azimuths", "rmse along the axes [degrees]", 0.05};
    Bar others{"horizon map, 16 azimuths", "rmse of the worst azimuth [degrees]", 0.3};
    Bar hit{"scatter map, 64 directions", "hit or miss wrong", 0.001},
        beyond{"scatter map, 64 directions", "beyond one texel", 0.005};
    Bar misjudged{"ellipses, 128 directions", "texels and lights misjudged", 0.04};
    Bar gain{"ellipses, 128 directions", "misjudged, as a share of the radii-only fit's", 0.75};
    Bar light{"light of 3 bounces, 100 paths, albedo 0.7", "relative rmse", 0.05},
        bounced{"the same, without the direct light", "relative rmse", 0.05};
    Bar threads{"horizons, rays, ellipses, 1 thread against 7", "values with other bits", 0};
    for (const BenchRelief& relief : reliefs) {
        report(options.progress, "bars on " + relief.name, 0);
        const HorizonError horizons =
            measureHorizons(drawHorizonSamples(relief.map, 16), makeHorizonMap(relief.map, 16));
        raise(axes, horizons.rmseDegAlongAxes, relief.name);
        raise(others, horizons.rmseDegWorst, relief.name);
        const ScatterMap scatter = makeScatterMap(relief.map, {.directions = 64});
        const SeenError seen = measureSeen(drawSeenSamples(relief.map, scatter.directions), scatter);
        raise(hit, seen.hitMismatch, relief.name);
        raise(beyond, seen.beyondOneTexel, relief.name);
        const LitSamples samples = drawLitSamples(relief.map, 40000);
        const double full = measureEllipses(relief, 128, EllipseFit::Full, samples).misjudged;
        const double radii = measureEllipses(relief, 128, EllipseFit::Radii, samples).misjudged;
        raise(misjudged, full, relief.name);
        raise(gain, full / radii, relief.name);
        raise(threads, threadDifferences(relief.map), relief.name);
        const ScatterMap many = makeScatterMap(relief.map, {.directions = kScattered});
        const BumpMeasurement lit = measureLight(relief, many, lightTruth(relief, options.large ? 4000 : 400), 100);
        raise(light, lit.misjudged, relief.name);
        raise(bounced, lit.detail, relief.name);
    }
    Bar frame{"bump-mapped frame, one light", "with soft ellipse shadows, times plain bump mapping's", 1.6};
    if (options.loader) {
        report(options.progress, "frames with and without shadows", 0);
        const HeightMap& map = reliefs.front().map;
        BumpMaps maps{map.width(), map.height(), map.wrap, makeNormals(map), {}, fitEllipses(map), {}, {}, {}};
        const BumpCost cost = bumpCost(*options.loader, GpuBump(maps));
        raise(frame, std::max(cost.hardEllipse, cost.ellipse),
              fmt::format("{}, plain {:.2f} ms", reliefs.front().name, cost.plainMs));
    }
    Bar speed{"horizon map, 1024, 16 azimuths", "million horizons a second", 40},
        rays{"scatter map, 512, 64 directions", "million rays a second", 40};
    Bar bake{"ellipses, 512, 128 directions", "seconds", 10};
    speed.atLeast = rays.atLeast = true;
    if (options.large) measureSpeeds(options.progress, speed, rays, bake, axes, others);
    return {axes, others, speed, hit, beyond, rays, misjudged, gain, bake, light, bounced, frame, threads};
}

}  // namespace nacre::bench
