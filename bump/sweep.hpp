// Rays of one azimuth from every texel at once. They all cross the same patches relative to where they start: what one
// ray crosses is listed once, and the rays of a row of texels are followed together.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "bump/height_map.hpp"
#include "bump/sweep_memory.hpp"

namespace nacre {

inline constexpr int kSweepLanes = 32;   ///< texels of a row that are followed together
inline constexpr int kSweepColumns = 8;  ///< that a ray crosses in a chunk
inline constexpr int kSweepGroup = 8;    ///< chunks that have one more bound together
inline constexpr float kHole = -1e30f;   ///< the height of a hole: nothing it has part in is above anything

/// A piece of the ray within one patch. Texels are given as elements from the first one of its chunk.
struct SweepStep {
    int corner;       ///< the patch's lowest corner
    int from, to;     ///< ends of the edge it leaves through; both are `to` where it leaves through a corner
    float share;      ///< of `to` in the height there
    float t0, t1;     ///< the ray enters and leaves [texels along the plane]
    float near, far;  ///< 1/t0, 1/t1
};

/// Steps through the same columns, so that one bound tells whether they matter.
struct SweepChunk {
    std::size_t begin, end;  ///< steps
    int column, row;         ///< its first texel, relative to the one that the ray starts from, SweepGrid::fold'ed
    float share;             ///< of the texel below the first one in the height where the ray enters
    float near;              ///< 1/t0 of the first step
};

/// The map mirrored and transposed so that the azimuth lies between +x and the diagonal, continued beyond its borders.
class SweepGrid {
public:
    /// \param memory  is the grid's until it goes
    SweepGrid(const HeightMap& map, double azimuth, SweepMemory& memory);

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    int stride() const { return stride_; }     ///< elements from a row to the next
    double cosine() const { return cosine_; }  ///< of the turned azimuth: cosine ≥ sine ≥ 0
    double sine() const { return sine_; }
    double tangent() const { return sine_ / cosine_; }  ///< of a diagonal exactly 1

    /// Heights of the texel (x, y), x < 2 columns, y < 2 rows, of the columns beyond it that kSweepLanes rays cross
    /// within a chunk, and as many rows below.
    const float* at(int x, int y) const { return heights_ + element(x, y); }
    /// What the ray from each of kSweepLanes texels can meet in a chunk, and in kSweepGroup chunks from there on: (x,
    /// y) is the first texel plus the (first) chunk's column and row.
    const float* chunkHighest(int x, int y) const { return chunks_ + element(x, y); }
    const float* groupHighest(int x, int y) const { return groups_ + element(x, y); }
    float highest() const { return highest_; }
    /// Largest h10 + h01 − h00 − h11 > 0 of the patches that the ray meets in a chunk: how much they bend down. 0 along
    /// rows, where no ray bends.
    const float* chunkBend(int x, int y) const { return bends_ + element(x, y); }
    bool holes() const { return holes_; }
    /// Along the plane [texels]: from here on it meets heights that it has met before.
    double repeatsFrom() const;
    /// The row before row y < rows.
    int rowBefore(int y) const { return y > 0 ? y - 1 : wrap_ == Wrap::Clamp ? 0 : rows_ - 1; }

    /// A block of values, kSweepLanes a row, of the turned texels (x, y) on, to where they lie in the map, row by row;
    /// those of copies that a mirror made are dropped.
    void putBack(int x, int y, int width, int height, const float* values, std::span<float> out) const;

    /// Any offset ≥ 0 from a texel, as one that `at` knows when it is added to x < columns or y < rows.
    int foldColumn(int offset) const { return fold(offset, columns_); }
    int foldRow(int offset) const { return fold(offset, rows_); }

private:
    static constexpr int kRing = 2 * kSweepColumns;  ///< rows that the bounds of a row are made of, and some more
    std::size_t element(int x, int y) const {
        return rowStart_[static_cast<std::size_t>(y)] + columnStart_[static_cast<std::size_t>(x)];
    }
    int fold(int offset, int period) const { return wrap_ == Wrap::Clamp ? std::min(offset, period) : offset % period; }
    void fill(const HeightMap& map, float* heights);
    /// \param ring  kRing rows
    void fillChunks(float* ring, float* chunks);
    void fillGroups(float* groups);
    void fillBends(float* ring, float* bends);
    template <class FillRow>
    void largestAlongRays(const FillRow& fillRow, float* ring, float* to) const;

    Wrap wrap_;
    int width_, height_;  ///< of the map
    bool swapped_ = false, flipX_ = false, flipY_ = false, holes_ = false;
    int columns_ = 0, rows_ = 0, stride_ = 0;
    double cosine_ = 1, sine_ = 0;
    float highest_ = kHole;
    const float *heights_ = nullptr, *chunks_ = nullptr, *groups_ = nullptr, *bends_ = nullptr;
    std::vector<std::size_t> rowStart_, columnStart_;
    std::vector<int> along_, down_;
};

/// What a ray crosses up to `reach` texels away.
struct SweepPath {
    std::vector<SweepStep> steps;
    std::vector<SweepChunk> chunks;
};
SweepPath sweepPath(const SweepGrid& grid, double reach);

/// Chunks that held the horizons of the texels before, to be looked at first. They change no horizon by more than the
/// tolerance of horizonSlopes.
struct SweepHints {
    static constexpr int kMost = 8;
    int count = 0;
    int chunks[kMost] = {};
    bool has(int chunk) const {
        for (int k = 0; k < count; ++k)
            if (chunks[k] == chunk) return true;
        return false;
    }
};

/// One row's texels from x on, kSweepLanes of them (fewer are useful at the row's end): slopes of their horizons, as
/// horizonSlopes. \param hints  those of the row before, then of this one
void sweepHorizon(const SweepGrid& grid, const SweepPath& path, int x, int y, SweepHints& hints, float* slopes);

/// kSweepLanes slopes into angles [rad].
void sweepAngles(float* slopes);

/// The same for rays that rise by `slope` a texel: distances, as rayDistances.
void sweepRays(const SweepGrid& grid, const SweepPath& path, float slope, int x, int y, float* distances);

/// Calls sweep(x, y, hints, values) for every kSweepLanes texels of the turned map, down a few rows with the same
/// hints, and puts the values where the texels lie in the map. \param out  row by row, of the map's size
using SweepCall = std::function<void(int x, int y, SweepHints& hints, float* values)>;
void sweepTexels(const SweepGrid& grid, unsigned threads, const SweepCall& sweep, std::span<float> out);

/// horizonSlopes into `out`, or with `angles` their elevations [rad].
void sweepHorizons(const HeightMap& map, double azimuth, unsigned threads, bool angles, SweepMemories& memories,
                   std::span<float> out);

}  // namespace nacre
