// What of a mesh decides about its shadow: distinct points, triangles, and which triangles meet at an edge.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene.hpp"

namespace nacre {

/// Made once a mesh. Positions are the mesh's own floats, so that what is drawn from them lies where the mesh does.
struct ShadowMesh {
    std::vector<glm::vec3> positions;   ///< no two alike
    std::vector<glm::uvec3> triangles;  ///< in the mesh's order; none has a corner twice, no two have the same corners
    std::vector<glm::uvec2> edges;      ///< ends, x < y
    /// Triangles at edge e: those of uses[firstUse[e]] up to uses[firstUse[e + 1]], each as 2 · triangle, + 1 where the
    /// triangle goes from y to x.
    std::vector<std::uint32_t> firstUse, uses;
    /// Two triangles at each edge, which go along it in opposite ways, and a positive volume of each connected part:
    /// the mesh is the outward-facing surface of a body. Not noticed: a part that crosses itself and is inside out
    /// there.
    bool solid = false;

    std::span<const std::uint32_t> usesOf(std::size_t edge) const {
        return {uses.data() + firstUse[edge], uses.data() + firstUse[edge + 1]};
    }
};

/// Any mesh: open, non-manifold, duplicated, degenerate, empty. O(n log n).
/// \throws std::invalid_argument for an index out of range or a position that isn't finite
ShadowMesh makeShadowMesh(const Mesh& mesh);

/// What of a mesh lies in front of planes.
struct CutShadowMesh {
    ShadowMesh pieces;                ///< its positions begin with the mesh's own; never solid
    std::vector<std::uint32_t> from;  ///< the mesh's triangle of each piece
};

/// \param planes  in the mesh's space. Neighbouring pieces share their points. O(n log n).
CutShadowMesh cutShadowMesh(const ShadowMesh& mesh, std::span<const glm::dvec4> planes);

}  // namespace nacre
