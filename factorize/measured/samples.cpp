#include "factorize/measured/samples.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <array>
#include <map>
#include <memory>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/parallel.hpp"

namespace nacre {

static constexpr std::size_t kNeighbours = 24;
static constexpr double kRidge = 0.01;
static constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 30;

namespace {
struct PlacedSample {
    Vec3 at;  ///< grid coordinates
    Rgb log;
    std::size_t group = 0;  ///< left out together
};
constexpr std::size_t kNoGroup = ~std::size_t{0};
constexpr std::size_t kFolds = 5, kFewPlaces = 100, kMostPredicted = 2000;
struct Near {
    double distance2;
    std::size_t sample;
    bool operator<(const Near& o) const {  // ties by index: the same neighbours whatever the order of arrival
        return distance2 != o.distance2 ? distance2 < o.distance2 : sample < o.sample;
    }
};
}  // namespace

static Vec3 gridCoordinates(const Vec3& wi, const Vec3& wo) {
    const HalfDifference angles = halfDifference(wi, wo);
    const double turned = std::fmod(angles.phiD, kPi), folded = std::min(turned, kPi - turned);
    return {std::sqrt(angles.thetaH * 2 / kPi), angles.thetaD * 2 / kPi, std::max(0.0, folded) * 2 / kPi};
}

/// The nearest samples outside group `without`, the farthest of them last. Differences in φd count by x y of the
/// vertex.
static std::vector<Near> nearest(const std::vector<PlacedSample>& samples, const Vec3& at, std::size_t without) {
    const Vec3 scale(1, 1, at.x * at.y);
    std::vector<Near> heap;  // largest on top
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (samples[i].group == without) continue;
        const Vec3 d = (samples[i].at - at) * scale;
        const Near candidate{dot(d, d), i};
        if (heap.size() == kNeighbours) {
            if (!(candidate < heap.front())) continue;
            std::pop_heap(heap.begin(), heap.end());
            heap.pop_back();
        }
        heap.push_back(candidate);
        std::push_heap(heap.begin(), heap.end());
    }
    std::sort_heap(heap.begin(), heap.end());
    return heap;
}

/// Weighted least squares of log ≈ c0 + c · offset; the answer is c0.
static Rgb regress(const std::vector<PlacedSample>& samples, const Vec3& at, std::size_t without = kNoGroup) {
    const std::vector<Near> near = nearest(samples, at, without);
    // A little beyond the farthest, so that a single sample or many at one place keep a weight.
    const double radius = 1.001 * std::sqrt(near.back().distance2) + 1e-6;
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Matrix<double, 4, 3> right = Eigen::Matrix<double, 4, 3>::Zero();
    Rgb low(std::numeric_limits<double>::infinity()), high = -low;
    for (const Near& n : near) {
        const PlacedSample& sample = samples[n.sample];
        const Vec3 d = (sample.at - at) * Vec3(1, 1, at.x * at.y) / radius;
        const double weight = std::pow(1 - std::pow(std::sqrt(n.distance2) / radius, 3), 3);
        const Eigen::Vector4d row(1, d.x, d.y, d.z);
        normal += weight * row * row.transpose();
        right += weight * row * Eigen::RowVector3d(sample.log.r, sample.log.g, sample.log.b);
        low = glm::min(low, sample.log);
        high = glm::max(high, sample.log);
    }
    for (int i = 1; i < 4; ++i) normal(i, i) += kRidge * normal(0, 0);
    const Eigen::Matrix<double, 4, 3> solution = normal.ldlt().solve(right);
    return glm::clamp(Rgb(solution(0, 0), solution(0, 1), solution(0, 2)), low, high);
}

static std::vector<PlacedSample> place(const std::vector<BrdfSample>& samples) {
    std::vector<PlacedSample> placed;
    for (const BrdfSample& sample : samples)
        placed.push_back({gridCoordinates(sample.pair.wi, sample.pair.wo), glm::log(sample.f + SampleGrid::kOffset)});
    return placed;
}

/// Deals out the places, in order of arrival. \return  how many there are
static std::size_t dealGroups(std::vector<PlacedSample>& placed) {
    constexpr double kSamePlace = 1e6;
    std::map<std::array<long long, 3>, std::size_t> places;
    for (PlacedSample& p : placed) {
        const std::array key{std::llround(p.at.x * kSamePlace), std::llround(p.at.y * kSamePlace),
                             std::llround(p.at.z * kSamePlace)};
        p.group = places.emplace(key, places.size()).first->second;
    }
    if (places.size() >= kFewPlaces)
        for (PlacedSample& p : placed) p.group %= kFolds;
    return places.size();
}

void holdOut(const std::vector<BrdfSample>& samples, DataReport& data, unsigned threads) {
    std::vector<PlacedSample> placed = place(samples);
    data.distinct = dealGroups(placed);
    if (data.distinct < 2) return;
    const double lowest = std::cos(80 * kPi / 180);
    const auto isBody = [&](const BrdfSample& s) { return std::min(s.pair.wi.z, s.pair.wo.z) >= lowest; };
    const bool anyBody = std::any_of(samples.begin(), samples.end(), isBody);
    std::vector<std::size_t> chosen;
    const std::size_t stride = samples.size() / kMostPredicted + 1;
    for (std::size_t i = 0; i < samples.size(); i += stride)
        if (!anyBody || isBody(samples[i])) chosen.push_back(i);
    std::vector<double> gaps(chosen.size());
    parallelFor(chosen.size(), threads, [&](std::size_t k) {
        const PlacedSample& p = placed[chosen[k]];
        const Rgb predicted = glm::max(glm::exp(regress(placed, p.at, p.group)) - SampleGrid::kOffset, Rgb(0));
        const Rgb gap = predicted - samples[chosen[k]].f;
        gaps[k] = glm::dot(gap, gap);
    });
    double gap = 0, total = 0;
    for (std::size_t k = 0; k < chosen.size(); ++k) {
        const BrdfSample& s = samples[chosen[k]];
        const double weight = s.pair.wi.z * s.pair.wo.z;
        gap += weight * gaps[k];
        total += weight * glm::dot(s.f, s.f);
    }
    data.holdoutL2Rel = total > 0 ? std::sqrt(gap / total) : 0;  // black foretells black
}

SampleGrid gridSamples(const std::vector<BrdfSample>& samples, unsigned threads) {
    require(!samples.empty(), "gridSamples: expected at least one sample");
    const std::vector<PlacedSample> placed = place(samples);
    SampleGrid grid{std::vector<glm::vec3>(static_cast<std::size_t>(SampleGrid::kX * SampleGrid::kY * SampleGrid::kZ))};
    parallelFor(grid.logs.size(), threads, [&](std::size_t i) {
        const int n = static_cast<int>(i), x = n / SampleGrid::kZ / SampleGrid::kY,
                  y = n / SampleGrid::kZ % SampleGrid::kY, z = n % SampleGrid::kZ;
        const Vec3 last(SampleGrid::kX - 1, SampleGrid::kY - 1, SampleGrid::kZ - 1);
        grid.logs[i] = glm::vec3(regress(placed, Vec3(x, y, z) / last));
    });
    return grid;
}

Rgb evaluate(const SampleGrid& grid, const Vec3& wi, const Vec3& wo) {
    if (!(wi.z > 0 && wo.z > 0)) return Rgb(0);
    const Vec3 last(SampleGrid::kX - 1, SampleGrid::kY - 1, SampleGrid::kZ - 1);
    const Vec3 at = glm::clamp(gridCoordinates(wi, wo), 0.0, 1.0) * last;
    const glm::ivec3 cell = glm::min(glm::ivec3(at), glm::ivec3(last) - 1);
    const Vec3 f = at - Vec3(cell);
    Rgb sum(0);
    for (int corner = 0; corner < 8; ++corner) {
        const int dx = corner & 1, dy = corner >> 1 & 1, dz = corner >> 2;
        const double weight = (dx ? f.x : 1 - f.x) * (dy ? f.y : 1 - f.y) * (dz ? f.z : 1 - f.z);
        const int index = ((cell.x + dx) * SampleGrid::kY + cell.y + dy) * SampleGrid::kZ + cell.z + dz;
        sum += weight * Rgb(grid.logs[static_cast<std::size_t>(index)]);
    }
    return glm::max(glm::exp(sum) - SampleGrid::kOffset, Rgb(0));
}

Reflectance openSamples(const std::filesystem::path& path) {
    const std::vector<std::uint8_t> bytes = readFile(path, kMaxFileBytes);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const ParsedSamples parsed = parseSamples(text, path.string());
    auto grid = std::make_shared<const SampleGrid>(gridSamples(parsed.samples));
    Reflectance out;
    out.source = path.string();
    out.kind = "samples";
    out.hash = contentHash(text);
    out.data = parsed.data;
    holdOut(parsed.samples, out.data);
    out.data.rule = fmt::format(
        "lines with a negative or non-finite value, or a direction at the horizon, are left out; the {} others are "
        "gridded by locally linear regression of the logarithm over the {} nearest, isotropic and reciprocal",
        parsed.samples.size(), kNeighbours);
    out.f = [grid](const Vec3& wi, const Vec3& wo) { return evaluate(*grid, wi, wo); };
    return out;
}

}  // namespace nacre
