// The blockers of one frame: all levels of detail where the mesh's vertices are now.
#pragma once

#include "transfer/blocker_kernel.hpp"
#include "transfer/blocker_levels.hpp"
#include "transfer/silhouette_blockers.hpp"

namespace nacre {

struct FrameBlockers {
    SilhouetteMesh::Frame silhouettes;
    PatchColumns patches;
    std::vector<glm::vec3> points;  ///< the mesh's vertices, then the coarser levels'
    std::vector<BlockerRow> rows;   ///< of the coarser levels, level after level
    std::size_t bytes() const;
};

/// Levels of a mesh, and what doesn't change from frame to frame of their vertices and rows.
class MovingLevels {
public:
    /// \param vertices  of the mesh
    MovingLevels(BlockerLevels levels, std::size_t vertices);

    /// Where they are. `out` is used again from frame to frame.
    /// \param positions  of the mesh, with an extent of 1
    void place(std::span<const glm::vec3> positions, unsigned threads, FrameBlockers& out) const;

    /// Of a level, by the numbers of points.
    const std::vector<glm::uvec3>& triangles(std::size_t level) const {
        return level == 0 ? levels_.levels[0].triangles : numbered_[level];
    }
    const std::vector<glm::uvec3>& vertexTriangles(std::size_t level) const { return levels_.levels[level].triangles; }
    /// Positions of the mesh as the points of all levels, without the coarser ones' push.
    std::vector<glm::vec3> unpushed(std::span<const glm::vec3> positions) const;

    /// [level][triangle] the patch of its first corner, of the coarsest its own; none when there is one level.
    std::vector<std::vector<std::uint32_t>> patchesOfTriangles() const;
    const std::vector<BlockerLevels::Patch>& patches() const { return levels_.patches; }
    std::size_t levelCount() const { return levels_.levels.size(); }
    std::size_t coarsestTriangles() const { return levels_.levels.back().triangles.size(); }
    std::uint32_t coarsestOf(std::uint32_t vertex) const { return levels_.levels.back().triangleOf[vertex]; }
    /// The patch and those that have some triangle of some level together with it, or one that stands for both.
    const std::vector<std::uint32_t>& joined(std::uint32_t patch) const { return joined_[patch]; }
    std::size_t bytes() const;

private:
    struct Part {
        std::size_t level, first, end;
    };
    void placePatch(std::span<const glm::vec3> positions, std::size_t patch, FrameBlockers& out) const;

    BlockerLevels levels_;
    std::vector<CornersOfVertices> corners_;         ///< [level]
    std::vector<std::vector<std::uint32_t>> used_;   ///< [level ≥ 1] its vertices
    std::vector<std::vector<glm::uvec3>> numbered_;  ///< [level ≥ 1] its triangles by numbers in FrameBlockers::points
    std::vector<std::uint32_t> firstRow_, firstPushed_;     ///< [level]
    std::vector<Part> vertexParts_, rowParts_;              ///< what a thread does at a time
    std::vector<std::vector<std::uint32_t>> patchCorners_;  ///< [patch] vertices of all its triangles
    std::vector<float> patchPush_;                          ///< [patch] the longest push of one of them
    std::vector<std::vector<std::uint32_t>> joined_;
    std::size_t rowCount_ = 0, pushedCount_ = 0;
};

}  // namespace nacre
