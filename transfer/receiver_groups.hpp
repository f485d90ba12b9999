// Vertices that see much the same: they share lists of blockers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene.hpp"

namespace nacre {

/// Groups of at most `most` vertices near each other and facing alike: cut in two again and again, where the groups to
/// come are least wide by position and normal. Vertices without a normal are in no group.
std::vector<std::vector<std::uint32_t>> groupReceivers(std::span<const glm::vec3> positions,
                                                       std::span<const glm::vec3> normals, std::size_t most);

/// What holds for all vertices of a group: points in a ball, normals within `spread` of one (as lengths of
/// differences).
struct GroupBounds {
    glm::vec3 centre{0}, normal{0};
    float radius = 0, spread = 0;
};
GroupBounds boundsOfGroup(std::span<const std::uint32_t> group, std::span<const glm::vec3> positions,
                          std::span<const glm::vec3> normals);

/// A box about a group's points, and how far they are from its middle.
struct GroupBox {
    glm::vec3 middle{0}, half{0};
    float radius = 0;
};
GroupBox boxOfGroup(std::span<const std::uint32_t> group, std::span<const glm::vec3> positions);

/// Whether nothing in a ball rises over the plane of any of the group's vertices.
bool belowHorizon(const GroupBounds& group, const glm::vec3& centre, float radius);

}  // namespace nacre
