#include "transfer/blocker_levels.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "transfer/mask_tables.hpp"
#include "transfer/receiver_groups.hpp"

namespace nacre {
namespace {

/// Edge collapses (Garland & Heckbert 1997, by meshoptimizer) until `count` triangles are left, or no more can go.
std::vector<glm::uvec3> simplified(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> positions,
                                   std::size_t count) {
    std::vector<unsigned> indices(3 * triangles.size());
    const std::size_t left = meshopt_simplify(indices.data(), &triangles[0].x, 3 * triangles.size(), &positions[0].x,
                                              positions.size(), sizeof(glm::vec3), 3 * count, 1e10f, 0, nullptr);
    std::vector<glm::uvec3> out;
    for (std::size_t i = 0; i + 2 < left; i += 3) out.emplace_back(indices[i], indices[i + 1], indices[i + 2]);
    return out;
}

/// Adds the triangles of those connected parts that have none left.
void keepParts(std::vector<glm::uvec3>& triangles, const std::vector<glm::uvec3>& finer,
               std::span<const std::uint32_t> parts) {
    std::vector<std::uint8_t> left(parts.size(), 0);
    for (const glm::uvec3& t : triangles) left[parts[t.x]] = 1;
    for (const glm::uvec3& t : finer)
        if (!left[parts[t.x]]) triangles.push_back(t);
}

constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

struct NearPoint {
    double distanceSquared = 0;
    glm::dvec3 weights{0};  ///< barycentric
};

/// The point of triangle abc nearest to p: by the regions of its corners and edges (Ericson 2004, section 5.1.5).
NearPoint nearestOn(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 ab = b - a, ac = c - a, ap = p - a;
    const auto at = [&](double v, double w) {
        const glm::dvec3 d = ap - v * ab - w * ac;
        return NearPoint{glm::dot(d, d), {1 - v - w, v, w}};
    };
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return at(0, 0);
    const glm::dvec3 bp = p - b, cp = p - c;
    const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp), d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d3 >= 0 && d4 <= d3) return at(1, 0);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return at(d1 / (d1 - d3), 0);
    if (d6 >= 0 && d5 <= d6) return at(0, 1);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return at(0, d2 / (d2 - d6));
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return at(1 - w, w);
    }
    const double sum = va + vb + vc;
    return sum > 0 ? at(vb / sum, vc / sum) : at(0, 0);
}

struct Ball {
    glm::dvec3 centre{0};
    double radius = 0;
};
std::vector<Ball> ballsAbout(const std::vector<glm::uvec3>& triangles, std::span<const glm::vec3> points) {
    std::vector<Ball> out;
    for (const glm::uvec3& t : triangles) {
        const glm::dvec3 a = points[t.x], b = points[t.y], c = points[t.z], m = (a + b + c) / 3.0;
        out.push_back({m, std::max({glm::distance(a, m), glm::distance(b, m), glm::distance(c, m)})});
    }
    return out;
}

/// For each vertex the level's triangle nearest to it among those of its connected part that face its way, else the
/// nearest of the part.
struct Standing {
    std::vector<std::uint32_t> triangle;
    std::vector<glm::dvec3> weights;
};
Standing standing(const std::vector<glm::uvec3>& triangles, std::span<const glm::vec3> rest,
                  std::span<const glm::vec3> normals, std::span<const std::uint32_t> parts) {
    struct Cluster {
        Ball ball;
        std::vector<std::uint32_t> triangles;
    };
    const std::vector<Ball> balls = ballsAbout(triangles, rest);
    std::vector<std::vector<std::uint32_t>> ofPart(rest.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i) ofPart[parts[triangles[i].x]].push_back(i);
    std::vector<std::vector<Cluster>> clusters(rest.size());  // [part]
    for (std::size_t part = 0; part < ofPart.size(); ++part) {
        std::vector<glm::vec3> middles;
        for (const std::uint32_t t : ofPart[part]) middles.emplace_back(balls[t].centre);
        const std::vector<glm::vec3> alike(middles.size(), glm::vec3(0, 0, 1));
        for (const std::vector<std::uint32_t>& group : groupReceivers(middles, alike, kLanes)) {
            Cluster& cluster = clusters[part].emplace_back();
            for (const std::uint32_t i : group) {
                cluster.triangles.push_back(ofPart[part][i]);
                cluster.ball.centre += glm::dvec3(middles[i]) / static_cast<double>(group.size());
            }
            for (const std::uint32_t t : cluster.triangles)
                cluster.ball.radius = std::max(cluster.ball.radius,
                                               glm::distance(cluster.ball.centre, balls[t].centre) + balls[t].radius);
        }
    }
    Standing out{std::vector<std::uint32_t>(rest.size()), std::vector<glm::dvec3>(rest.size())};
    parallelFor(rest.size(), 0, [&](std::size_t v) {
        constexpr double kNone = std::numeric_limits<double>::max();
        const glm::dvec3 p = rest[v], n = normals[v];
        double best[2] = {kNone, kNone};
        std::uint32_t triangle[2] = {0, 0};
        glm::dvec3 weights[2] = {glm::dvec3(1, 0, 0), glm::dvec3(1, 0, 0)};
        const auto mayBeNearer = [&](const Ball& ball) {
            const double away = glm::distance(p, ball.centre) - ball.radius,
                         bound = best[0] < kNone ? best[0] : best[1];
            return away <= 0 || away * away < bound;
        };
        const auto look = [&](const Cluster& cluster) {
            for (const std::uint32_t t : cluster.triangles) {
                if (!mayBeNearer(balls[t])) continue;
                const glm::uvec3& i = triangles[t];
                const NearPoint near = nearestOn(p, rest[i.x], rest[i.y], rest[i.z]);
                const glm::dvec3 a = rest[i.x],
                                 across = glm::cross(glm::dvec3(rest[i.y]) - a, glm::dvec3(rest[i.z]) - a);
                const int other = glm::dot(across, n) > 0 ? 0 : 1;
                if (near.distanceSquared > best[other] || (near.distanceSquared == best[other] && t > triangle[other]))
                    continue;
                best[other] = near.distanceSquared;
                triangle[other] = t;
                weights[other] = near.weights;
            }
        };
        const std::vector<Cluster>& some = clusters[parts[v]];
        const auto nearest = std::min_element(some.begin(), some.end(), [&](const Cluster& x, const Cluster& y) {
            const glm::dvec3 dx = x.ball.centre - p, dy = y.ball.centre - p;
            return glm::dot(dx, dx) < glm::dot(dy, dy);
        });
        if (nearest != some.end()) look(*nearest);
        for (const Cluster& cluster : some)
            if (mayBeNearer(cluster.ball)) look(cluster);
        const int chosen = best[0] < kNone ? 0 : 1;
        out.triangle[v] = triangle[chosen];
        out.weights[v] = weights[chosen];
    });
    return out;
}

/// Least squares by relaxation: Σ_i w_i push_i is the height over the level's triangle, for each vertex of the mesh.
std::vector<float> fittedPush(const std::vector<glm::uvec3>& triangles, const Standing& stands,
                              std::span<const glm::vec3> rest) {
    std::vector<double> push(rest.size(), 0), sum(rest.size()), weight(rest.size());
    constexpr int kRounds = 12;
    for (int round = 0; round < kRounds; ++round) {
        std::fill(sum.begin(), sum.end(), 0.0);
        std::fill(weight.begin(), weight.end(), 0.0);
        for (std::size_t v = 0; v < rest.size(); ++v) {
            const glm::uvec3& t = triangles[stands.triangle[v]];
            const glm::dvec3 a = rest[t.x], cross = glm::cross(glm::dvec3(rest[t.y]) - a, glm::dvec3(rest[t.z]) - a);
            const double length = glm::length(cross);
            if (!(length > 0)) continue;
            double missing = glm::dot(glm::dvec3(rest[v]) - a, cross) / length;
            for (int c = 0; c < 3; ++c) missing -= stands.weights[v][c] * push[t[c]];
            for (int c = 0; c < 3; ++c) {
                sum[t[c]] += stands.weights[v][c] * missing;
                weight[t[c]] += stands.weights[v][c];
            }
        }
        for (std::size_t v = 0; v < rest.size(); ++v)
            if (weight[v] > 0) push[v] += sum[v] / weight[v];
    }
    const float extent = extentOf(rest);
    std::vector<float> out(rest.size());
    for (std::size_t v = 0; v < rest.size(); ++v) out[v] = extent > 0 ? static_cast<float>(push[v] / extent) : 0.0f;
    return out;
}

BlockerLevels::Level levelOf(std::vector<glm::uvec3> triangles, std::span<const glm::vec3> rest,
                             std::span<const glm::vec3> normals, std::span<const std::uint32_t> parts) {
    const Standing stands = standing(triangles, rest, normals, parts);
    std::vector<float> push = fittedPush(triangles, stands, rest);
    return {std::move(triangles), std::move(push), stands.triangle, {}};
}

/// How far each patch's surfaces at a level and in the mesh are from each other at rest, either way [of the extent].
/// Triangles are measured at their corners, middles of edges and centre, against the mesh where it belongs to the
/// patches of their corners.
std::vector<float> restErrors(const BlockerLevels& levels, std::size_t l, std::span<const glm::vec3> rest,
                              float extent) {
    const BlockerLevels::Level &level = levels.levels[l], &mesh = levels.levels[0];
    const std::vector<glm::vec3> at =
        pushedPositions(level, cornersOfVertices(level.triangles, rest.size()), rest, extent);
    const auto away = [](const glm::dvec3& x, const glm::uvec3& t, std::span<const glm::vec3> p) {
        return nearestOn(x, p[t.x], p[t.y], p[t.z]).distanceSquared;
    };
    const std::vector<Ball> balls = ballsAbout(mesh.triangles, rest);
    std::vector<double> ofTriangle(level.triangles.size());
    parallelFor(ofTriangle.size(), 0, [&](std::size_t i) {
        const glm::uvec3& t = level.triangles[i];
        const glm::dvec3 a = at[t.x], b = at[t.y], c = at[t.z];
        for (const glm::dvec3& x : {a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), (a + b + c) / 3.0}) {
            double nearest = std::numeric_limits<double>::max();
            for (int k = 0; k < 3; ++k)
                for (const std::uint32_t f : levels.patches[levels.levels.back().triangleOf[t[k]]].triangles[0]) {
                    const glm::dvec3 d = x - balls[f].centre;
                    const double within = std::sqrt(nearest) + balls[f].radius;
                    if (glm::dot(d, d) < within * within) nearest = std::min(nearest, away(x, mesh.triangles[f], rest));
                }
            ofTriangle[i] = std::max(ofTriangle[i], nearest);
        }
    });
    std::vector<float> out;
    for (const BlockerLevels::Patch& patch : levels.patches) {
        double most = 0;
        for (const std::uint32_t t : patch.triangles[l]) most = std::max(most, ofTriangle[t]);
        for (const std::uint32_t v : patch.vertices)
            most = std::max(most, away(rest[v], level.triangles[level.triangleOf[v]], at));
        out.push_back(extent > 0 ? static_cast<float>(std::sqrt(most)) / extent : 0.0f);
    }
    return out;
}

/// For triangles of a level that stand for no vertex: the nearest vertex of their corners' patches, else kNoVertex.
std::vector<std::uint32_t> nearestVertices(const BlockerLevels& levels, std::size_t l,
                                           std::span<const glm::vec3> rest) {
    const BlockerLevels::Level& level = levels.levels[l];
    std::vector<std::uint32_t> out(level.triangles.size(), kNoVertex);
    std::vector<std::uint8_t> stands(out.size(), 0);
    for (const std::uint32_t t : level.triangleOf) stands[t] = 1;
    parallelFor(out.size(), 0, [&](std::size_t i) {
        if (stands[i]) return;
        const glm::uvec3& t = level.triangles[i];
        const glm::vec3 middle = (rest[t.x] + rest[t.y] + rest[t.z]) / 3.0f;
        float best = std::numeric_limits<float>::max();
        for (int c = 0; c < 3; ++c)
            for (const std::uint32_t v : levels.patches[levels.levels.back().triangleOf[t[c]]].vertices) {
                if (v == t.x || v == t.y || v == t.z) continue;
                const glm::vec3 d = rest[v] - middle;
                if (glm::dot(d, d) >= best) continue;
                best = glm::dot(d, d);
                out[i] = v;
            }
    });
    return out;
}

/// Numbers the triangles of the level so that those near each other follow each other.
void sortInSpace(BlockerLevels::Level& level, std::span<const glm::vec3> rest) {
    std::vector<glm::vec3> middles, normals;
    for (const glm::uvec3& t : level.triangles) {
        middles.push_back((rest[t.x] + rest[t.y] + rest[t.z]) / 3.0f);
        const glm::vec3 n = glm::cross(rest[t.y] - rest[t.x], rest[t.z] - rest[t.x]);
        normals.push_back(glm::dot(n, n) > 0 ? glm::normalize(n) : glm::vec3(0, 0, 1));
    }
    std::vector<glm::uvec3> sorted;
    std::vector<std::uint32_t> numberOf(middles.size());
    for (const std::vector<std::uint32_t>& one : groupReceivers(middles, normals, 1)) {
        numberOf[one[0]] = static_cast<std::uint32_t>(sorted.size());
        sorted.push_back(level.triangles[one[0]]);
    }
    level.triangles = std::move(sorted);
    for (std::uint32_t& t : level.triangleOf) t = numberOf[t];
}

}  // namespace

float extentOf(std::span<const glm::vec3> positions) {
    if (positions.empty()) return 0;
    glm::vec3 low = positions[0], high = low;
    for (const glm::vec3& p : positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    return std::max({high.x - low.x, high.y - low.y, high.z - low.z});
}

BlockerLevels makeBlockerLevels(const WeldedMesh& mesh, std::span<const glm::vec3> rest,
                                const BlockerLevelOptions& options) {
    BlockerLevels out;
    const std::size_t fine = mesh.triangles.size();
    out.levels.push_back({mesh.triangles, std::vector<float>(rest.size(), 0), {}, {}});
    const std::vector<glm::vec3> normals =
        vertexNormals(mesh.triangles, cornersOfVertices(mesh.triangles, rest.size()), rest);
    const std::vector<std::uint32_t> parts = connectedParts(mesh.triangles, rest.size());
    if (options.coarse > 0 && options.coarse < fine) {
        const double steps =
            std::max(1.0, std::round(std::log(static_cast<double>(fine) / static_cast<double>(options.coarse)) /
                                     std::log(options.ratio)));
        for (double step = 1; step <= steps; ++step) {
            const auto count = static_cast<std::size_t>(
                static_cast<double>(fine) *
                std::pow(static_cast<double>(options.coarse) / static_cast<double>(fine), step / steps));
            std::vector<glm::uvec3> triangles = simplified(mesh.triangles, rest, count);
            keepParts(triangles, out.levels.back().triangles, parts);
            if (!triangles.empty() && triangles.size() < out.levels.back().triangles.size())
                out.levels.push_back(levelOf(std::move(triangles), rest, normals, parts));
        }
    }
    if (out.levels.size() > 1) sortInSpace(out.levels.back(), rest);
    const BlockerLevels::Level& coarsest = out.levels.back();
    out.patches.resize(coarsest.triangles.size());
    for (std::uint32_t p = 0; p < out.patches.size(); ++p) {
        out.patches[p].triangles.resize(out.levels.size());
        out.patches[p].triangles.back() = {p};
    }
    if (out.levels.size() == 1) {  // each triangle for itself
        for (std::size_t p = 0; p < out.patches.size(); ++p)
            for (int c = 0; c < 3; ++c) out.patches[p].vertices.push_back(coarsest.triangles[p][c]);
        return out;
    }
    for (std::uint32_t v = 0; v < rest.size(); ++v) out.patches[coarsest.triangleOf[v]].vertices.push_back(v);
    for (std::size_t level = 0; level + 1 < out.levels.size(); ++level)
        for (std::uint32_t t = 0; t < out.levels[level].triangles.size(); ++t) {
            std::uint32_t patch[3];
            for (int c = 0; c < 3; ++c) patch[c] = coarsest.triangleOf[out.levels[level].triangles[t][c]];
            for (int c = 0; c < 3; ++c)
                if (std::find(patch, patch + c, patch[c]) == patch + c)
                    out.patches[patch[c]].triangles[level].push_back(t);
        }
    // A long triangle may lie over a patch without a corner in it: what stands for the patch's vertices belongs to it.
    for (std::size_t level = 1; level + 1 < out.levels.size(); ++level)
        for (BlockerLevels::Patch& patch : out.patches) {
            std::vector<std::uint32_t>& triangles = patch.triangles[level];
            for (const std::uint32_t v : patch.vertices) triangles.push_back(out.levels[level].triangleOf[v]);
            std::sort(triangles.begin(), triangles.end());
            triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
        }
    for (BlockerLevels::Patch& patch : out.patches) patch.nearest.resize(out.levels.size());
    for (std::size_t level = 1; level < out.levels.size(); ++level) {
        const std::vector<std::uint32_t> nearest = nearestVertices(out, level, rest);
        for (BlockerLevels::Patch& patch : out.patches)
            for (const std::uint32_t t : patch.triangles[level])
                if (nearest[t] != kNoVertex) patch.nearest[level].emplace_back(nearest[t], t);
    }
    for (std::size_t level = 1; level < out.levels.size(); ++level)
        out.levels[level].restError = restErrors(out, level, rest, extentOf(rest));
    return out;
}

std::vector<glm::vec3> pushedPositions(const BlockerLevels::Level& level, const CornersOfVertices& corners,
                                       std::span<const glm::vec3> positions, float extent) {
    std::vector<glm::vec3> out = vertexNormals(level.triangles, corners, positions);
    for (std::size_t v = 0; v < out.size(); ++v) out[v] = positions[v] + level.push[v] * extent * out[v];
    return out;
}

}  // namespace nacre
