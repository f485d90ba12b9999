// HEMI's algorithm as printed, to compare self_transfer.hpp with.
#pragma once

#include <memory>

#include "transfer/self_transfer.hpp"

namespace nacre {

struct PaperMethodOptions {
    int table = 128;  ///< L of plane_table.hpp; 0 = exact planes instead
    int rings = 2;    ///< of the mesh's triangles: 1 = those at the vertex, which span no solid angle; 2 = those at
                      ///< their corners too
    std::size_t coarse = 400;  ///< triangles of the coarse mesh; 0 = the mesh itself
    BlockingSides sides = BlockingSides::Auto;
    /// As printed the integral samples visibility in 64 directions. Else blocks of bits have their harmonics' means,
    /// and what is hidden is taken from the open hemisphere, as self_transfer.hpp does: the same time, less error.
    bool sampledBlocks = true;
    unsigned threads = 0;
};

/// Transfer vectors as SelfTransfer's, of order 4, by HEMI sections 3.1 and 3.2: for each vertex a list of its own, the
/// mesh's triangles within the rings, and the coarse mesh but for what stands for the vertices whose triangles those
/// are ("the remaining parts"; with all of it the error is up to five times as large); culled by facing and horizon;
/// masks of 32 × 32 bits in the disk from a table of planes; 8 × 8 blocks integrated. Where HEMI leaves the choice, the
/// fast one: the same vectors and rotation of harmonics as SelfTransfer, vertices in the order of groupReceivers for
/// the caches, no clipping at the horizon (plane_table.hpp). The coarse mesh is BlockerLevels' last, without its push.
class PaperMethod {
public:
    /// \param rest  as SelfTransfer's \throws std::invalid_argument for options out of range
    PaperMethod(WeldedMesh mesh, std::span<const glm::vec3> rest, const PaperMethodOptions& options);
    ~PaperMethod();
    PaperMethod(PaperMethod&&) noexcept;

    /// Its seconds count lists and culling as rasterization. \param positions  of the welded vertices, finite
    TransferFrame compute(std::span<const glm::vec3> positions) const;
    std::size_t coarseTriangles() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace nacre
