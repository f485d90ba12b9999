#include "transfer/surface.hpp"

#include <algorithm>
#include <cstring>
#include <unordered_map>

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
    const std::vector<glm::vec3>& first =
        *std::max_element(animation.frames.begin(), animation.frames.end(), [](const auto& a, const auto& b) {
            return std::count_if(a.begin(), a.end(), hasNumbers) < std::count_if(b.begin(), b.end(), hasNumbers);
        });
    for (std::uint32_t v = 0; v < count; ++v) {
        const auto [begin, end] = seen.equal_range(first[v]);
        const auto same = std::find_if(
            begin, end, [&](const auto& entry) { return together(animation, mesh.firstOf[entry.second], v); });
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

std::vector<glm::vec3> angleWeightedNormals(std::span<const glm::uvec3> triangles,
                                            std::span<const glm::vec3> positions) {
    std::vector<glm::dvec3> sums(positions.size(), glm::dvec3(0));
    for (const glm::uvec3& t : triangles) {
        const glm::dvec3 p[3] = {positions[t.x], positions[t.y], positions[t.z]};
        const glm::dvec3 cross = glm::cross(p[1] - p[0], p[2] - p[0]);
        const double area = glm::length(cross);
        if (!(area > 0)) continue;
        for (int c = 0; c < 3; ++c) {
            const glm::dvec3 a = p[(c + 1) % 3] - p[c], b = p[(c + 2) % 3] - p[c];
            sums[t[c]] += cross / area * std::atan2(area, glm::dot(a, b));
        }
    }
    std::vector<glm::vec3> normals(positions.size(), glm::vec3(0));
    for (std::size_t v = 0; v < sums.size(); ++v) {
        const double length = glm::length(sums[v]);
        if (length > 1e-12) normals[v] = sums[v] / length;
    }
    return normals;
}

}  // namespace nacre
