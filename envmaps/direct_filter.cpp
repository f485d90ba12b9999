#include "envmaps/direct_filter.hpp"

#include "core/directions.hpp"
#include "core/environment.hpp"

namespace nacre {

PointIndex::PointIndex(std::span<const SpherePoint> points, double radius) {
    constexpr int kMostCells = 24;  // the search for neighbours compares all pairs
    edge_ = std::clamp(static_cast<int>(kPi / 2 / (0.5 * radius)), 1, kMostCells);
    chordLimit2_ = sqr(2 * std::sin(0.5 * std::min(radius, kPi)));
    const std::size_t cells = static_cast<std::size_t>(6 * edge_) * edge_;
    start_.assign(cells + 1, 0);
    std::vector<std::size_t> cell(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) ++start_[(cell[i] = cellOf(points[i].direction)) + 1];
    for (std::size_t c = 0; c < cells; ++c) start_[c + 1] += start_[c];
    std::vector<std::size_t> next(start_);
    points_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) points_[next[cell[i]]++] = points[i];

    std::vector<Vec3> middle(cells);
    std::vector<double> reach(cells);  // angle from the middle to the farthest corner
    for (std::size_t c = 0; c < cells; ++c) {
        const int x = static_cast<int>(c) % edge_, y = static_cast<int>(c) / edge_;
        middle[c] = envTexelDirection(EnvLayout::Cube, edge_, x, y);
        for (const auto& [i, j] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
            const double inside = y % edge_ == edge_ - 1 && j == 1 ? 1 - 1e-9 : j;  // y = N is the next face's
            reach[c] =
                std::max(reach[c], angleBetween(middle[c], envDirection(EnvLayout::Cube, edge_, x + i, y + inside)));
        }
    }
    neighbours_.resize(cells);
    for (std::size_t c = 0; c < cells; ++c)
        for (std::size_t other = 0; other < cells; ++other) {
            const double far = reach[c] + reach[other] + radius + 1e-6;
            if (far >= kPi || glm::dot(middle[c], middle[other]) >= std::cos(far))
                neighbours_[c].push_back(static_cast<int>(other));
        }
}

std::size_t PointIndex::cellOf(const Vec3& direction) const {
    const glm::dvec2 p = envPosition(EnvLayout::Cube, edge_, direction);
    const int face = std::clamp(static_cast<int>(p.y / edge_), 0, 5);
    const int x = std::clamp(static_cast<int>(p.x), 0, edge_ - 1);
    const int y = std::clamp(static_cast<int>(p.y), face * edge_, (face + 1) * edge_ - 1);
    return static_cast<std::size_t>(y) * edge_ + x;
}

ChordTable::ChordTable(const std::function<double(double theta)>& kernel, double radius, double width) {
    constexpr double kStepsPerWidth = 256;  // linear interpolation errs by 2e-6 of the peak
    constexpr std::size_t kMost = 1 << 16;
    const double longest = 2 * std::sin(0.5 * std::min(radius, kPi));
    const std::size_t steps =
        std::clamp<std::size_t>(static_cast<std::size_t>(longest / width * kStepsPerWidth), 64, kMost);
    scale_ = static_cast<double>(steps) / longest;
    table_.resize(steps + 2);
    for (std::size_t i = 0; i < table_.size(); ++i)
        table_[i] = kernel(2 * std::asin(std::min(1.0, 0.5 * static_cast<double>(i) / scale_)));
}

}  // namespace nacre
