#include "bump/sweep.hpp"
#include "core/parallel.hpp"

namespace nacre {

namespace {

/// Whether position k of a doubled axis holds the copy that mirrors it.
bool mirrored(int k, int size, bool flipped) { return (k >= size) != flipped; }

}  // namespace

SweepGrid::SweepGrid(const HeightMap& map, double azimuth)
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
    fill(map);
    fillBounds();
}

/// Element of the map is along(x) + down(y) of the turned texel.
void SweepGrid::fill(const HeightMap& map) {
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
    const int stride = columns_ + kSweepLanes + 2;
    along_ = places(!swapped_, stride, swapped_ ? flipY_ : flipX_);
    down_ = places(swapped_, rows_, swapped_ ? flipX_ : flipY_);
    const std::vector<float>& from = map.heights.data();
    heights_ = std::make_unique_for_overwrite<float[]>(static_cast<std::size_t>(stride) * rows_);
    for (int y = 0; y < rows_; ++y)
        for (int x = 0; x < stride; ++x) {
            const float z = from[static_cast<std::size_t>(along_[x] + down_[y])];
            heights_[static_cast<std::size_t>(y) * stride + x] = std::isnan(z) ? kHole : z;
            holes_ = holes_ || std::isnan(z);
        }
    rowStart_.resize(2 * static_cast<std::size_t>(rows_) + 2);
    columnStart_.resize(2 * static_cast<std::size_t>(columns_) + 1);
    const auto inside = [&](std::size_t k, int n, int end) {
        return wrap_ == Wrap::Clamp ? std::min(static_cast<int>(k), end) : static_cast<int>(k) % n;
    };
    for (std::size_t y = 0; y < rowStart_.size(); ++y)
        rowStart_[y] = &heights_[static_cast<std::size_t>(inside(y, rows_, rows_ - 1)) * stride];
    for (std::size_t x = 0; x < columnStart_.size(); ++x) columnStart_[x] = inside(x, columns_, columns_);
}

void SweepGrid::fillBounds() {
    SweepCells own(columns_, rows_);
    for (int y = 0; y < rows_; ++y) {
        const float *low = at(0, y), *high = at(0, y + 1);
        for (int x = 0; x < columns_; ++x) {
            const float twist = std::abs((low[x] - low[x + 1]) - (high[x] - high[x + 1]));
            own.join(x, y, {low[x], twist < 1e28f ? twist : 0});
        }
    }
    for (const SweepBound& cell : own.cells) highest_ = std::max(highest_, cell.highest);
    // Mirrored copies lie side by side: they repeat.
    const Wrap wrap = wrap_ == Wrap::Clamp ? Wrap::Clamp : Wrap::Repeat;
    const auto windowRows = [&](int steps) { return static_cast<int>(steps * sine_ / cosine_) + 2; };
    constexpr int kFar = kSweepSteps * kSweepGroup;
    bounds_ = windowBounds(own, wrap, kSweepLanes + kSweepSteps + 1, windowRows(kSweepSteps));
    farBounds_ = windowBounds(own, wrap, kSweepLanes + kFar + 1, windowRows(kFar));
}

void SweepGrid::putBack(int x, int y, int count, const float* values, std::vector<float>& out) const {
    const int acrossSize = swapped_ ? height_ : width_, downSize = swapped_ ? width_ : height_;
    const bool acrossFlip = swapped_ ? flipY_ : flipX_, downFlip = swapped_ ? flipX_ : flipY_;
    const bool mirrors = wrap_ == Wrap::Mirror;
    if (mirrors && mirrored(y, downSize, downFlip)) return;
    for (int i = 0; i < count; ++i)
        if (!mirrors || !mirrored(x + i, acrossSize, acrossFlip))
            out[static_cast<std::size_t>(along_[x + i] + down_[y])] = values[i];
}

SweepPath sweepPath(const SweepGrid& grid, double reach) {
    constexpr double kCorner = 1e-9;  // a ray this close to a texel centre goes through it
    SweepPath out;
    const double c = grid.cosine(), s = grid.sine();
    int column = 0, row = 0;
    double t0 = 0;
    while (t0 < reach) {
        const double tx = (column + 1) / c, ty = s > 0 ? (row + 1) / s : 2 * tx + 1;
        const double t1 = std::min(tx, ty);
        const bool right = tx - t1 <= kCorner * t1, below = ty - t1 <= kCorner * t1;
        const double ex = right ? 1 : t1 * c - column, ey = below ? 1 : s > 0 ? t1 * s - row : 0;
        if (out.steps.size() % kSweepSteps == 0)
            out.chunks.push_back(
                {out.steps.size(), 0, grid.foldColumn(column), grid.foldRow(row), static_cast<float>(1 / t0)});
        out.steps.push_back({grid.foldColumn(column), grid.foldRow(row), static_cast<float>(t0), static_cast<float>(t1),
                             static_cast<float>(1 / t1), right, static_cast<float>(right ? ey : ex)});
        out.chunks.back().end = out.steps.size();
        column += right;
        row += below;
        t0 = t1;
    }
    return out;
}

void sweepTexels(const SweepGrid& grid, unsigned threads, const SweepCall& sweep, std::vector<float>& out) {
    constexpr int kRows = 16;  // a task
    parallelFor(static_cast<std::size_t>((grid.rows() + kRows - 1) / kRows), threads, [&](std::size_t task) {
        const int first = static_cast<int>(task) * kRows, last = std::min(first + kRows, grid.rows());
        float values[kSweepLanes];
        for (int x = 0; x < grid.columns(); x += kSweepLanes) {
            SweepHints hints;
            const int count = std::min(kSweepLanes, grid.columns() - x);
            for (int y = first; y < last; ++y) {
                sweep(x, y, hints, values);
                grid.putBack(x, y, count, values, out);
            }
        }
    });
}

}  // namespace nacre
