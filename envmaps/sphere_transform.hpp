// Spherical harmonics of scattered points, fast: Σ_i w_i Y*_lm(d_i) for any directions, and back. Both go through rings
// of equal latitude and the window transform for non-uniform points (Dutt & Rokhlin 1993; the window is Barnett,
// Magland & af Klinteberg 2019's), so that the sum over the points themselves is computed, not over a resampled map.
#pragma once

#include <span>
#include <vector>

#include "core/math.hpp"

namespace nacre {

/// Coefficients of four real functions on the sphere at once (red, green, blue, and a weight) up to degree `order`:
///   f(d) = Σ_l Σ_m a_lm Y_lm(d),  Y_lm = N_lm P_l^m(cosθ) e^{imφ},  θ from +z, φ from +x, orthonormal, with the phase
/// (−1)^m. m ≥ 0 is stored; a_l,−m = (−1)^m conj(a_lm) as the functions are real.
class Harmonics {
public:
    struct Value {
        Vec4 re{0}, im{0};
    };
    explicit Harmonics(int order = 0);
    int order() const { return order_; }
    Value& at(int l, int m) { return values_[index(l, m)]; }
    const Value& at(int l, int m) const { return values_[index(l, m)]; }

private:
    /// m after m, each from l = m to the order.
    std::size_t index(int l, int m) const {
        return static_cast<std::size_t>(m) * (2 * order_ + 3 - m) / 2 + static_cast<std::size_t>(l - m);
    }
    int order_ = 0;
    std::vector<Value> values_;
};

inline constexpr int kMaxHarmonicOrder = 1500;  ///< sin^m stays above the smallest double where it matters

/// A point on the sphere with its four weights.
struct SpherePoint {
    Vec3 direction;  ///< unit
    Vec4 weight;
};

/// a_lm = Σ_i w_i Y*_lm(d_i), l ≤ order. Exact but for the window's 1e-6 of the largest sums.
/// Cost O(points · 64 + order³). Same bits for any thread count.
/// \throws std::invalid_argument unless 0 ≤ order ≤ kMaxHarmonicOrder
Harmonics analyseHarmonics(std::span<const SpherePoint> points, int order, unsigned threads = 0);

/// f(d_i) for each direction. Same window, same accuracy.
std::vector<Vec4> synthesiseHarmonics(const Harmonics& harmonics, std::span<const Vec3> directions,
                                      unsigned threads = 0);

}  // namespace nacre
