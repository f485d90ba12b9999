#include "transfer/receiver_groups.hpp"

#include <algorithm>
#include <functional>

namespace nacre {

std::vector<std::vector<std::uint32_t>> groupReceivers(std::span<const glm::vec3> positions,
                                                       std::span<const glm::vec3> normals, std::size_t most) {
    std::vector<std::uint32_t> all;
    glm::vec3 low(1e30f), high(-1e30f);
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
        if (normals[v] == glm::vec3(0)) continue;
        all.push_back(v);
        low = glm::min(low, positions[v]);
        high = glm::max(high, positions[v]);
    }
    // Opposite normals part as a 32nd of the mesh's size does: what a group has in common is mostly by its extent.
    const float facing = all.empty() ? 0.0f : 0.015f * glm::length(high - low);
    const auto key = [&](std::uint32_t v, int axis) {
        return axis < 3 ? positions[v][axis] : facing * normals[v][axis - 3];
    };
    std::vector<std::vector<std::uint32_t>> groups;
    const std::function<void(std::span<std::uint32_t>)> halve = [&](std::span<std::uint32_t> part) {
        if (part.size() <= most) {
            if (!part.empty()) groups.emplace_back(part.begin(), part.end());
            return;
        }
        int widest = 0;
        float extent = -1;
        for (int axis = 0; axis < 6; ++axis) {
            const auto [a, b] = std::minmax_element(part.begin(), part.end(),
                                                    [&](auto x, auto y) { return key(x, axis) < key(y, axis); });
            if (key(*b, axis) - key(*a, axis) <= extent) continue;
            extent = key(*b, axis) - key(*a, axis);
            widest = axis;
        }
        const std::size_t half =
            (part.size() / 2 + most - 1) / most * most;  // full groups: the kernels work by sixteen
        std::nth_element(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(half), part.end(),
                         [&](auto x, auto y) {
                             return key(x, widest) < key(y, widest) || (key(x, widest) == key(y, widest) && x < y);
                         });
        halve(part.first(half));
        halve(part.subspan(half));
    };
    halve(all);
    return groups;
}

GroupBounds boundsOfGroup(std::span<const std::uint32_t> group, std::span<const glm::vec3> positions,
                          std::span<const glm::vec3> normals) {
    GroupBounds bounds;
    glm::vec3 low(positions[group[0]]), high = low;
    for (const std::uint32_t v : group) {
        low = glm::min(low, positions[v]);
        high = glm::max(high, positions[v]);
        bounds.normal += normals[v];
    }
    bounds.centre = 0.5f * (low + high);
    bounds.normal /= static_cast<float>(group.size());
    for (const std::uint32_t v : group) {
        bounds.radius = std::max(bounds.radius, glm::distance(positions[v], bounds.centre));
        bounds.spread = std::max(bounds.spread, glm::distance(normals[v], bounds.normal));
    }
    return bounds;
}

GroupBox boxOfGroup(std::span<const std::uint32_t> group, std::span<const glm::vec3> positions) {
    glm::vec3 low(positions[group[0]]), high = low;
    for (const std::uint32_t v : group) {
        low = glm::min(low, positions[v]);
        high = glm::max(high, positions[v]);
    }
    GroupBox box{0.5f * (low + high), 0.5f * (high - low), 0};
    for (const std::uint32_t v : group) box.radius = std::max(box.radius, glm::distance(positions[v], box.middle));
    return box;
}

/// With normal n + e, |e| ≤ spread: (n + e)·(x − p) ≤ n·(c − centre) + |n|(radii) + spread (|c − centre| + radii).
bool belowHorizon(const GroupBounds& group, const glm::vec3& centre, float radius) {
    const glm::vec3 d = centre - group.centre;
    const float radii = radius + group.radius;
    return glm::dot(group.normal, d) + glm::length(group.normal) * radii + group.spread * (glm::length(d) + radii) < 0;
}

}  // namespace nacre
