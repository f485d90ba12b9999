#include <algorithm>
#include <cstdint>
#include <cstring>

#include "bump/sweep.hpp"
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace nacre {
namespace {

#define NACRE_KERNEL "bump/sweep_bounds_kernel.inl"
#include "core/wide.inl"

const auto kLargest = NACRE_WIDEST(largest);
const auto kLargestOf = NACRE_WIDEST(largestOf);
const auto kLargestBends = NACRE_WIDEST(largestBends);

}  // namespace

// A ray that enters a chunk at row p between the first texel, p = 0, and the next one crosses the patches of column c
// in rows ⌊p + c tan⌋ to ⌈p + (c + 1) tan⌉: three from ⌊c tan⌋ on hold them for every p < 1. Along rows and diagonals p
// is 0, and there is one, or none but its upper edge.
static int patchRows(double sine, double cosine) { return sine == 0 ? 0 : sine == cosine ? 1 : 3; }

/// Per texel, the largest of what `fillRow(row, y)` says of the patches of one column, over the columns of a chunk.
template <class FillRow>
void SweepGrid::largestAlongRays(const FillRow& fillRow, float* ring, float* to) const {
    const auto ringRow = [&](int y) { return ring + static_cast<std::size_t>(y % kRing) * stride_; };
    const float* from[kSweepColumns];
    for (int y = 0, filled = 0; y < rows_; ++y) {
        for (; filled < y + kSweepColumns; ++filled) fillRow(ringRow(filled), filled);
        for (int c = 0; c < kSweepColumns; ++c) from[c] = ringRow(y + static_cast<int>(c * tangent())) + c;
        kLargest(to + static_cast<std::size_t>(y) * stride_, from, kSweepColumns, stride_ - 32);
    }
}

void SweepGrid::fillChunks(float* ring, float* chunks) {
    const int high = patchRows(sine_, cosine_) + 1;
    const auto corners = [&](float* to, int y) {
        const float* from[8];
        for (int k = 0; k < 2 * high; ++k) from[k] = heights_ + static_cast<std::size_t>(y + k / 2) * stride_ + k % 2;
        kLargest(to, from, 2 * high, stride_ - 16);
    };
    largestAlongRays(corners, ring, chunks);
    for (int y = 0; y < rows_; ++y)
        highest_ = std::max(highest_, kLargestOf(chunks + static_cast<std::size_t>(y) * stride_, columns_));
}

void SweepGrid::fillBends(float* ring, float* bends) {
    const int patches = patchRows(sine_, cosine_);
    const auto patchBends = [&](float* to, int y) {
        kLargestBends(to, heights_ + static_cast<std::size_t>(y) * stride_, stride_, patches, stride_ - 16);
    };
    largestAlongRays(patchBends, ring, bends);
}

void SweepGrid::fillGroups(float* groups) {
    const int shifts = patchRows(sine_, cosine_) > 1 ? 2 : 1;  // a chunk's row, rounded down, goes on by one of two
    const auto fillLanes = [&](int x, int y) {
        const float* from[2 * kSweepGroup];
        int count = 0;
        for (int k = 0; k < kSweepGroup * kSweepColumns; k += kSweepColumns)
            for (int shift = 0; shift < shifts; ++shift)
                from[count++] = chunkHighest(x + foldColumn(k), y + foldRow(static_cast<int>(k * tangent()) + shift));
        kLargest(groups + static_cast<std::size_t>(y) * stride_ + x, from, count, kSweepLanes);
    };
    for (int y = 0; y < rows_; ++y) {
        for (int x = 0; x < columns_; x += kSweepLanes) fillLanes(x, y);
        fillLanes(columns_, y);
    }
}

}  // namespace nacre
