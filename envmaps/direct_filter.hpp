// Sums over the points near a direction: for the middle of kernels too narrow for harmonics.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "envmaps/sphere_transform.hpp"

namespace nacre {

/// Points sorted into cells on the sphere, so that those within an angle are found.
class PointIndex {
public:
    /// \param radius  largest angle that will be asked for [rad], > 0
    PointIndex(std::span<const SpherePoint> points, double radius);

    /// Σ w_i k(θ_i) over the points within the radius.
    /// \param kernel  by the chord 2 sin(θ/2)
    template <class Kernel>
    Vec4 sum(const Vec3& direction, const Kernel& kernel) const {
        Vec4 out(0);
        for (const int cell : neighbours_[cellOf(direction)])
            for (std::size_t i = start_[cell]; i < start_[cell + 1]; ++i) {
                const Vec3 difference = points_[i].direction - direction;
                const double chord2 = glm::dot(difference, difference);
                if (chord2 < chordLimit2_) out += kernel(chord2) * points_[i].weight;
            }
        return out;
    }

private:
    std::size_t cellOf(const Vec3& direction) const;

    int edge_ = 1;  ///< cells along an edge of the cube that carries them
    double chordLimit2_ = 0;
    std::vector<SpherePoint> points_;  ///< sorted by cell
    std::vector<std::size_t> start_;
    std::vector<std::vector<int>> neighbours_;  ///< of each cell: the cells that hold something within the radius
};

/// A kernel by squared chord: tabulated over chords up to 2 sin(radius/2), linear between entries.
class ChordTable {
public:
    /// \param width  angle over which the kernel changes [rad]
    ChordTable(const std::function<double(double theta)>& kernel, double radius, double width);
    double operator()(double chord2) const {
        const double place = std::sqrt(chord2) * scale_;
        const std::size_t i = std::min(static_cast<std::size_t>(place), table_.size() - 2);
        return table_[i] + (place - static_cast<double>(i)) * (table_[i + 1] - table_[i]);
    }

private:
    double scale_ = 0;
    std::vector<double> table_;
};

}  // namespace nacre
