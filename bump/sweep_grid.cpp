#include <limits>
#include <numeric>

#include "bump/sweep.hpp"
#include "core/parallel.hpp"

namespace nacre {

namespace {

/// Whether position k of a doubled axis holds the copy that mirrors it.
bool mirrored(int k, int size, bool flipped) { return (k >= size) != flipped; }

// Beyond the map: what the last texel's ray crosses within a chunk, and what the bounds of that read (they are filled
// by sixteens).
constexpr int kBelow = kSweepColumns + 4;
int strideOf(int columns) { return ((columns + kSweepLanes + 15) / 16 * 16 + 32) | 16; }  // odd: sets of caches differ

}  // namespace

SweepGrid::SweepGrid(const HeightMap& map, double azimuth, SweepMemory& memory)
    : wrap_(map.wrap), width_(map.width()), height_(map.height()) {
    double c = std::cos(azimuth), s = std::sin(azimuth);
    constexpr double kNoise = 1e-12;  // of cos and sin at multiples of π/2: rays that run along a row stay in it
    if (std::abs(c) < kNoise) c = 0;
    if (std::abs(s) < kNoise) s = 0;
    if (std::abs(std::abs(c) - std::abs(s)) < kNoise) s = std::copysign(c, s);
    flipX_ = c < 0;
    flipY_ = s < 0;
    swapped_ = std::abs(s) > std::abs(c);
    cosine_ = std::max(std::abs(c), std::abs(s));
    sine_ = std::min(std::abs(c), std::abs(s));
    const int copies = wrap_ == Wrap::Mirror ? 2 : 1;
    columns_ = copies * (swapped_ ? height_ : width_);
    rows_ = copies * (swapped_ ? width_ : height_);
    stride_ = strideOf(columns_);
    const std::size_t layer = static_cast<std::size_t>(stride_) * (rows_ + kBelow);
    float* values = memory.need(4 * layer + static_cast<std::size_t>(stride_) * kRing);
    float *chunks = values + layer, *groups = chunks + layer, *bends = groups + layer, *ring = bends + layer;
    heights_ = values, chunks_ = chunks, groups_ = groups, bends_ = bends;
    fill(map, values);
    fillChunks(ring, chunks);
    fillGroups(groups);
    fillBends(ring, bends);
}

double SweepGrid::repeatsFrom() const {
    const double columns = columns_, rows = rows_;
    if (wrap_ == Wrap::Clamp) return (sine_ > 0 ? std::max(columns / cosine_, rows / sine_) : columns) + 1;
    if (sine_ == 0) return columns + 1;
    if (sine_ == cosine_) return static_cast<double>(std::lcm<std::int64_t>(columns_, rows_)) / cosine_ + 1;
    return std::numeric_limits<double>::infinity();
}

/// Element of the map is along(x) + down(y) of the turned texel.
void SweepGrid::fill(const HeightMap& map, float* heights) {
    const auto places = [&](bool alongX, int count, bool flipped) {
        const int size = alongX ? width_ : height_, copies = wrap_ == Wrap::Mirror ? 2 : 1;
        std::vector<int> out(static_cast<std::size_t>(count));
        for (int k = 0; k < count; ++k) {
            const int inside = wrap_ == Wrap::Clamp ? std::min(k, size - 1) : k % (copies * size);
            const int i = wrapIndex(flipped ? copies * size - 1 - inside : inside, size, wrap_);
            out[static_cast<std::size_t>(k)] = alongX ? i : i * width_;
        }
        return out;
    };
    along_ = places(!swapped_, stride_, swapped_ ? flipY_ : flipX_);
    down_ = places(swapped_, rows_ + kBelow, swapped_ ? flipX_ : flipY_);
    const float* from = map.heights.data().data();
    constexpr int kBlock = 16;  // a transposed block's lines stay in the cache
    for (int y0 = 0; y0 < rows_ + kBelow; y0 += kBlock)
        for (int x0 = 0; x0 < stride_; x0 += kBlock)
            for (int y = y0; y < std::min(y0 + kBlock, rows_ + kBelow); ++y) {
                float* to = heights + static_cast<std::size_t>(y) * stride_;
                for (int x = x0; x < x0 + kBlock; ++x) {
                    const float z = from[along_[x] + down_[y]];
                    to[x] = std::isnan(z) ? kHole : z;
                    holes_ |= std::isnan(z);
                }
            }
    rowStart_.resize(2 * static_cast<std::size_t>(rows_) + 2);
    columnStart_.resize(2 * static_cast<std::size_t>(columns_) + 1);
    const auto inside = [&](std::size_t k, int n, int end) {
        return static_cast<std::size_t>(wrap_ == Wrap::Clamp ? std::min(static_cast<int>(k), end)
                                                             : static_cast<int>(k) % n);
    };
    for (std::size_t y = 0; y < rowStart_.size(); ++y) rowStart_[y] = inside(y, rows_, rows_ - 1) * stride_;
    for (std::size_t x = 0; x < columnStart_.size(); ++x) columnStart_[x] = inside(x, columns_, columns_);
}

void SweepGrid::putBack(int x, int y, int width, int height, const float* values, std::span<float> out) const {
    const int acrossSize = swapped_ ? height_ : width_, downSize = swapped_ ? width_ : height_;
    const bool acrossFlip = swapped_ ? flipY_ : flipX_, downFlip = swapped_ ? flipX_ : flipY_;
    const auto kept = [&](int k, int size, bool flipped) {
        return wrap_ != Wrap::Mirror || !mirrored(k, size, flipped);
    };
    const auto put = [&](int i, int row, int j) { out[along_[x + i] + down_[row]] = values[j * kSweepLanes + i]; };
    const int seam = std::min(height, rows_ - y);  // rows that lie before it
    const auto putRows = [&](int first, int last, int i) {
        for (int j = first, row = first < seam ? y + j : y + j - rows_; j < last; ++j, ++row)
            if (kept(row, downSize, downFlip)) put(i, row, j);
    };
    if (swapped_) {  // along the map's rows
        for (int i = 0; i < width; ++i) {
            if (!kept(x + i, acrossSize, acrossFlip)) continue;
            putRows(0, seam, i);
            putRows(seam, height, i);
        }
        return;
    }
    for (int j = 0; j < height; ++j) {
        const int row = j < seam ? y + j : y + j - rows_;
        if (!kept(row, downSize, downFlip)) continue;
        for (int i = 0; i < width; ++i)
            if (kept(x + i, acrossSize, acrossFlip)) put(i, row, j);
    }
}

SweepPath sweepPath(const SweepGrid& grid, double reach) {
    constexpr double kCorner = 1e-9;  // a ray this close to a texel centre goes through it
    SweepPath out;
    const double c = grid.cosine(), s = grid.sine();
    int column = 0, row = 0, top = 0;
    double t0 = 0;
    float share = 0;  // of the row below, where the ray enters a column
    for (bool entersColumn = true; t0 < reach;) {
        if (entersColumn && column % kSweepColumns == 0) {
            out.chunks.push_back(
                {out.steps.size(), 0, grid.foldColumn(column), grid.foldRow(row), share, static_cast<float>(1 / t0)});
            top = row;
        }
        const double tx = (column + 1) / c, ty = s > 0 ? (row + 1) / s : 2 * tx + 1;
        const double t1 = std::min(tx, ty);
        const bool right = tx - t1 <= kCorner * t1, below = ty - t1 <= kCorner * t1;
        const double ex = right ? 1 : t1 * c - column, ey = below ? 1 : s > 0 ? t1 * s - row : 0;
        const int corner = column % kSweepColumns + (row - top) * grid.stride(), to = corner + grid.stride() + 1;
        out.steps.push_back({corner,
                             right && below ? to
                             : right        ? corner + 1
                                            : to - 1,
                             to, static_cast<float>(right ? ey : ex), static_cast<float>(t0), static_cast<float>(t1),
                             static_cast<float>(1 / t0), static_cast<float>(1 / t1)});
        out.chunks.back().end = out.steps.size();
        share = right && !below ? static_cast<float>(ey) : 0;
        column += right;
        row += below;
        t0 = t1;
        entersColumn = right;
    }
    return out;
}

void sweepTexels(const SweepGrid& grid, unsigned threads, const SweepCall& sweep, std::span<float> out) {
    constexpr int kRows = 16;  // a task
    const int rows = grid.rows();
    parallelFor(static_cast<std::size_t>((rows + kRows - 1) / kRows), threads, [&](std::size_t task) {
        const int first = static_cast<int>(task) * kRows, count = std::min(kRows, rows - first);
        float values[kRows * kSweepLanes];
        for (int x = 0; x < grid.columns(); x += kSweepLanes) {
            // Down with the rays: what the texels before saw from afar, which is still in the cache, is what these see.
            const int y = (first + static_cast<int>(x * grid.tangent())) % rows;
            SweepHints hints;
            for (int j = 0; j < count; ++j) sweep(x, (y + j) % rows, hints, values + j * kSweepLanes);
            grid.putBack(x, y, std::min(kSweepLanes, grid.columns() - x), count, values, out);
        }
    });
}

}  // namespace nacre
