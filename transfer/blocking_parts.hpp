// Which sides of which connected parts of a mesh block light.
#pragma once

#include "transfer/surface.hpp"

namespace nacre {

/// Which sides of a triangle block. On closed meshes the sides that face the vertex are all that can be seen first.
/// Fine: both of the mesh's own triangles, the front of coarser levels', whose backs would hide vertices that they lie
/// over. Auto: Front when closed; else by connected part: of sheets (cloth) both sides; of shells, which nearly enclose
/// something, as Fine for the vertices that see some backs at rest, as Front for the others.
enum class BlockingSides { Auto, Front, Fine, Both };

struct BlockingParts {
    BlockingSides sides = BlockingSides::Front;  ///< what was asked for; Auto as most of the mesh has them
    std::vector<std::uint8_t> sheets;            ///< [vertex] of parts that block by any side
    std::vector<std::uint8_t> inside;            ///< [vertex] whether backs of shells block for it
    bool hasSheets = false;
    bool hasShells = false;  ///< whether findInside is to tell which vertices are inside; until then all are
};
/// \param rest  positions, finite
BlockingParts blockingParts(const WeldedMesh& mesh, std::span<const glm::vec3> rest, BlockingSides sides);

/// A vertex is inside where backs of shells change its transfer at rest, and within three rings of triangles of such
/// vertices; for the others all backs are behind fronts. \param withBacks, withoutBacks  [vertex][coefficients]
/// \param light  of an open vertex, the first coefficient
void findInside(const WeldedMesh& mesh, std::span<const float> withBacks, std::span<const float> withoutBacks,
                double light, BlockingParts& parts);

}  // namespace nacre
