#include "bump/scatter_plan.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/parallel.hpp"

namespace nacre {
namespace {

/// Change of height from the first to the second; 0 when either is no height.
double rise(float from, float to) { return std::isnan(from) || std::isnan(to) ? 0 : static_cast<double>(to) - from; }

bool fits(const Image& image, const HeightMap& map) {
    return image.width() == map.width() && image.height() == map.height();
}

/// The direction of `candidates` nearest to d; with `used`, of those not used yet.
std::size_t nearest(const ScatterMap& scatter, const std::vector<int>& candidates, const Vec3& d,
                    const std::vector<bool>* used = nullptr) {
    std::size_t best = candidates.size();
    double most = -2;
    for (std::size_t j = 0; j < candidates.size(); ++j) {
        const double cosine = glm::dot(d, scatter.directions[static_cast<std::size_t>(candidates[j])]);
        if (cosine > most && !(used && (*used)[j])) most = cosine, best = j;
    }
    return best;
}

/// `count` of `candidates` (sorted by z), those nearest to a spiral of the golden angle whose steps in z bring the same
/// light each. \param brings  light of each direction of the map
std::vector<int> choose(const ScatterMap& scatter, const std::vector<int>& candidates,
                        const std::vector<double>& brings, std::size_t count, double turn) {
    if (count >= candidates.size()) return candidates;
    double total = 0;
    for (const int k : candidates) total += brings[static_cast<std::size_t>(k)];
    std::vector<int> out;
    std::vector<bool> used(candidates.size(), false);
    std::size_t at = 0;
    double before = 0;  // of `at`
    for (std::size_t p = 0; p < count; ++p) {
        const double share = (static_cast<double>(p) + 0.5) / static_cast<double>(count) * total;
        while (at + 1 < candidates.size() && before + brings[static_cast<std::size_t>(candidates[at])] <= share)
            before += brings[static_cast<std::size_t>(candidates[at++])];
        const double z = scatter.directions[static_cast<std::size_t>(candidates[at])].z;
        const double across = std::sqrt(std::max(0.0, 1 - z * z));
        const double azimuth = 2 * kPi * (static_cast<double>(p) * (std::sqrt(5.0) - 1) / 2 + turn);
        const std::size_t j =
            nearest(scatter, candidates, {across * std::cos(azimuth), across * std::sin(azimuth), z}, &used);
        used[j] = true;
        out.push_back(candidates[j]);
    }
    return out;
}

ScatterBounce makeBounce(const ScatterMap& scatter, const std::vector<int>& candidates,
                         const std::vector<double>& brings, std::size_t count, double turn) {
    ScatterBounce out;
    out.directions = choose(scatter, candidates, brings, count, turn);
    out.weights.assign(out.directions.size(), 0);
    for (const int k : candidates) {
        const auto d = static_cast<std::size_t>(k);
        out.weights[nearest(scatter, out.directions, scatter.directions[d])] += scatter.weights[d];
    }
    return out;
}

/// Sets plan.hits. \return of each direction: Lambert's weights of all texels that hit there
std::vector<double> measureHits(const HeightMap& map, const ScatterMap& scatter, unsigned threads, ScatterPlan& plan) {
    const auto count = static_cast<std::size_t>(scatter.count());
    std::vector<std::vector<double>> rows(static_cast<std::size_t>(map.height()), std::vector<double>(count, 0));
    parallelFor(rows.size(), threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < map.width(); ++x) {
            if (std::isnan(map.heights.at(x, y, 0))) continue;
            double all = 0, hit = 0;
            for (std::size_t k = 0; k < count; ++k) {
                const double w = lambertWeight(plan.normals.rgb(x, y), scatter.directions[k], scatter.weights[k]);
                all += w;
                if (scatter.distance[k].at(x, y, 0) < 0) continue;
                hit += w;
                rows[row][k] += w;
            }
            plan.hits.at(x, y, 0) = static_cast<float>(all > 0 ? hit / all : 0);
        }
    });
    std::vector<double> out(count, 0);
    for (const std::vector<double>& row : rows)
        for (std::size_t k = 0; k < count; ++k) out[k] += row[k];
    return out;
}

}  // namespace

Vec3 reliefNormal(const HeightMap& map, int x, int y) {
    const float own = map.at(x, y);
    const auto slope = [own](float before, float after) {
        const double sides = std::isnan(before) || std::isnan(after) ? 1 : 2;
        return (rise(before, own) + rise(own, after)) / sides;
    };
    return glm::normalize(
        Vec3(-slope(map.at(x - 1, y), map.at(x + 1, y)), -slope(map.at(x, y - 1), map.at(x, y + 1)), 1));
}

glm::vec4 ownSlopes(const HeightMap& map, int x, int y) {
    const float own = map.at(x, y);
    return glm::vec4(rise(map.at(x - 1, y), own), rise(own, map.at(x + 1, y)), rise(map.at(x, y - 1), own),
                     rise(own, map.at(x, y + 1)));
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
    ScatterPlan out{options.normals, Image(map.width(), map.height(), 1), {}};
    if (out.normals.empty()) {
        out.normals = Image(map.width(), map.height(), 3);
        for (int y = 0; y < map.height(); ++y)
            for (int x = 0; x < map.width(); ++x) out.normals.setRgb(x, y, reliefNormal(map, x, y));
    }
    const std::vector<double> brings = measureHits(map, scatter, options.threads, out);
    std::vector<int> candidates;
    for (int k = 0; k < scatter.count(); ++k)
        if (brings[static_cast<std::size_t>(k)] > 0) candidates.push_back(k);
    std::stable_sort(candidates.begin(), candidates.end(), [&](int a, int b) {
        return scatter.directions[static_cast<std::size_t>(a)].z < scatter.directions[static_cast<std::size_t>(b)].z;
    });
    constexpr double kTurn = 0.38;  // of a turn between bounces, about the golden angle
    const double steps = static_cast<double>(options.paths) * options.bounces;
    for (int b = 0; b < options.bounces; ++b) {
        const double share = std::exp2(-b) / (2 - std::exp2(1 - options.bounces));
        const auto count = static_cast<std::size_t>(std::max<long>(1, std::lround(steps * share)));
        out.bounces.push_back(makeBounce(scatter, candidates, brings, count, kTurn * b));
    }
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
