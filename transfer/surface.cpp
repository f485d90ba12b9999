#include "transfer/surface.hpp"

#include <algorithm>
#include <cstring>
#include <unordered_map>

#include "core/parallel.hpp"

namespace nacre {
namespace {

bool hasNumbers(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

struct PositionHash {
    std::size_t operator()(const glm::vec3& p) const {
        std::uint32_t bits[3];
        const float plain[3] = {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};  // −0 and 0 are one place
        std::memcpy(bits, plain, sizeof(bits));
        return (bits[0] * 73856093ull) ^ (bits[1] * 19349663ull) ^ (bits[2] * 83492791ull);
    }
};

bool together(const AnimatedMesh& animation, std::uint32_t a, std::uint32_t b) {
    return std::all_of(animation.frames.begin(), animation.frames.end(), [&](const std::vector<glm::vec3>& frame) {
        return frame[a] == frame[b] || !hasNumbers(frame[a]) || !hasNumbers(frame[b]);
    });
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
    std::unordered_multimap<glm::vec3, std::uint32_t, PositionHash> seen;
    const std::vector<glm::vec3>& first = *std::max_element(
        animation.frames.begin(), animation.frames.end(), [](const auto& a, const auto& b) {
            return std::count_if(a.begin(), a.end(), hasNumbers) < std::count_if(b.begin(), b.end(), hasNumbers);
        });
    for (std::uint32_t v = 0; v < count; ++v) {
        const auto [begin, end] = seen.equal_range(first[v]);
        const auto same = std::find_if(begin, end, [&](const auto& entry) {
            return together(animation, mesh.firstOf[entry.second], v);
        });
        if (same != end) {
            mesh.weldOf[v] = same->second;
            continue;
        }
        mesh.weldOf[v] = static_cast<std::uint32_t>(mesh.firstOf.size());
        seen.emplace(first[v], mesh.weldOf[v]);
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

CornersOfVertices cornersOfVertices(std::span<const glm::uvec3> triangles, std::size_t vertices) {
    CornersOfVertices corners;
    corners.first.assign(vertices + 1, 0);
    for (const glm::uvec3& t : triangles)
        for (int c = 0; c < 3; ++c) ++corners.first[t[c] + 1];
    for (std::size_t v = 0; v < vertices; ++v) corners.first[v + 1] += corners.first[v];
    corners.order.resize(3 * triangles.size());
    std::vector<std::uint32_t> next(corners.first.begin(), corners.first.end() - 1);
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (std::uint32_t c = 0; c < 3; ++c) corners.order[next[triangles[t][static_cast<int>(c)]]++] = 3 * t + c;
    return corners;
}

static glm::vec3 vertexNormal(std::span<const glm::uvec3> triangles, std::span<const std::uint32_t> corners,
                              std::span<const glm::vec3> positions) {
    glm::dvec3 sum(0);
    for (const std::uint32_t corner : corners) {
        const glm::uvec3& t = triangles[corner / 3];
        const int c = static_cast<int>(corner % 3);
        const glm::dvec3 p = positions[t[c]];
        const glm::dvec3 a = glm::dvec3(positions[t[(c + 1) % 3]]) - p, b = glm::dvec3(positions[t[(c + 2) % 3]]) - p;
        const double weight = glm::dot(a, a) * glm::dot(b, b);
        if (weight > 0) sum += glm::cross(a, b) / weight;
    }
    const double length = glm::length(sum);
    return length > 0 && std::isfinite(length) ? glm::vec3(sum / length) : glm::vec3(0);
}

std::vector<glm::vec3> vertexNormals(std::span<const glm::uvec3> triangles, const CornersOfVertices& corners,
                                     std::span<const glm::vec3> positions, unsigned threads) {
    std::vector<glm::vec3> normals(positions.size());
    constexpr std::size_t kChunk = 256;
    parallelFor((positions.size() + kChunk - 1) / kChunk, threads, [&](std::size_t chunk) {
        for (std::size_t v = chunk * kChunk; v < std::min(positions.size(), (chunk + 1) * kChunk); ++v)
            normals[v] = vertexNormal(
                triangles, std::span(corners.order).subspan(corners.first[v], corners.first[v + 1] - corners.first[v]), positions);
    });
    return normals;
}

}  // namespace nacre
