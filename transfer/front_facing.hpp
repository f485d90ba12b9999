// Which vertices a viewer can see at most: the others' transfer need not be computed (HEMI section 3, "Rendering").
#pragma once

#include "transfer/surface.hpp"

namespace nacre {

/// SelfTransfer::compute's `wanted`: 1 for the vertices of triangles that face the eye, whatever hides them; else 0.
/// A triangle whose plane holds the eye, or with a corner that isn't finite, faces nobody.
/// \param positions  of the welded vertices \throws std::invalid_argument unless there is one a vertex
std::vector<std::uint8_t> frontFacing(const WeldedMesh& mesh, std::span<const glm::vec3> positions, const Vec3& eye);

}  // namespace nacre
