#include "transfer/blocking_parts.hpp"

#include <algorithm>
#include <cmath>

namespace nacre {

/// How far each vertex's connected part is from enclosing something: |Σ area vectors| / Σ areas, 0 for closed shells, 1
/// for flat sheets.
static std::vector<float> openness(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> positions) {
    const std::vector<std::uint32_t> part = connectedParts(triangles, positions.size());
    std::vector<glm::dvec3> sums(positions.size(), glm::dvec3(0));
    std::vector<double> areas(positions.size(), 0);
    for (const glm::uvec3& t : triangles) {
        const glm::dvec3 a = positions[t.x],
                         n = glm::cross(glm::dvec3(positions[t.y]) - a, glm::dvec3(positions[t.z]) - a);
        sums[part[t.x]] += n;
        areas[part[t.x]] += glm::length(n);
    }
    std::vector<float> out;
    for (const std::uint32_t p : part)
        out.push_back(areas[p] > 0 ? static_cast<float>(glm::length(sums[p]) / areas[p]) : 1.0f);
    return out;
}

BlockingParts blockingParts(const WeldedMesh& mesh, std::span<const glm::vec3> rest, BlockingSides sides) {
    constexpr float kSheet = 0.2f;  // openness of a part
    const bool byParts = sides == BlockingSides::Auto && !mesh.closed;
    BlockingParts out;
    out.sheets.assign(mesh.vertexCount(), sides == BlockingSides::Both);
    if (byParts) {
        const std::vector<float> open = openness(mesh.triangles, rest);
        std::transform(open.begin(), open.end(), out.sheets.begin(), [](float o) { return std::uint8_t{o > kSheet}; });
    }
    const auto inSheets = static_cast<std::size_t>(std::count(out.sheets.begin(), out.sheets.end(), 1));
    out.hasSheets = inSheets > 0;
    out.hasShells = byParts && inSheets < out.sheets.size();
    out.inside.assign(mesh.vertexCount(), out.hasShells || sides == BlockingSides::Fine);
    out.sides = sides != BlockingSides::Auto       ? sides
                : mesh.closed                      ? BlockingSides::Front
                : 2 * inSheets > out.sheets.size() ? BlockingSides::Both
                                                   : BlockingSides::Fine;
    return out;
}

void findInside(const WeldedMesh& mesh, std::span<const float> withBacks, std::span<const float> withoutBacks,
                double light, BlockingParts& parts) {
    constexpr double kSeen = 0.01;  // of an open vertex's light
    const std::size_t size = mesh.vertexCount() > 0 ? withBacks.size() / mesh.vertexCount() : 0;
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) {
        double difference = 0;
        for (std::size_t i = size * v; i < size * (v + 1); ++i) difference += std::abs(withBacks[i] - withoutBacks[i]);
        parts.inside[v] = difference > kSeen * light;
    }
    for (int ring = 0; ring < 3; ++ring) {
        const std::vector<std::uint8_t> before = parts.inside;
        for (const glm::uvec3& t : mesh.triangles)
            if (before[t.x] || before[t.y] || before[t.z])
                for (int c = 0; c < 3; ++c) parts.inside[t[c]] = 1;
    }
}

}  // namespace nacre
