// The grid of rings between points and harmonics, and the window that carries points onto it.
#pragma once

#include <span>
#include <vector>

#include "core/math.hpp"
#include "envmaps/sphere_transform.hpp"

namespace nacre {

/// Smallest even number ≥ n whose only prime factors are 2, 3 and 5: lengths that FFTs like.
int fastLength(int n);

/// exp(β(√(1 − x²) − 1)) over kWidth grid steps, tabulated, and its Fourier transform.
class SphereWindow {
public:
    static constexpr int kWidth = 8;
    static constexpr double kOversampling = 1.5;

    SphereWindow();
    /// Weights of the kWidth grid lines around `position` [grid steps]; \return the first line.
    int weights(double position, std::span<double, kWidth> out) const {
        const double first = std::ceil(position - 0.5 * kWidth);
        const double place = (first - position + 0.5 * kWidth) * kSteps;  // in [0, kSteps)
        const int cell = static_cast<int>(place);
        const double t = place - cell;
        for (int i = 0; i < kWidth; ++i) {
            const double* entry = &table_[static_cast<std::size_t>(i * kSteps + cell)];
            out[i] = entry[0] + t * (entry[1] - entry[0]);
        }
        return static_cast<int>(first);
    }
    /// Σ over grid lines of weight · e^{−ik·angle}, k in cycles around a circle of `lines` lines.
    double transform(double k, int lines) const;

private:
    static constexpr int kSteps = 4096;  ///< table entries a grid step: linear interpolation errs by 2e-7
    std::vector<double> table_;
};

/// The one window, tabulated at the first call.
const SphereWindow& sphereWindow();

/// Rings θ_j = (j + ½)π/rows, φ_n = 2πn/columns of four values each, row by row. Beyond a pole a ring continues on the
/// other side: (−1 − j, n) is (j, n + columns/2).
struct SphereGrid {
    int rows = 0, columns = 0;
    std::vector<Vec4> values;
};

/// A grid fine enough for harmonics up to `order`, all zero.
SphereGrid makeSphereGrid(int order);

/// Adds each point's weight, spread by the window.
void spreadPoints(std::span<const SpherePoint> points, const SphereWindow& window, SphereGrid& grid, unsigned threads);

/// The grid read at each direction through the window.
std::vector<Vec4> gatherPoints(const SphereGrid& grid, const SphereWindow& window, std::span<const Vec3> directions,
                               unsigned threads);

}  // namespace nacre
