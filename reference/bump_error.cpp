#include "reference/bump_error.hpp"

#include <fmt/format.h>

#include <random>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/sampling.hpp"

namespace nacre {

namespace {

class Random {
public:
    explicit Random(std::uint64_t seed) : bits_(seed) {}
    double operator()() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }
    int below(int n) { return std::min(static_cast<int>((*this)() * n), n - 1); }

private:
    std::mt19937_64 bits_;
};

/// Draws texels with a height.
class Texels {
public:
    explicit Texels(const HeightMap& map) : map_(map) {
        validateHeightMap(map);
        bool any = false;
        for (const float z : map.heights.data()) any = any || !std::isnan(z);
        require(any, "bump error: expected a relief, found holes alone");
    }
    glm::ivec2 operator()(Random& random) const {
        for (;;) {
            const int x = random.below(map_.width()), y = random.below(map_.height());
            if (!std::isnan(map_.heights.at(x, y, 0))) return {x, y};
        }
    }

private:
    const HeightMap& map_;
};

Vec2 centreOf(int x, int y) { return {x + 0.5, y + 0.5}; }

void requireCount(int count) { require(count >= 1, fmt::format("bump error: expected samples >= 1, found {}", count)); }

/// NaN when either is: an answer that is no number must not pass for a good one.
double larger(double a, double b) { return std::isnan(a) || a >= b ? a : b; }

double share(std::size_t part, std::size_t whole) {
    return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

HorizonSamples drawHorizonSamples(const HeightMap& map, int azimuths, int count, std::uint64_t seed, unsigned threads) {
    requireCount(count);
    require(azimuths >= 1, fmt::format("bump error: expected azimuths >= 1, found {}", azimuths));
    const Texels texels(map);
    Random random(seed);
    HorizonSamples out{azimuths, {}};
    for (int i = 0; i < count; ++i) {
        const glm::ivec2 texel = texels(random);
        out.samples.push_back({texel.x, texel.y, i % azimuths, 0});
    }
    const Relief relief(map);
    parallelFor(out.samples.size(), threads, [&](std::size_t i) {
        HorizonSamples::Sample& s = out.samples[i];
        s.elevation = std::atan(horizonSlope(relief, centreOf(s.x, s.y), 2 * kPi * s.k / azimuths));
    });
    return out;
}

HorizonError measureHorizons(const HorizonSamples& samples,
                             const std::function<double(int x, int y, int k)>& elevation) {
    const int azimuths = samples.azimuths;
    std::vector<double> squares(azimuths), counts(azimuths);  // of each azimuth
    HorizonError out;
    std::size_t near = 0;
    for (const HorizonSamples::Sample& s : samples.samples) {
        const double error = std::abs(elevation(s.x, s.y, s.k) - s.elevation);
        squares[s.k] += error * error;
        counts[s.k] += 1;
        out.maxRad = larger(out.maxRad, error);
        if (error <= 1e-3) ++near;
    }
    const auto rmse = [](double sum, double count) { return count == 0 ? 0 : std::sqrt(sum / count) * 180 / kPi; };
    double sum = 0, axisSum = 0, axisCount = 0;
    for (int k = 0; k < azimuths; ++k) {
        sum += squares[k];
        if (4 * k % azimuths == 0) axisSum += squares[k], axisCount += counts[k];  // 0, π/2, π, 3π/2
        out.rmseDegWorst = larger(out.rmseDegWorst, rmse(squares[k], counts[k]));
    }
    out.rmseDeg = rmse(sum, static_cast<double>(samples.samples.size()));
    out.rmseDegAlongAxes = rmse(axisSum, axisCount);
    out.shareWithinMilliRad = share(near, samples.samples.size());
    out.samples = static_cast<int>(samples.samples.size());
    return out;
}

HorizonError measureHorizons(const HorizonSamples& samples, const HorizonMap& stored) {
    require(stored.azimuths() == samples.azimuths, "measureHorizons: expected a map of the samples' azimuths");
    return measureHorizons(samples, [&](int x, int y, int k) { return double{stored.elevation[k].at(x, y, 0)}; });
}

LitSamples drawLitSamples(const HeightMap& map, int count, std::uint64_t seed, unsigned threads) {
    requireCount(count);
    const Texels texels(map);
    Random random(seed);
    LitSamples out;
    for (int i = 0; i < count; ++i) {
        const glm::ivec2 texel = texels(random);
        const double u = random(), v = random();
        out.samples.push_back({texel.x, texel.y, cosineHemisphere({u, v}), false});
    }
    const Relief relief(map);
    parallelFor(out.samples.size(), threads, [&](std::size_t i) {
        LitSamples::Sample& s = out.samples[i];
        s.lit = isLit(relief, centreOf(s.x, s.y), s.light);
    });
    return out;
}

LitError measureLit(const LitSamples& samples, const std::function<bool(int x, int y, const Vec3& light)>& lit) {
    std::size_t misjudged = 0, dark = 0;
    for (const LitSamples::Sample& s : samples.samples) {
        if (lit(s.x, s.y, s.light) != s.lit) ++misjudged;
        if (!s.lit) ++dark;
    }
    const std::size_t count = samples.samples.size();
    return {share(misjudged, count), share(dark, count), static_cast<int>(count)};
}

SeenSamples drawSeenSamples(const HeightMap& map, const std::vector<Vec3>& directions, int count, std::uint64_t seed,
                            unsigned threads) {
    requireCount(count);
    require(!directions.empty(), "bump error: expected directions, found none");
    for (const Vec3& d : directions)
        require(std::abs(glm::length(d) - 1) < 1e-6, "bump error: expected unit directions");
    const Texels texels(map);
    Random random(seed);
    SeenSamples out{directions, {}};
    for (int i = 0; i < count; ++i) {
        const glm::ivec2 texel = texels(random);
        out.samples.push_back({texel.x, texel.y, i % static_cast<int>(directions.size()), 0});
    }
    const Relief relief(map);
    parallelFor(out.samples.size(), threads, [&](std::size_t i) {
        SeenSamples::Sample& s = out.samples[i];
        const Vec3 from(centreOf(s.x, s.y), map.heights.at(s.x, s.y, 0));
        const auto hit = firstHit(relief, from, directions[s.k]);
        s.distance = hit ? hit->planeDistance : -1;
    });
    return out;
}

SeenError measureSeen(const SeenSamples& samples, const std::function<double(int x, int y, int k)>& distance) {
    std::size_t mismatches = 0, both = 0, apart = 0, hits = 0;
    for (const SeenSamples::Sample& s : samples.samples) {
        const double found = distance(s.x, s.y, s.k);
        const bool foundHit = !(found < 0), hit = s.distance >= 0;
        if (hit) ++hits;
        if (foundHit != hit) ++mismatches;
        if (!hit || !foundHit) continue;
        ++both;
        if (!(std::abs(found - s.distance) <= 1)) ++apart;  // NaN is apart
    }
    const std::size_t count = samples.samples.size();
    return {share(mismatches, count), share(apart, both), share(hits, count), static_cast<int>(count)};
}

SeenError measureSeen(const SeenSamples& samples, const ScatterMap& stored) {
    require(stored.directions == samples.directions && stored.distance.size() == samples.directions.size(),
            "measureSeen: expected a map of the samples' directions");
    return measureSeen(samples, [&](int x, int y, int k) { return double{stored.distance[k].at(x, y, 0)}; });
}

}  // namespace nacre
