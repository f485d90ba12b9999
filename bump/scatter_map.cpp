#include "bump/scatter_map.hpp"

#include <fmt/format.h>

#include <array>

#include "bump/horizon_map.hpp"
#include "bump/normals.hpp"
#include "bump/sweep.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/sampling.hpp"

namespace nacre {
namespace {

constexpr double kVertical = 1e-6;  // of a direction's part along the plane: steeper ones see straight up or down

/// Shares of directions by their z, in bins u of z = u|u|: fine about the plane, where flat reliefs are hit.
constexpr int kBins = 512;
using Shares = std::array<double, kBins>;
double binEdge(int bin) {
    const double u = bin * 2.0 / kBins - 1;
    return u * std::abs(u);
}
/// Place of z among the bins, 0 to kBins.
double placeOf(double z) { return (std::copysign(std::sqrt(std::abs(z)), z) + 1) / 2 * kBins; }

/// The texels' normals' cosines to z, counted in 64 classes. \param slopes  surfaceSlopes
std::array<double, 64> tiltsOf(const HeightMap& map, const Image& slopes) {
    std::array<double, 64> counts{};
    for (std::size_t i = 0; i < map.heights.texelCount(); ++i) {
        if (std::isnan(map.heights.data()[i])) continue;
        const double p = slopes.data()[2 * i], q = slopes.data()[2 * i + 1];
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

/// So that they sum to 1; false when all are 0.
bool normalise(Shares& shares) {
    double sum = 0;
    for (const double share : shares) sum += share;
    for (double& share : shares) share = sum > 0 ? share / sum : 0;
    return sum > 0;
}

/// The cosine lobe about a normal, turned about z, averaged over the relief's normals.
Shares cosineShares(const HeightMap& map, const Image& slopes) {
    std::array<double, 64> tilts = tiltsOf(map, slopes);
    double total = 0;
    for (const double count : tilts) total += count;
    if (total == 0) tilts[63] = total = 1;
    Shares out{};
    for (int bin = 0; bin < kBins; ++bin) {
        const double low = binEdge(bin), high = binEdge(bin + 1), z = (low + high) / 2;
        for (std::size_t k = 0; k < tilts.size(); ++k)
            if (tilts[k] > 0)
                out[bin] += (high - low) * tilts[k] / total *
                            turnedCosine(k == 63 ? 1 : (static_cast<double>(k) + 0.5) / 64, z);
    }
    normalise(out);
    return out;
}

/// The part of that lobe that hits: for a few azimuths, of each texel the directions above its normal's plane and below
/// its horizon. False when nothing hits.
bool hitShares(const HeightMap& map, const Image& slopes, unsigned threads, Shares& out) {
    constexpr int kAzimuths = 4;
    std::vector<double> up(kBins + 2, 0), along(kBins + 2, 0);  // changes from bin to bin of Σ n.z, Σ n·azimuth
    for (int a = 0; a < kAzimuths; ++a) {
        const double azimuth = 2 * kPi * (a + 0.3) / kAzimuths, c = std::cos(azimuth), s = std::sin(azimuth);
        const std::vector<float> horizon = horizonSlopes(map, azimuth, threads);
        for (std::size_t i = 0; i < horizon.size(); ++i) {
            if (std::isnan(map.heights.data()[i])) continue;
            const double sx = slopes.data()[2 * i], sy = slopes.data()[2 * i + 1];
            const double rise = sx * c + sy * s, z = 1 / std::sqrt(1 + sx * sx + sy * sy), top = horizon[i];
            if (top <= rise) continue;
            const auto change = [&](double slope, double sign) {
                const double place = placeOf(slope / std::sqrt(1 + slope * slope));
                const auto bin = static_cast<std::size_t>(place);
                const double later = place - static_cast<double>(bin);
                up[bin] += sign * z * (1 - later), up[bin + 1] += sign * z * later;
                along[bin] -= sign * z * rise * (1 - later), along[bin + 1] -= sign * z * rise * later;
            };
            change(rise, 1), change(top, -1);
        }
    }
    double n = 0, m = 0;
    for (int bin = 0; bin < kBins; ++bin) {
        n += up[bin], m += along[bin];
        const double low = binEdge(bin), high = binEdge(bin + 1), z = (low + high) / 2;
        out[bin] = (high - low) * std::max(0.0, n * z + m * std::sqrt(1 - z * z));
    }
    return normalise(out);
}

/// Density of directions by their z: half as Lambert's cosine weighs them, half as it weighs those that hit. On a
/// shallow relief these are few and all near the plane: the cosine alone would leave what is seen there to a handful.
class DirectionDensity {
public:
    DirectionDensity(const HeightMap& map, unsigned threads) {
        const Image slopes = surfaceSlopes(map, threads);
        share_ = cosineShares(map, slopes);
        Shares hits{};
        if (!hitShares(map, slopes, threads, hits)) return;
        for (int bin = 0; bin < kBins; ++bin) share_[bin] += kHitting * (hits[bin] - share_[bin]);
    }
    double at(double z) const {
        const int bin = std::min(kBins - 1, static_cast<int>(placeOf(z)));
        return share_[bin] / (2 * kPi * (binEdge(bin + 1) - binEdge(bin)));
    }
    /// Inverse of the cumulated density: uniform in [0, 1) to z.
    double sampleZ(double uniform) const {
        for (int bin = 0; bin < kBins; ++bin) {
            if (uniform < share_[bin] && share_[bin] > 0)
                return binEdge(bin) + uniform / share_[bin] * (binEdge(bin + 1) - binEdge(bin));
            uniform -= share_[bin];
        }
        for (int bin = kBins - 1; bin > 0; --bin)
            if (share_[bin] > 0) return binEdge(bin + 1);
        return 1;
    }

private:
    static constexpr double kHitting = 0.5;
    Shares share_{};
};

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
    const DirectionDensity density(map, options.threads);
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
