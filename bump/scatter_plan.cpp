#include "bump/scatter_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "bump/normals.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"

namespace nacre {
namespace {

constexpr double kDeeper = 1.0 / 3;  // of the steps, for all bounces but the viewed one

/// Change of height from the first to the second; 0 when either is no height.
double rise(float from, float to) { return std::isnan(from) || std::isnan(to) ? 0 : static_cast<double>(to) - from; }

bool fits(const Image& image, const HeightMap& map) {
    return image.width() == map.width() && image.height() == map.height();
}

/// Place of a cell on Hilbert's curve through 2^kLevels × 2^kLevels cells: neighbours on the curve are neighbours.
std::uint32_t hilbertPlace(std::uint32_t x, std::uint32_t y) {
    constexpr int kLevels = 10;
    std::uint32_t out = 0;
    for (std::uint32_t half = 1u << (kLevels - 1); half > 0; half /= 2) {
        const std::uint32_t right = (x & half) > 0, up = (y & half) > 0;
        out += half * half * ((3 * right) ^ up);
        if (!up) {
            if (right) x = ~x, y = ~y;
            std::swap(x, y);
        }
    }
    return out;
}

/// The map's directions along a curve through azimuth and rank in z: every n-th one is a stratified choice.
std::vector<int> alongCurve(const ScatterMap& scatter) {
    const auto count = static_cast<std::size_t>(scatter.count());
    std::vector<int> byZ(count);
    std::iota(byZ.begin(), byZ.end(), 0);
    std::stable_sort(byZ.begin(), byZ.end(), [&](int a, int b) {
        return scatter.directions[static_cast<std::size_t>(a)].z < scatter.directions[static_cast<std::size_t>(b)].z;
    });
    std::vector<std::pair<std::uint32_t, int>> places;
    for (std::size_t rank = 0; rank < count; ++rank) {
        const Vec3& d = scatter.directions[static_cast<std::size_t>(byZ[rank])];
        const double turn = std::atan2(d.y, d.x) / (2 * kPi) + 0.5;
        places.emplace_back(hilbertPlace(static_cast<std::uint32_t>(std::min(1023.0, turn * 1024)),
                                         static_cast<std::uint32_t>(rank * 1024 / count)),
                            byZ[rank]);
    }
    std::sort(places.begin(), places.end());
    std::vector<int> out;
    for (const auto& [place, k] : places) out.push_back(k);
    return out;
}

/// In [0, 1), another one for each: R2 of the texel, so that neighbours differ most.
double phaseOf(int x, int y, int turn) {
    const double phase = 0.7548776662466927 * x + 0.5698402909980532 * y + 0.3819660112501051 * turn;
    return phase - std::floor(phase);
}

/// What all texels share, in the order of the curve.
struct Curve {
    explicit Curve(const ScatterMap& scatter) {
        for (const int k : alongCurve(scatter)) {
            const Vec3& d = scatter.directions[static_cast<std::size_t>(k)];
            directions.emplace_back(d);
            weights.push_back(static_cast<float>(scatter.weights[static_cast<std::size_t>(k)]));
            along.emplace_back(seenPoint(0, 0, d, 1) - Vec2(0.5));
            patch.push_back((d.x > 0 ? 1 : 0) + (d.y > 0 ? 2 : 0));
            distances.push_back(scatter.distance[static_cast<std::size_t>(k)].data().data());
        }
    }
    std::vector<glm::vec3> directions;
    std::vector<float> weights;
    std::vector<glm::vec2> along;
    std::vector<int> patch;
    std::vector<const float*> distances;
};

/// A texel's distances in the order of the curve, and room for its weights.
struct Sight {
    std::vector<float> distances, weights;
};

/// Texel i's part of SeenPoints.
void seeFrom(const Curve& curve, Sight& sight, const glm::vec3& normal, double phase, std::size_t i, SeenPoints& out) {
    const std::size_t count = curve.weights.size();
    double all = 0, away = 0;
    std::array<double, 4> own{};
    for (std::size_t j = 0; j < count; ++j) {
        const float w = curve.weights[j] * std::max(0.0f, glm::dot(normal, curve.directions[j]));
        const float distance = sight.distances[j];
        all += w;
        sight.weights[j] = distance > 0 ? w : 0;
        away += sight.weights[j];
        if (distance == 0) own[static_cast<std::size_t>(curve.patch[j])] += w;
    }
    if (all <= 0) return;
    out.share[i] = static_cast<float>(away / all);
    for (int q = 0; q < 4; ++q) out.own[i][q] = static_cast<float>(own[static_cast<std::size_t>(q)] / all);
    if (away <= 0) return;
    // Equal steps of the summed weights: as many points of a direction as its weight has steps.
    std::uint32_t* to = out.offsets.data() + i * static_cast<std::size_t>(out.count);
    const double step = away / out.count;
    double before = 0;
    int n = 0;
    for (std::size_t j = 0; j < count && n < out.count; ++j) {
        before += sight.weights[j];
        if ((n + phase) * step >= before) continue;
        const std::uint32_t offset = glm::packHalf2x16(curve.along[j] * sight.distances[j]);
        while (n < out.count && (n + phase) * step < before) to[n++] = offset;
    }
    for (; n < out.count; ++n) to[n] = to[n - 1];  // rounding
}

SeenPoints noPoints(int count, std::size_t texels) {
    return {count, std::vector<std::uint32_t>(static_cast<std::size_t>(count) * texels, 0),
            std::vector<float>(texels, 0), std::vector<glm::vec4>(texels, glm::vec4(0))};
}

}  // namespace

glm::vec4 ownSlopes(const HeightMap& map, int x, int y) {
    const float own = map.at(x, y);
    return glm::vec4(rise(map.at(x - 1, y), own), rise(own, map.at(x + 1, y)), rise(map.at(x, y - 1), own),
                     rise(own, map.at(x, y + 1)));
}

HeightMap reliefPeriod(const HeightMap& map) {
    if (map.wrap != Wrap::Mirror) return map;
    HeightMap out{Image(2 * map.width(), 2 * map.height(), 1), Wrap::Repeat};
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x) out.heights.at(x, y, 0) = map.at(x, y);
    return out;
}

HeightMap refinedRelief(const HeightMap& map, int k) {
    validateHeightMap(map);
    require(k >= 1 && k % 2 == 1, fmt::format("refinedRelief: expected an odd k >= 1, found {}", k));
    HeightMap out{Image(map.width() * k, map.height() * k, 1), map.wrap};
    const auto place = [k](int i) { return i % k == k / 2 ? i / k + 0.5 : (i + 0.5) / k; };  // centres exactly
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x)
            out.heights.at(x, y, 0) = static_cast<float>(k * heightAt(map, {place(x), place(y)}));
    return out;
}

Image litMask(const HeightMap& map, const Vec3& light, unsigned threads) {
    const std::vector<float> distances = rayDistances(map, light, threads);
    Image out(map.width(), map.height(), 1);
    for (std::size_t i = 0; i < distances.size(); ++i)
        out.data()[i] = distances[i] < 0 && light.z >= 0 && !std::isnan(map.heights.data()[i]) ? 1.0f : 0.0f;
    return out;
}

double lambertWeight(const Vec3& normal, const Vec3& direction, double weight) {
    return weight / kPi * std::max(0.0, glm::dot(normal, direction));
}

void validateScatterMap(const HeightMap& map, const ScatterMap& scatter) {
    require(scatter.count() >= 1 && scatter.weights.size() == scatter.directions.size() &&
                scatter.distance.size() == scatter.directions.size(),
            "scatter map: expected one direction or more, and weights and distances of each");
    for (const Image& image : scatter.distance)
        require(fits(image, map) && image.channels() == 1,
                fmt::format("scatter map: expected distances of the relief's size {} x {}, found {} x {}", map.width(),
                            map.height(), image.width(), image.height()));
}

ScatterPlan planScatter(const HeightMap& map, const ScatterMap& scatter, const ScatterPlanOptions& options) {
    validateHeightMap(map);
    validateScatterMap(map, scatter);
    require(options.bounces >= 0 && options.paths >= 1,
            fmt::format("planScatter: expected bounces >= 0 and paths >= 1, found {} and {}", options.bounces,
                        options.paths));
    require(options.normals.empty() || (fits(options.normals, map) && options.normals.channels() >= 3),
            "planScatter: expected normals as an RGB image of the relief's size");
    ScatterPlan out{options.normals, {}, {}};
    if (out.normals.empty()) {
        out.normals = makeNormals(map, {.levels = false, .threads = options.threads}).levels[0];
    }
    if (options.bounces == 0) return out;
    const int steps = options.paths * options.bounces, deeper = options.bounces - 1;
    const int patchPoints = deeper > 0 ? std::max(1, static_cast<int>(steps * kDeeper / (4 * deeper))) : 0;
    const std::size_t texels = map.heights.texelCount();
    out.viewed = noPoints(std::max(1, steps - 4 * deeper * patchPoints), texels);
    for (SeenPoints& points : out.patches) points = noPoints(patchPoints, deeper > 0 ? texels : 0);
    const Curve curve(scatter);
    parallelFor(static_cast<std::size_t>(map.height()), options.threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        const std::size_t directions = curve.weights.size();
        Sight sight{std::vector<float>(directions), std::vector<float>(directions)};
        for (int x = 0; x < map.width(); ++x) {
            if (std::isnan(map.heights.at(x, y, 0))) continue;
            const std::size_t i = row * static_cast<std::size_t>(map.width()) + static_cast<std::size_t>(x);
            for (std::size_t j = 0; j < directions; ++j) sight.distances[j] = curve.distances[j][i];
            seeFrom(curve, sight, out.normals.rgb(x, y), phaseOf(x, y, 0), i, out.viewed);
            const std::array<Vec3, 4> normals = ownNormals(ownSlopes(map, x, y));
            for (std::size_t q = 0; q < 4 && deeper > 0; ++q) {
                seeFrom(curve, sight, normals[q], phaseOf(x, y, static_cast<int>(q) + 1), i, out.patches[q]);
                out.patches[q].share[i] += out.patches[q].own[i][static_cast<int>(q)];  // rounding
                out.patches[q].own[i][static_cast<int>(q)] = 0;
            }
        }
    });
    return out;
}

std::array<Vec3, 4> ownNormals(const glm::vec4& slopes) {
    std::array<Vec3, 4> out;
    for (int q = 0; q < 4; ++q)
        out[static_cast<std::size_t>(q)] = glm::normalize(Vec3(-slopes[q % 2], -slopes[2 + q / 2], 1));
    return out;
}

std::vector<int> scatterPaths(int directions, int paths, int depth) {
    require(directions >= 1 && paths >= 1 && depth >= 1, "scatterPaths: expected numbers >= 1");
    double phi = 2;  // the root of x^depth = x + 1: R_d of depth − 1 dimensions
    for (int i = 0; i < 60; ++i) phi = std::pow(1 + phi, 1.0 / depth);
    std::vector<int> out;
    for (int p = 0; p < paths; ++p) {
        out.push_back(static_cast<int>((p + 0.5) / paths * directions));
        for (int b = 1; b < depth; ++b) {
            const double u = 0.5 + (p + 1) * std::pow(phi, -b);
            out.push_back(std::min(directions - 1, static_cast<int>((u - std::floor(u)) * directions)));
        }
    }
    return out;
}

}  // namespace nacre
