// A moving mesh at several levels of detail, cut into patches (HEMI section 3.2, "Mesh Hierarchy", as a hierarchy).
#pragma once

#include "transfer/surface.hpp"

namespace nacre {

struct BlockerLevelOptions {
    std::size_t coarse = 400;  ///< triangles of the coarsest level; 0 = the mesh itself, nothing coarser
    double ratio = 3;          ///< about so many times fewer triangles from level to level
};

/// Level 0 is the mesh, the last the coarsest. All levels use the mesh's vertices (edges are collapsed onto vertices
/// that are there), so they follow any motion.
struct BlockerLevels {
    struct Level {
        std::vector<glm::uvec3> triangles;
        /// How far a vertex is pushed out along the level's normal [of the longest extent of the mesh at rest]: the
        /// least-squares fit to the mesh, which a coarse mesh with vertices on a curved surface lies inside of.
        std::vector<float> push;
        std::vector<std::uint32_t> triangleOf;  ///< of each vertex of the mesh: the level's triangle that stands for it
        std::vector<float>
            restError;  ///< [patch] distance from the mesh, either way, at rest [of the extent]; level ≥ 1
    };
    std::vector<Level> levels;

    /// What each triangle of the coarsest level, near each other in space, stands for, level by level: with a rim, so
    /// that two neighbours at different levels leave no gap.
    struct Patch {
        std::vector<std::uint32_t> vertices;                ///< of the mesh
        std::vector<std::vector<std::uint32_t>> triangles;  ///< [level], the last its own triangle
        /// [level] (vertex, triangle): what tells how far off a triangle is that stands for no vertex, the vertex
        /// nearest to its middle at rest.
        std::vector<std::vector<glm::uvec2>> nearest;
    };
    std::vector<Patch> patches;

    std::size_t finest() const { return levels.front().triangles.size(); }
};

/// \param rest  finite positions by which levels are made
BlockerLevels makeBlockerLevels(const WeldedMesh& mesh, std::span<const glm::vec3> rest,
                                const BlockerLevelOptions& options);

/// A level's vertices in a frame: `positions` pushed out along the level's normals. \param extent  now of the mesh
std::vector<glm::vec3> pushedPositions(const BlockerLevels::Level& level, const CornersOfVertices& corners,
                                       std::span<const glm::vec3> positions, float extent);

/// Longest edge of the bounding box.
float extentOf(std::span<const glm::vec3> positions);

}  // namespace nacre
