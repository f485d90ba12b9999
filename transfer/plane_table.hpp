// HEMI's own rasterizer: a regular grid in the unit disk, a triangle as the AND of three planes' masks from a table.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "transfer/mask_kernel.hpp"

namespace nacre {

inline constexpr int kDiskSize = 32;    ///< bits along an edge of the grid
inline constexpr int kDiskBlocks = 64;  ///< of 4 × 4 bits: HEMI's 8 × 8 samples of the integral

/// Bit i of row j is the direction s with (i + ½)/16 − 1 for x, (j + ½)/16 − 1 for y and z ≥ 0, where that is in the
/// unit disk (HEMI section 3.1). Bits outside it mean nothing.
struct alignas(64) DiskMask {
    std::uint32_t rows[kDiskSize] = {};
    bool at(int i, int j) const { return rows[j] >> i & 1; }
};

/// The grid's directions. z is −1 outside the disk.
struct DiskGrid {
    alignas(64) float x[kDiskSize];
    alignas(64) float y[kDiskSize];
    alignas(64) float z[kDiskSize][kDiskSize];  ///< [j][i]
    DiskMask inside;
    int count = 0;  ///< bits inside
};
const DiskGrid& diskGrid();

/// For each plane n·s ≥ 0 of a set the grid's bits above it. The set: texel centres of a cube map of normals, texel (u,
/// v) of face f at masks[(f L + v) L + u]; faces +x −x +y −y +z −z, u and v along the other two axes in their order, so
/// that n and −n lie at mirrored places and triangles that share an edge leave no gap and don't overlap.
struct PlaneTable {
    int size = 0;  ///< L: 6 L² masks of 128 bytes, 12 MB for HEMI's 128
    std::vector<DiskMask> masks;
    /// Whose mask stands for the plane. \param n  any length but 0
    std::size_t indexOf(const glm::vec3& n) const;
};
/// \param size  1 to 512 \throws std::invalid_argument
std::shared_ptr<const PlaneTable> planeTable(int size, unsigned threads = 0);

/// What a block of 4 × 4 bits that is hidden takes away: [block][32], the first 25 by l² + l + m.
struct DiskIntegrals {
    alignas(64) float perBit[kDiskBlocks][2 * kLanes];
};

struct DiskKernel {
    /// Sets the bits of `count` triangles as seen from the receiver; those that face away are left out unless
    /// bothSides. A triangle that crosses the horizon needs no clipping: no direction of the mask lies below it.
    /// \param table  null: the planes themselves, three dot products a bit
    /// \param indices  into blockers; room for 15 more behind
    void (*draw)(const PlaneTable* table, const BlockerRow* blockers, const Receiver& receiver, bool bothSides,
                 std::uint32_t* indices, int count, DiskMask& mask);
    /// Σ over the blocks of their set bits' number times perBit, to `sums` [32].
    void (*integrate)(const DiskIntegrals& integrals, const DiskMask& mask, float* sums);
};
/// All sets give the same bits. \throws std::invalid_argument when the processor lacks the set
DiskKernel diskKernel(VectorSet set = VectorSet::Widest);

}  // namespace nacre
