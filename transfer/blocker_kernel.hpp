// Which level of detail each patch has for a group of vertices, and which triangles a vertex sees, by the widest
// vectors that the processor has.
#pragma once

#include "transfer/mask_kernel.hpp"
#include "transfer/receiver_groups.hpp"

namespace nacre {

/// The patches of a frame by columns, each padded to a multiple of 16.
struct PatchColumns {
    std::size_t count = 0;
    std::vector<float> centre[3], radius;  ///< a ball about all triangles of all levels
    std::vector<float> corners[9];         ///< of the coarsest level's triangle
    std::vector<std::vector<float>> off;   ///< [level ≥ 1] how far the level is from the mesh [world units]
    void resize(std::size_t patches, std::size_t levels);
};
inline constexpr float kAnyOffset = -1e30f;  ///< a triangle's that passes the test of facing from anywhere

/// Triangles by columns, each padded to a multiple of 16.
struct ListedBlockers {
    std::vector<float> columns[13];  ///< corners, normal, offset
    std::size_t count = 0;
};

struct BlockerKernel {
    /// The coarsest level whose error is below `angle`, seen from the group, for each patch; and whether it is under
    /// the horizon of all vertices, by sixteens as bits: those have any level. \param levels, hidden  room for the
    /// padded count
    void (*choose)(const PatchColumns& patches, const GroupBounds& group, float angle, std::uint8_t* levels,
                   std::uint16_t* hidden);
    /// Those with a corner over the receiver's plane that face it: their numbers. \param out  room for 16 more
    std::size_t (*cull)(const ListedBlockers& list, const Receiver& receiver, std::uint32_t* out);
};
BlockerKernel blockerKernel(VectorSet set = VectorSet::Widest);

}  // namespace nacre
