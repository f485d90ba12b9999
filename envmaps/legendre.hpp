// Associated Legendre functions, normalised for orthonormal harmonics, by the recurrence that is stable in l.
#pragma once

#include <vector>

#include "core/math.hpp"

namespace nacre {

/// Steps P̄_l^m(cosθ_q), P̄ = √((2l+1)/4π · (l−m)!/(l+m)!) P_l^m with the phase (−1)^m, through l = m, m+1, … for one m
/// and many rings q at once:
///   P̄_mm = −√((2m+1)/2m) sinθ P̄_{m−1,m−1},  P̄_lm = a_lm (cosθ P̄_{l−1,m} − P̄_{l−2,m}/a_{l−1,m}),
///   a_lm = √((4l²−1)/(l²−m²)).
class LegendreColumn {
public:
    /// \param cosines, sines  of the rings' θ
    LegendreColumn(int m, const std::vector<double>& cosines, const std::vector<double>& sines)
        : m_(m), l_(m), cosines_(cosines), before_(cosines.size(), 0), now_(cosines.size()) {
        double scale = std::sqrt(1 / (4 * kPi));
        for (int k = 1; k <= m; ++k) scale *= -std::sqrt((2.0 * k + 1) / (2.0 * k));
        for (std::size_t q = 0; q < now_.size(); ++q) now_[q] = scale * std::pow(sines[q], m);
    }
    int degree() const { return l_; }
    const std::vector<double>& values() const { return now_; }
    void next() {
        const auto factor = [&](double l) {
            return std::sqrt((4 * l * l - 1) / (l * l - static_cast<double>(m_) * m_));
        };
        const double a = factor(l_ + 1), b = l_ == m_ ? 0 : a / factor(l_);
        for (std::size_t q = 0; q < now_.size(); ++q) {
            const double value = a * cosines_[q] * now_[q] - b * before_[q];
            before_[q] = now_[q];
            now_[q] = value;
        }
        ++l_;
    }

private:
    int m_, l_;
    const std::vector<double>& cosines_;
    std::vector<double> before_, now_;
};

}  // namespace nacre
