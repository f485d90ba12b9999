// What may block a group of vertices: the mesh itself near them, and farther off each patch by the level that is close
// enough there.
#pragma once

#include <optional>
#include <span>

#include "transfer/blocking_parts.hpp"
#include "transfer/frame_blockers.hpp"

namespace nacre {

class BlockerLists {
public:
    /// What a thread keeps from list to list.
    struct Room {
        std::vector<std::uint8_t> levels;
        std::vector<std::uint16_t> hidden;
    };

    /// Both are kept by reference. \param silhouettes  of all levels' triangles
    BlockerLists(const MovingLevels& levels, const SilhouetteMesh& silhouettes);

    /// \param rings  of triangles about a group that block as the mesh itself
    void setGroups(std::span<const std::vector<std::uint32_t>> groups, const WeldedMesh& mesh,
                   const CornersOfVertices& corners, const BlockingParts& parts, int rings);

    /// \param angle  [rad] a level may be off by, seen from the group; none: the coarsest one does everywhere
    /// \param members  [cluster] triangles as bits, written \return  triangles that are left out as they are below all
    /// horizons, by the coarsest level
    std::size_t list(std::size_t group, const GroupBounds& bounds, std::optional<float> angle,
                     const FrameBlockers& blockers, const BlockerKernel& kernel, Room& room,
                     std::vector<std::uint32_t>& members) const;

    std::size_t bytes() const;

private:
    std::span<const SilhouetteMesh::Part> partsOf(std::size_t patch, std::size_t level) const;

    const MovingLevels& levels_;
    const SilhouetteMesh& silhouettes_;
    std::vector<SilhouetteMesh::Part> parts_;
    std::vector<std::uint32_t> firstPart_;        ///< [patch × levels + level], one more: in parts_
    std::vector<std::uint32_t> coarsestMembers_;  ///< [cluster] all triangles of the coarsest level
    std::vector<std::uint32_t>
        coarsest_;  ///< [patch / 16] the cluster of which these patches' coarsest triangles are all
    std::vector<std::vector<SilhouetteMesh::Part>> near_;  ///< [group] triangles of the mesh within the rings
    std::vector<std::vector<std::uint32_t>> nearPatches_;  ///< [group] of sheets, whose levels would lie over it
};

}  // namespace nacre
