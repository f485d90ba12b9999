// Rays of one azimuth from every texel at once. They all cross the same patches relative to where they start: what one
// ray crosses is listed once, and the rays of a row of texels are followed together.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "bump/height_map.hpp"

namespace nacre {

inline constexpr int kSweepLanes = 32;  ///< texels of a row that are followed together
inline constexpr int kSweepSteps = 8;   ///< at most, of a chunk
inline constexpr int kSweepGroup = 8;   ///< chunks that have one more bound together
inline constexpr float kHole = -1e30f;  ///< the height of a hole: nothing it has part in is above anything

/// A piece of the ray within one patch, relative to the texel that the ray starts from.
struct SweepStep {
    int column, row;  ///< the patch's corners are this texel and its next in x, y and both, as SweepGrid::fold'ed
    float t0, t1;     ///< the ray enters and leaves [texels along the plane]
    float far;        ///< 1/t1
    bool right;       ///< it leaves through the edge at column + 1, otherwise through that at row + 1
    float share;      ///< of the far corner (column + 1, row + 1) in the height there; the rest is the edge's other one
};

/// Steps whose patches lie close together, so that one bound tells whether they matter.
struct SweepChunk {
    std::size_t begin, end;  ///< steps
    int column, row;         ///< lowest of the patches
    float near;              ///< 1/t0 of the first step
};

/// What lies within a window of the relief.
struct SweepBound {
    float highest = kHole;
    float twist = 0;  ///< largest |h00 − h10 − h01 + h11| of a patch: how far it is from being flat
};

/// Bounds by cells of the turned map.
struct SweepCells {
    static constexpr int kColumns = 8, kRows = 4;  ///< texels of a cell
    int across = 0, down = 0;
    std::vector<SweepBound> cells;

    SweepCells() = default;
    SweepCells(int columns, int rows);
    /// The cell of texel (x, y) inside of the map.
    const SweepBound& at(int x, int y) const {
        return cells[static_cast<std::size_t>(y / kRows) * across + static_cast<std::size_t>(x / kColumns)];
    }
    void join(int x, int y, const SweepBound& bound);
};

/// A cell of the result bounds the windows of columns × rows texels whose first texel lies in it.
SweepCells windowBounds(const SweepCells& own, Wrap wrap, int columns, int rows);

/// The map mirrored and transposed so that the azimuth lies between +x and the diagonal, continued beyond its borders.
class SweepGrid {
public:
    SweepGrid(const HeightMap& map, double azimuth);

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    double cosine() const { return cosine_; }  ///< of the turned azimuth: cosine ≥ sine ≥ 0
    double sine() const { return sine_; }

    /// Heights of the texel (x, y), x < 2 columns, y < 2 rows, and the kSweepLanes + 1 beyond it.
    const float* at(int x, int y) const {
        return rowStart_[static_cast<std::size_t>(y)] + columnStart_[static_cast<std::size_t>(x)];
    }
    /// What a chunk sees from kSweepLanes texels, and what kSweepGroup chunks from there on see: (x, y) is the first
    /// texel plus the (first) chunk's column and row.
    const SweepBound& bound(int x, int y) const { return bounds_.at(insideColumn(x), insideRow(y)); }
    float farHighest(int x, int y) const { return farBounds_.at(insideColumn(x), insideRow(y)).highest; }
    float highest() const { return highest_; }
    bool holes() const { return holes_; }
    /// The row before row y + offset, as `at` takes it.
    int rowBefore(int y, int offset) const {
        const int row = insideRow(y + offset);
        return row > 0 ? row - 1 : wrap_ == Wrap::Clamp ? 0 : rows_ - 1;
    }

    /// Values of the turned texels (x, y) to (x + count − 1, y), to where they lie in the map, row by row; those of
    /// copies that a mirror made are dropped.
    void putBack(int x, int y, int count, const float* values, std::vector<float>& out) const;

    /// Any offset ≥ 0 from a texel, as one that `at` knows when it is added to x < columns or y < rows.
    int foldColumn(int offset) const { return fold(offset, columns_); }
    int foldRow(int offset) const { return fold(offset, rows_); }

private:
    int fold(int offset, int period) const { return wrap_ == Wrap::Clamp ? std::min(offset, period) : offset % period; }
    int insideColumn(int x) const { return x < columns_ ? x : wrap_ == Wrap::Clamp ? columns_ - 1 : x - columns_; }
    int insideRow(int y) const { return y < rows_ ? y : wrap_ == Wrap::Clamp ? rows_ - 1 : y - rows_; }
    void fill(const HeightMap& map);
    void fillBounds();

    Wrap wrap_;
    int width_, height_;  ///< of the map
    bool swapped_ = false, flipX_ = false, flipY_ = false, holes_ = false;
    int columns_ = 0, rows_ = 0;
    double cosine_ = 1, sine_ = 0;
    float highest_ = kHole;
    std::unique_ptr<float[]> heights_;
    SweepCells bounds_, farBounds_;
    std::vector<const float*> rowStart_;
    std::vector<int> columnStart_, along_, down_;
};

/// What a ray crosses up to `reach` texels away, columns and rows folded.
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

/// The same for rays that rise by `slope` a texel: distances, as rayDistances.
void sweepRays(const SweepGrid& grid, const SweepPath& path, float slope, int x, int y, float* distances);

/// Calls sweep(x, y, hints, values) for every kSweepLanes texels of the turned map, down a few rows with the same
/// hints, and puts the values where the texels lie in the map. \param out  row by row, of the map's size
using SweepCall = std::function<void(int x, int y, SweepHints& hints, float* values)>;
void sweepTexels(const SweepGrid& grid, unsigned threads, const SweepCall& sweep, std::vector<float>& out);

}  // namespace nacre
