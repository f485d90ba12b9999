// A lit mesh for any viewer of meshes.
#pragma once

#include <span>
#include <string>

#include "core/scene.hpp"

namespace nacre {

/// A binary little-endian PLY file: x, y, z as float, red, green, blue as uchar, and triangles.
/// \param codes  sRGB, 3 a vertex \param comment  one line
/// \throws std::invalid_argument when there aren't three codes a position
std::string coloredPly(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> positions,
                       std::span<const std::uint8_t> codes, const std::string& comment);

}  // namespace nacre
