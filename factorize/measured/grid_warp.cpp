#include "factorize/measured/grid_warp.hpp"

namespace nacre {

namespace {
struct AxisWeight {
    std::size_t low, high;
    float weight;  // of high
};
struct Cell {
    std::size_t index;  // of the vertex at the cell's origin
    double x, y;        // inside the cell, [0, 1]
    std::size_t row;
};
}  // namespace

static AxisWeight locate(const std::vector<float>& axis, double at) {
    const auto above = std::upper_bound(axis.begin(), axis.end(), at);
    if (above == axis.begin()) return {0, 0, 0};
    if (above == axis.end()) return {axis.size() - 1, axis.size() - 1, 0};
    const auto high = static_cast<std::size_t>(above - axis.begin());
    const double low = axis[high - 1];
    return {high - 1, high, static_cast<float>((at - low) / (axis[high] - low))};
}

SliceBlend blendSlices(const std::vector<float>& first, const std::vector<float>& second, double atFirst,
                       double atSecond) {
    const AxisWeight a = locate(first, atFirst), b = locate(second, atSecond);
    SliceBlend out;
    const auto add = [&](std::size_t i, std::size_t j, float weight) {
        if (weight == 0) return;
        const auto n = static_cast<std::size_t>(out.count++);
        out.slice[n] = i * second.size() + j;
        out.weight[n] = weight;
    };
    add(a.low, b.low, (1 - a.weight) * (1 - b.weight));
    add(a.low, b.high, (1 - a.weight) * b.weight);
    add(a.high, b.low, a.weight * (1 - b.weight));
    add(a.high, b.high, a.weight * b.weight);
    return out;
}

static Cell cellAt(const SlicedGrid& grid, const Vec2& at) {
    const double x = clamp01(at.x) * static_cast<double>(grid.width - 1);
    const double y = clamp01(at.y) * static_cast<double>(grid.height - 1);
    const std::size_t column = std::min(static_cast<std::size_t>(x), grid.width - 2);
    const std::size_t row = std::min(static_cast<std::size_t>(y), grid.height - 2);
    return {row * grid.width + column, x - static_cast<double>(column), y - static_cast<double>(row), row};
}

static double bilinear(const float* origin, std::size_t width, double x, double y) {
    const double low = origin[0] + x * (origin[1] - origin[0]);
    const double high = origin[width] + x * (origin[width + 1] - origin[width]);
    return low + y * (high - low);
}

double interpolate(const SlicedGrid& grid, std::size_t slice, const Vec2& at) {
    const Cell cell = cellAt(grid, at);
    return bilinear(&grid.values[slice * grid.width * grid.height + cell.index], grid.width, cell.x, cell.y);
}

/// Trapezoids: exact for bilinear functions. Lengths in cells.
GridWarp makeGridWarp(SlicedGrid grid) {
    const std::size_t width = grid.width, height = grid.height, slices = grid.values.size() / (width * height);
    GridWarp out{std::move(grid), {}, {}, {}};
    out.rowCdf.resize(out.density.values.size());
    out.columnCdf.resize(slices * height);
    for (std::size_t slice = 0; slice < slices; ++slice) {
        float* values = &out.density.values[slice * width * height];
        float* rows = &out.rowCdf[slice * width * height];
        std::vector<double> columnSums(height, 0.0), rowSums(width * height, 0.0);
        for (std::size_t y = 0; y < height; ++y)
            for (std::size_t x = 1; x < width; ++x)
                rowSums[y * width + x] =
                    rowSums[y * width + x - 1] + 0.5 * (values[y * width + x - 1] + values[y * width + x]);
        for (std::size_t y = 1; y < height; ++y)
            columnSums[y] = columnSums[y - 1] + 0.5 * (rowSums[y * width - 1] + rowSums[(y + 1) * width - 1]);
        const double total = columnSums[height - 1];
        if (!(total > 0)) {
            out.emptySlice = slice;
            return out;
        }
        for (std::size_t i = 0; i < width * height; ++i) {
            values[i] = static_cast<float>(values[i] / total);
            rows[i] = static_cast<float>(rowSums[i] / total);
        }
        for (std::size_t y = 0; y < height; ++y)
            out.columnCdf[slice * height + y] = static_cast<float>(columnSums[y] / total);
    }
    return out;
}

/// Inside a cell the row integrals are linear in y (r0 to r1) and the density is linear in x (c0 to c1):
/// ∫ (c0 + t (c1 − c0)) dt = x (c0 + x (c1 − c0)/2).
Vec2 toUniform(const GridWarp& warp, const SliceBlend& blend, const Vec2& at) {
    const SlicedGrid& grid = warp.density;
    const std::size_t width = grid.width;
    const Cell cell = cellAt(grid, at);
    double c0 = 0, c1 = 0, before = 0, r0 = 0, r1 = 0, below = 0;
    for (std::size_t n = 0; n < static_cast<std::size_t>(blend.count); ++n) {
        const double w = blend.weight[n];
        const std::size_t origin = blend.slice[n] * width * grid.height;
        const float* values = &grid.values[origin + cell.index];
        const float* rows = &warp.rowCdf[origin + cell.index];
        const float* totals = &warp.rowCdf[origin + (cell.row + 1) * width - 1];
        c0 += w * (values[0] + cell.y * (values[width] - values[0]));
        c1 += w * (values[1] + cell.y * (values[width + 1] - values[1]));
        before += w * (rows[0] + cell.y * (rows[width] - rows[0]));
        r0 += w * totals[0];
        r1 += w * totals[width];
        below += w * warp.columnCdf[blend.slice[n] * grid.height + cell.row];
    }
    const double row = r0 + cell.y * (r1 - r0);
    const double x = before + cell.x * (c0 + 0.5 * cell.x * (c1 - c0));
    return {row > 0 ? clamp01(x / row) : 0.0, clamp01(below + cell.y * (r0 + 0.5 * cell.y * (r1 - r0)))};
}

}  // namespace nacre
