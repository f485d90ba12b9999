#include "bump/scatter_map.hpp"

#include <fmt/format.h>

#include <array>

#include "bump/sweep.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/sampling.hpp"

namespace nacre {
namespace {

constexpr double kVertical = 1e-6;  // of a direction's part along the plane: steeper ones see straight up or down

/// Density of directions by their z: the cosine lobe about a normal, turned about z, averaged over the relief's
/// normals.
class DirectionDensity {
public:
    explicit DirectionDensity(const HeightMap& map);

    double at(double z) const;
    /// Inverse of the cumulated density: uniform in [0, 1) to z.
    double sampleZ(double uniform) const;

private:
    static constexpr int kBins = 512;  // of z, −1 to 1
    std::array<double, kBins> share_{};
};

/// Texels' slopes by central differences, as the cosines of their normals, counted in 64 classes.
std::array<double, 64> tiltsOf(const HeightMap& map) {
    std::array<double, 64> counts{};
    for (int y = 0; y < map.height(); ++y)
        for (int x = 0; x < map.width(); ++x) {
            const double p = 0.5 * (map.at(x + 1, y) - map.at(x - 1, y)),
                         q = 0.5 * (map.at(x, y + 1) - map.at(x, y - 1));
            if (!std::isfinite(p + q)) continue;
            const double cosine = 1 / std::sqrt(1 + p * p + q * q);
            counts[std::min<std::size_t>(static_cast<std::size_t>(cosine * 64), 63)] += 1;
        }
    return counts;
}

/// Mean over a turn about z of max(0, n·d) for n, d with cosines n and z to the axis.
double turnedCosine(double n, double z) {
    const double along = n * z, across = std::sqrt((1 - n * n) * (1 - z * z));
    if (along >= across) return along;
    if (along <= -across) return 0;
    const double edge = std::acos(-along / across);  // of the turn at which n·d is 0
    return (along * edge + across * std::sin(edge)) / kPi;
}

DirectionDensity::DirectionDensity(const HeightMap& map) {
    std::array<double, 64> tilts = tiltsOf(map);
    double total = 0;
    for (const double count : tilts) total += count;
    if (total == 0) tilts[63] = total = 1;
    for (int bin = 0; bin < kBins; ++bin) {
        const double z = (bin + 0.5) * 2 / kBins - 1;
        for (std::size_t k = 0; k < tilts.size(); ++k)
            if (tilts[k] > 0)
                share_[bin] += tilts[k] / total * turnedCosine(k == 63 ? 1 : (static_cast<double>(k) + 0.5) / 64, z);
    }
    double sum = 0;
    for (const double share : share_) sum += share;
    for (double& share : share_) share /= sum;
}

double DirectionDensity::at(double z) const {
    const int bin = std::min(kBins - 1, static_cast<int>((z + 1) / 2 * kBins));
    return share_[bin] * kBins / (4 * kPi);  // a bin of z is 4π/bins of the sphere
}

double DirectionDensity::sampleZ(double uniform) const {
    for (int bin = 0; bin < kBins; ++bin) {
        if (uniform < share_[bin] && share_[bin] > 0) return (bin + uniform / share_[bin]) * 2 / kBins - 1;
        uniform -= share_[bin];
    }
    for (int bin = kBins - 1; bin > 0; --bin)
        if (share_[bin] > 0) return (bin + 1) * 2.0 / kBins - 1;
    return 1;
}

}  // namespace

/// rayDistances into `out`.
static void sweepDistances(const HeightMap& map, const Vec3& direction, unsigned threads, SweepMemories& memories,
                           std::span<float> out) {
    const double along = std::hypot(direction.x, direction.y);
    const std::vector<float>& heights = map.heights.data();
    if (along < kVertical) {
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = direction.z > 0 || std::isnan(heights[i]) ? -1 : 0;
        return;
    }
    std::unique_ptr<SweepMemory> memory = memories.take();
    const SweepGrid grid(map, std::atan2(direction.y, direction.x), *memory);
    const SweepPath path = sweepPath(grid, reachOf(map));
    const float slope = static_cast<float>(direction.z / along);
    const auto sweep = [&](int x, int y, SweepHints&, float* distances) {
        sweepRays(grid, path, slope, x, y, distances);
    };
    sweepTexels(grid, threads, sweep, out);
    memories.giveBack(std::move(memory));
}

std::vector<float> rayDistances(const HeightMap& map, const Vec3& direction, unsigned threads) {
    validateHeightMap(map);
    constexpr double kUnit = 1e-6;
    require(isFinite(direction) && std::abs(glm::length(direction) - 1) < kUnit,
            "rayDistances: expected a direction of unit length");
    SweepMemories memories;
    std::vector<float> out(map.heights.texelCount());
    sweepDistances(map, direction, threads, memories, out);
    return out;
}

ScatterMap makeScatterMap(const HeightMap& map, const ScatterOptions& options) {
    validateHeightMap(map);
    require(options.directions >= 1,
            fmt::format("makeScatterMap: expected 1 direction or more, found {}", options.directions));
    const DirectionDensity density(map);
    ScatterMap out;
    const int count = options.directions;
    for (int i = 0; i < count; ++i) {
        // Equal steps of z's distribution; azimuths by the golden ratio, which keeps neighbours in z apart.
        const double z = density.sampleZ((i + 0.5) / count);
        const double turn = i * (std::sqrt(5.0) - 1) / 2, azimuth = 2 * kPi * (turn - std::floor(turn));
        const double across = std::sqrt(std::max(0.0, 1 - z * z));
        out.directions.push_back({across * std::cos(azimuth), across * std::sin(azimuth), z});
        out.weights.push_back(1 / (count * density.at(z)));
    }
    out.distance.resize(out.directions.size());
    SweepMemories memories;
    // Directions side by side: so turning the map for each is shared out too.
    parallelFor(out.distance.size(), options.threads, [&](std::size_t i) {
        out.distance[i] = Image(map.width(), map.height(), 1);
        sweepDistances(map, out.directions[i], count > 1 ? 1 : options.threads, memories, out.distance[i].data());
    });
    return out;
}

Vec2 seenPoint(int x, int y, const Vec3& direction, double distance) {
    const double along = std::hypot(direction.x, direction.y);
    const Vec2 centre(x + 0.5, y + 0.5);
    return along < kVertical ? centre : centre + Vec2(direction.x, direction.y) * (distance / along);
}

}  // namespace nacre
