#include "envmaps/sphere_window.hpp"

#include <array>

#include "core/parallel.hpp"

namespace nacre {
namespace {

constexpr int kWidth = SphereWindow::kWidth;
// Barnett et al. 2019, section 4.2: β = 0.98 π w (1 − 1/2σ).
constexpr double kBeta = 0.98 * kPi * kWidth * (1 - 0.5 / SphereWindow::kOversampling);

double windowAt(double x) {  // x in half widths
    const double inside = 1 - x * x;
    return inside > 0 ? std::exp(kBeta * (std::sqrt(inside) - 1)) : 0;
}

struct GridPosition {
    double row, column;
};

GridPosition positionOf(const SphereGrid& grid, const Vec3& d) {
    const double theta = std::atan2(std::sqrt(d.x * d.x + d.y * d.y), d.z), phi = std::atan2(d.y, d.x);
    return {theta * grid.rows / kPi - 0.5, (phi < 0 ? phi + 2 * kPi : phi) * grid.columns / (2 * kPi)};
}

/// A row index beyond a pole: the row it continues in; `column` moves to the other side.
int foldRow(const SphereGrid& grid, int row, int& column) {
    if (row >= 0 && row < grid.rows) return row;
    column += grid.columns / 2;
    return row < 0 ? -1 - row : 2 * grid.rows - 1 - row;
}

int wrapColumn(const SphereGrid& grid, int column) {
    while (column < 0) column += grid.columns;
    while (column >= grid.columns) column -= grid.columns;
    return column;
}

/// The places of points sorted by the row above them, so that a band of rows finds its points together.
struct SortedPoints {
    std::vector<std::uint32_t> order;
    std::vector<std::uint32_t> start;  ///< first of each row; rows + 2 entries, row −1 first
};

SortedPoints sortByRow(const std::vector<GridPosition>& positions, int rows) {
    SortedPoints out;
    out.start.assign(static_cast<std::size_t>(rows) + 2, 0);
    const auto bin = [](const GridPosition& p) { return static_cast<std::size_t>(std::floor(p.row) + 1); };
    for (const GridPosition& p : positions) ++out.start[std::min(bin(p) + 1, out.start.size() - 1)];
    for (std::size_t i = 1; i < out.start.size(); ++i) out.start[i] += out.start[i - 1];
    std::vector<std::uint32_t> next(out.start);
    out.order.resize(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
        out.order[next[std::min(bin(positions[i]), next.size() - 2)]++] = static_cast<std::uint32_t>(i);
    return out;
}

}  // namespace

int fastLength(int n) {
    for (int candidate = n + n % 2;; candidate += 2) {
        int rest = candidate;
        for (const int factor : {2, 3, 5})
            while (rest % factor == 0) rest /= factor;
        if (rest == 1) return candidate;
    }
}

SphereWindow::SphereWindow() : table_(static_cast<std::size_t>(kWidth) * kSteps + 1) {
    for (std::size_t i = 0; i < table_.size(); ++i)
        table_[i] = windowAt((static_cast<double>(i) / kSteps - 0.5 * kWidth) / (0.5 * kWidth));
}

const SphereWindow& sphereWindow() {
    static const SphereWindow window;
    return window;
}

double SphereWindow::transform(double k, int lines) const {
    constexpr int kNodes = 64;  // midpoint rule: the window and its slopes vanish (to e^−β) at the ends
    double sum = 0;
    for (int i = 0; i < kNodes; ++i) {
        const double x = (i + 0.5) / kNodes;
        sum += windowAt(x) * std::cos(kPi * kWidth * k * x / lines);
    }
    return sum * kWidth / kNodes;
}

SphereGrid makeSphereGrid(int order) {
    SphereGrid grid;
    const int least = std::max(2 * kWidth, static_cast<int>(std::ceil(SphereWindow::kOversampling * (2 * order + 1))));
    grid.columns = fastLength(least);
    grid.rows = fastLength((least + 1) / 2);
    grid.values.assign(static_cast<std::size_t>(grid.rows) * grid.columns, Vec4(0));
    return grid;
}

void spreadPoints(std::span<const SpherePoint> points, const SphereWindow& window, SphereGrid& grid, unsigned threads) {
    std::vector<GridPosition> positions(points.size());
    constexpr std::size_t kBlock = 4096;
    parallelFor((points.size() + kBlock - 1) / kBlock, threads, [&](std::size_t block) {
        for (std::size_t i = block * kBlock; i < std::min(points.size(), (block + 1) * kBlock); ++i)
            positions[i] = positionOf(grid, points[i].direction);
    });
    const SortedPoints sorted = sortByRow(positions, grid.rows);
    constexpr int kBand = 32;  // rows a task owns: it alone writes them
    parallelFor((grid.rows + kBand - 1) / kBand, threads, [&](std::size_t band) {
        const int low = static_cast<int>(band) * kBand, high = std::min(grid.rows, low + kBand);
        const auto visit = [&](std::size_t k) {
            const std::uint32_t i = sorted.order[k];
            std::array<double, kWidth> rowWeight, columnWeight;
            const int row = window.weights(positions[i].row, rowWeight);
            const int column = window.weights(positions[i].column, columnWeight);
            for (int r = 0; r < kWidth; ++r) {
                int firstColumn = column;
                const int folded = foldRow(grid, row + r, firstColumn);
                if (folded < low || folded >= high) continue;
                const Vec4 weight = rowWeight[r] * points[i].weight;
                Vec4* line = &grid.values[static_cast<std::size_t>(folded) * grid.columns];
                firstColumn = wrapColumn(grid, firstColumn);
                if (firstColumn + kWidth <= grid.columns) {
                    for (int c = 0; c < kWidth; ++c) line[firstColumn + c] += columnWeight[c] * weight;
                } else {
                    for (int c = 0; c < kWidth; ++c)
                        line[wrapColumn(grid, firstColumn + c)] += columnWeight[c] * weight;
                }
            }
        };
        // Points whose window reaches these rows, across a pole too: those near it are near it on both sides.
        const int first = std::max(0, low - kWidth / 2), last = std::min(grid.rows + 1, high + kWidth / 2 + 2);
        for (std::size_t k = sorted.start[first]; k < sorted.start[last]; ++k) visit(k);
    });
}

std::vector<Vec4> gatherPoints(const SphereGrid& grid, const SphereWindow& window, std::span<const Vec3> directions,
                               unsigned threads) {
    std::vector<Vec4> out(directions.size());
    constexpr std::size_t kBlock = 1024;
    parallelFor((directions.size() + kBlock - 1) / kBlock, threads, [&](std::size_t block) {
        for (std::size_t i = block * kBlock; i < std::min(directions.size(), (block + 1) * kBlock); ++i) {
            const GridPosition position = positionOf(grid, directions[i]);
            std::array<double, kWidth> rowWeight, columnWeight;
            const int row = window.weights(position.row, rowWeight);
            const int column = window.weights(position.column, columnWeight);
            Vec4 sum(0);
            for (int r = 0; r < kWidth; ++r) {
                int firstColumn = column;
                const int folded = foldRow(grid, row + r, firstColumn);
                const Vec4* line = &grid.values[static_cast<std::size_t>(folded) * grid.columns];
                firstColumn = wrapColumn(grid, firstColumn);
                Vec4 lineSum(0);
                if (firstColumn + kWidth <= grid.columns) {
                    for (int c = 0; c < kWidth; ++c) lineSum += columnWeight[c] * line[firstColumn + c];
                } else {
                    for (int c = 0; c < kWidth; ++c)
                        lineSum += columnWeight[c] * line[wrapColumn(grid, firstColumn + c)];
                }
                sum += rowWeight[r] * lineSum;
            }
            out[i] = sum;
        }
    });
    return out;
}

}  // namespace nacre
