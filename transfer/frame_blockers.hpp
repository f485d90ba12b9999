// The blockers of one frame: all levels of detail where the mesh's vertices are now.
#pragma once

#include "transfer/blocker_kernel.hpp"
#include "transfer/blocker_levels.hpp"

namespace nacre {

struct FrameBlockers {
    std::vector<BlockerRow> rows;  ///< level after level
    PatchColumns patches;
    std::vector<glm::vec3> pushed;  ///< inside: the coarser levels' vertices
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

    /// Which sides block: of the mesh's own triangles, and of coarser ones. \param sheets  [vertex] whether its
    /// connected part blocks by any side
    void setSides(float mesh, float coarser, std::span<const std::uint8_t> sheets);

    const std::vector<BlockerLevels::Patch>& patches() const { return levels_.patches; }
    std::size_t levelCount() const { return levels_.levels.size(); }
    std::size_t coarsestTriangles() const { return levels_.levels.back().triangles.size(); }
    std::uint32_t coarsestOf(std::uint32_t vertex) const { return levels_.levels.back().triangleOf[vertex]; }
    /// The patch and those that have some triangle of some level together with it, or one that stands for both.
    const std::vector<std::uint32_t>& joined(std::uint32_t patch) const { return joined_[patch]; }
    std::uint32_t firstRow(std::size_t level) const { return firstRow_[level]; }
    std::size_t rowCount() const { return rowCount_; }
    std::size_t bytes() const;

private:
    struct Part {
        std::size_t level, first, end;
    };
    void placePatch(std::span<const glm::vec3> positions, std::size_t patch, FrameBlockers& out) const;

    BlockerLevels levels_;
    std::vector<CornersOfVertices> corners_;         ///< [level]
    std::vector<std::vector<std::uint32_t>> used_;   ///< [level ≥ 1] its vertices
    std::vector<std::vector<glm::uvec3>> numbered_;  ///< [level ≥ 1] its triangles by numbers in FrameBlockers::pushed
    std::vector<std::uint32_t> firstRow_, firstPushed_;     ///< [level]
    std::vector<Part> vertexParts_, rowParts_;              ///< what a thread does at a time
    std::vector<std::vector<std::uint32_t>> patchCorners_;  ///< [patch] vertices of all its triangles
    std::vector<float> sides_;                              ///< [row]
    std::vector<float> patchPush_;                          ///< [patch] the longest push of one of them
    std::vector<std::vector<std::uint32_t>> joined_;
    std::size_t rowCount_ = 0, pushedCount_ = 0;
};

}  // namespace nacre
