#include "transfer/surface.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>
#include <unordered_map>

#include "core/parallel.hpp"

namespace nacre {
namespace {

bool hasNumbers(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// Positions by cubes of a grid.
class Grid {
public:
    explicit Grid(double step) : step_(step) {}
    void add(const glm::vec3& p, std::uint32_t v) { cells_.emplace(key(cell(p, 0)), v); }
    /// Calls use(v) for all within half a step, and others. \return whether a call said so
    template <class Use>
    bool near(const glm::vec3& p, const Use& use) const {
        const glm::dvec3 low = cell(p, -0.5), high = cell(p, 0.5);
        for (int corner = 0; corner < 8; ++corner) {
            const bool x = corner & 1, y = corner & 2, z = corner & 4;
            if ((x && low.x == high.x) || (y && low.y == high.y) || (z && low.z == high.z)) continue;
            const auto [begin, end] =
                cells_.equal_range(key({x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z}));
            if (std::any_of(begin, end, [&](const auto& entry) { return use(entry.second); })) return true;
        }
        return false;
    }

private:
    glm::dvec3 cell(const glm::vec3& p, double shift) const {
        return step_ > 0 ? glm::floor(glm::dvec3(p) / step_ + shift) : glm::dvec3(p);
    }
    static std::uint64_t key(const glm::dvec3& cell) {
        std::uint64_t out = 0;
        for (int k = 0; k < 3; ++k) {
            const double plain = cell[k] + 0.0;  // −0 and 0 are one place
            std::uint64_t bits;
            std::memcpy(&bits, &plain, sizeof(bits));
            out = (out ^ bits) * 0x9e3779b97f4a7c15ull;
            out ^= out >> 29;
        }
        return out;
    }

    double step_;
    std::unordered_multimap<std::uint64_t, std::uint32_t> cells_;
};

/// Longest edge of the box about the finite positions.
double extentOfFinite(const std::vector<glm::vec3>& positions) {
    glm::dvec3 low(std::numeric_limits<double>::max()), high(-low);
    for (const glm::vec3& p : positions)
        if (hasNumbers(p)) {
            low = glm::min(low, glm::dvec3(p));
            high = glm::max(high, glm::dvec3(p));
        }
    return std::max({high.x - low.x, high.y - low.y, high.z - low.z, 0.0});
}

constexpr double kOnePlace = 1e-5;  ///< [of the extent]

/// \param extents  [frame]
bool together(const AnimatedMesh& animation, const std::vector<double>& extents, std::uint32_t a, std::uint32_t b) {
    for (std::size_t f = 0; f < animation.frames.size(); ++f) {
        const glm::vec3 &p = animation.frames[f][a], &q = animation.frames[f][b];
        if (hasNumbers(p) && hasNumbers(q) && glm::distance(glm::dvec3(p), glm::dvec3(q)) > kOnePlace * extents[f])
            return false;
    }
    return true;
}

/// Each edge runs once in each direction.
bool isClosed(const std::vector<glm::uvec3>& triangles) {
    std::unordered_map<std::uint64_t, int> runs;
    for (const glm::uvec3& t : triangles)
        for (int c = 0; c < 3; ++c) ++runs[(std::uint64_t{t[c]} << 32) | t[(c + 1) % 3]];
    return !triangles.empty() && std::all_of(runs.begin(), runs.end(), [&](const auto& run) {
        const auto opposite = runs.find((run.first << 32) | (run.first >> 32));
        return run.second == 1 && opposite != runs.end() && opposite->second == 1;
    });
}

}  // namespace

WeldedMesh weldMesh(const AnimatedMesh& animation, const std::string& name) {
    checkAnimation(animation, name);
    const std::size_t count = animation.vertexCount();
    WeldedMesh mesh;
    mesh.weldOf.resize(count);
    std::vector<double> extents;
    for (const std::vector<glm::vec3>& frame : animation.frames) extents.push_back(extentOfFinite(frame));
    const auto best =
        std::max_element(animation.frames.begin(), animation.frames.end(), [](const auto& a, const auto& b) {
            return std::count_if(a.begin(), a.end(), hasNumbers) < std::count_if(b.begin(), b.end(), hasNumbers);
        });
    Grid grid(2 * kOnePlace * extents[static_cast<std::size_t>(best - animation.frames.begin())]);
    for (std::uint32_t v = 0; v < count; ++v) {
        const glm::vec3 at = hasNumbers((*best)[v]) ? (*best)[v] : glm::vec3(0);
        const bool found = grid.near(at, [&](std::uint32_t other) {
            if (!together(animation, extents, mesh.firstOf[other], v)) return false;
            mesh.weldOf[v] = other;
            return true;
        });
        if (found) continue;
        mesh.weldOf[v] = static_cast<std::uint32_t>(mesh.firstOf.size());
        grid.add(at, mesh.weldOf[v]);
        mesh.firstOf.push_back(v);
    }
    for (const glm::uvec3& t : animation.triangles) {
        const glm::uvec3 w{mesh.weldOf[t.x], mesh.weldOf[t.y], mesh.weldOf[t.z]};
        if (w.x != w.y && w.y != w.z && w.z != w.x) mesh.triangles.push_back(w);
    }
    mesh.closed = isClosed(mesh.triangles);
    return mesh;
}

std::vector<glm::vec3> weldedPositions(const WeldedMesh& mesh, std::span<const glm::vec3> frame) {
    std::vector<glm::vec3> positions(mesh.vertexCount());
    for (std::size_t v = 0; v < positions.size(); ++v) positions[v] = frame[mesh.firstOf[v]];
    return positions;
}

std::vector<std::vector<glm::vec3>> motionPoses(const WeldedMesh& mesh, const AnimatedMesh& animation) {
    constexpr std::size_t kPoses = 5;
    const std::size_t count = std::min(kPoses, animation.frames.size());
    std::vector<std::vector<glm::vec3>> out;
    for (std::size_t i = 0; i < count; ++i) {
        const std::vector<glm::vec3>& frame = animation.frames[animation.frames.size() * i / count];
        if (std::all_of(frame.begin(), frame.end(), [](const glm::vec3& p) { return isFinite(Vec3(p)); }))
            out.push_back(weldedPositions(mesh, frame));
    }
    return out;
}

CornersOfVertices cornersOfVertices(std::span<const glm::uvec3> triangles, std::size_t vertices) {
    CornersOfVertices corners;
    corners.first.assign(vertices + 1, 0);
    for (const glm::uvec3& t : triangles)
        for (int c = 0; c < 3; ++c) ++corners.first[t[c] + 1];
    for (std::size_t v = 0; v < vertices; ++v) corners.first[v + 1] += corners.first[v];
    corners.order.resize(3 * triangles.size());
    corners.others.resize(3 * triangles.size());
    std::vector<std::uint32_t> next(corners.first.begin(), corners.first.end() - 1);
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (std::uint32_t c = 0; c < 3; ++c) {
            const glm::uvec3& of = triangles[t];
            const std::uint32_t at = next[of[static_cast<int>(c)]]++;
            corners.order[at] = 3 * t + c;
            corners.others[at] = {of[static_cast<int>((c + 1) % 3)], of[static_cast<int>((c + 2) % 3)]};
        }
    return corners;
}

std::vector<std::uint32_t> connectedParts(std::span<const glm::uvec3> triangles, std::size_t vertices) {
    std::vector<std::uint32_t> parent(vertices);
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (const glm::uvec3& t : triangles)
        for (int c = 1; c < 3; ++c) {
            const std::uint32_t a = root(t[0]), b = root(t[c]);
            parent[std::max(a, b)] = std::min(a, b);
        }
    for (std::uint32_t v = 0; v < vertices; ++v) parent[v] = root(v);
    return parent;
}

glm::vec3 vertexNormal(const CornersOfVertices& corners, std::size_t vertex, std::span<const glm::vec3> positions) {
    constexpr double kResidue = 1e-10;  // of what cancels: faces that lie on each other have no side
    glm::dvec3 sum(0);
    double sizes = 0;
    const glm::dvec3 p = positions[vertex];
    for (std::uint32_t i = corners.first[vertex]; i < corners.first[vertex + 1]; ++i) {
        const glm::dvec3 a = glm::dvec3(positions[corners.others[i].x]) - p,
                         b = glm::dvec3(positions[corners.others[i].y]) - p;
        const double weight = glm::dot(a, a) * glm::dot(b, b);
        if (!(weight > 0)) continue;
        const glm::dvec3 part = glm::cross(a, b) / weight;
        sum += part;
        sizes += std::abs(part.x) + std::abs(part.y) + std::abs(part.z);
    }
    const double length = glm::length(sum);
    return length > kResidue * sizes && std::isfinite(length) ? glm::vec3(sum / length) : glm::vec3(0);
}

std::vector<glm::vec3> vertexNormals(std::span<const glm::uvec3>, const CornersOfVertices& corners,
                                     std::span<const glm::vec3> positions, unsigned threads) {
    std::vector<glm::vec3> normals(positions.size());
    constexpr std::size_t kChunk = 256;
    parallelFor((positions.size() + kChunk - 1) / kChunk, threads, [&](std::size_t chunk) {
        for (std::size_t v = chunk * kChunk; v < std::min(positions.size(), (chunk + 1) * kChunk); ++v)
            normals[v] = vertexNormal(corners, v, positions);
    });
    return normals;
}

}  // namespace nacre
