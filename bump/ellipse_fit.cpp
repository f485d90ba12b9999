#include "bump/ellipse_fit.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <tuple>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "core/sampling.hpp"

namespace nacre {
namespace {

#define NACRE_KERNEL "bump/ellipse_kernel.inl"
#include "core/wide.inl"

const auto kMisjudged = NACRE_WIDEST(misjudged);

constexpr double kLargestScale = 128;  // 1/radius: half floats still tell where a thinner ellipse would be
constexpr int kRounds = 150;           // of the simplex
constexpr float kConverged = 2e-4f;    // share of the disk by which the simplex' corners still differ

using Parameters = std::array<float, 5>;  // m11, m12, m22, o1, o2

Parameters toParameters(const HorizonEllipse& e) {
    return {static_cast<float>(e.m11), static_cast<float>(e.m12), static_cast<float>(e.m22), static_cast<float>(e.o1),
            static_cast<float>(e.o2)};
}

HorizonEllipse always(bool lit) { return {0, 0, 0, lit ? 0.0 : 2.0, 0}; }

/// Unit eigenvector of the larger eigenvalue of a symmetric matrix, and both eigenvalues, the larger first.
struct Axes {
    Vec2 direction;
    double large, small;
};
Axes axesOf(double xx, double xy, double yy) {
    const double angle = 0.5 * std::atan2(2 * xy, xx - yy), middle = 0.5 * (xx + yy);
    const double spread = std::hypot(0.5 * (xx - yy), xy);
    return {{std::cos(angle), std::sin(angle)}, middle + spread, middle - spread};
}

/// The same ellipse with M's eigenvalues in [0, kLargestScale].
HorizonEllipse normalised(const Parameters& p) {
    const Axes axes = axesOf(p[0], p[1], p[2]);
    const Vec2 u = axes.direction, v(-u.y, u.x), o(p[3], p[4]);
    const auto part = [](double scale, double offset) {  // along one axis: |scale x + offset| ≤ …
        const double size = std::abs(scale), kept = std::min(size, kLargestScale);
        const double centre = size > 0 ? kept / size : 1;  // a wider ellipse about the same centre
        return Vec2(kept, (scale < 0 ? -offset : offset) * centre);
    };
    const Vec2 first = part(axes.large, glm::dot(o, u)), second = part(axes.small, glm::dot(o, v));
    const double p1 = first.x, p2 = second.x;
    return {p1 * u.x * u.x + p2 * v.x * v.x, p1 * u.x * u.y + p2 * v.x * v.y, p1 * u.y * u.y + p2 * v.y * v.y,
            first.y * u.x + second.y * v.x, first.y * u.y + second.y * v.y};
}

/// Centre and covariance of the directions that are lit.
struct Moments {
    double lit = 0;  ///< share of the disk
    Vec2 centre{0};
    double xx = 0, xy = 0, yy = 0;
};

using Cost = std::function<float(const Parameters&)>;

/// Radii along the moments' axes: from an evenly filled ellipse's, by going up and down with steps that halve.
HorizonEllipse fitRadii(const Moments& m, const Cost& cost) {
    const Axes axes = axesOf(m.xx, m.xy, m.yy);
    constexpr double kThinnest = 1 / kLargestScale;
    // An evenly filled ellipse has a covariance of radius²/4.
    std::array<double, 2> radii = {std::max(2 * std::sqrt(std::max(axes.large, 0.0)), kThinnest),
                                   std::max(2 * std::sqrt(std::max(axes.small, 0.0)), kThinnest)};
    const auto ellipse = [&](const std::array<double, 2>& r) {
        return ellipseFromAxes(m.centre, axes.direction, r[0], r[1]);
    };
    float best = cost(toParameters(ellipse(radii)));
    for (double step = 0.3; step > 0.004; step /= 2)
        for (int turn = 0; turn < 4; ++turn) {
            bool moved = false;
            for (std::size_t axis = 0; axis < 2; ++axis)
                for (const double factor : {1 + step, 1 / (1 + step)}) {
                    std::array<double, 2> trial = radii;
                    trial[axis] = std::max(trial[axis] * factor, kThinnest);
                    const float value = cost(toParameters(ellipse(trial)));
                    if (!(value < best)) continue;
                    best = value;
                    radii = trial;
                    moved = true;
                }
            if (!moved) break;
        }
    return ellipse(radii);
}

/// Nelder & Mead 1965 from `start`: improves `start` in place. \return its cost
float simplex(Parameters& start, const Cost& cost) {
    constexpr std::size_t n = std::tuple_size_v<Parameters>;
    struct Corner {
        Parameters at;
        float value;
    };
    std::array<Corner, n + 1> corners;
    for (std::size_t i = 0; i <= n; ++i) {
        corners[i].at = start;
        if (i > 0) corners[i].at[i - 1] += 0.15f + 0.1f * std::abs(start[i - 1]);
        corners[i].value = cost(corners[i].at);
    }
    const auto byValue = [](const Corner& a, const Corner& b) { return a.value < b.value; };
    for (int round = 0; round < kRounds; ++round) {
        std::stable_sort(corners.begin(), corners.end(), byValue);
        if (corners[n].value - corners[0].value < kConverged) break;
        Parameters middle{};
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t k = 0; k < n; ++k) middle[k] += corners[i].at[k] / n;
        const auto along = [&](float t) {
            Corner c;
            for (std::size_t k = 0; k < n; ++k) c.at[k] = middle[k] + t * (corners[n].at[k] - middle[k]);
            c.value = cost(c.at);
            return c;
        };
        const Corner reflected = along(-1);
        if (reflected.value < corners[0].value) {
            const Corner expanded = along(-2);
            corners[n] = expanded.value < reflected.value ? expanded : reflected;
        } else if (reflected.value < corners[n - 1].value) {
            corners[n] = reflected;
        } else {
            const Corner contracted = along(reflected.value < corners[n].value ? -0.5f : 0.5f);
            if (contracted.value < std::min(reflected.value, corners[n].value)) {
                corners[n] = contracted;
                continue;
            }
            for (std::size_t i = 1; i <= n; ++i) {
                for (std::size_t k = 0; k < n; ++k) corners[i].at[k] = 0.5f * (corners[i].at[k] + corners[0].at[k]);
                corners[i].value = cost(corners[i].at);
            }
        }
    }
    const Corner& best = *std::min_element(corners.begin(), corners.end(), byValue);
    start = best.at;
    return best.value;
}

}  // namespace

EllipseFitter::EllipseFitter(int directions, EllipseFit fit) : fit_(fit) {
    const int count = (directions + kRound - 1) / kRound * kRound;
    for (int k = 0; k < count; ++k) {
        const double angle = 2 * kPi * k / count, radius = std::sqrt(radicalInverse(k, 2) + 0.5 / count);
        cosines_.push_back(static_cast<float>(std::cos(angle)));
        sines_.push_back(static_cast<float>(std::sin(angle)));
        radii_.push_back(static_cast<float>(radius));
    }
}

HorizonEllipse EllipseFitter::fit(const std::vector<float>& lit) const {
    return fit_ == EllipseFit::Radii ? fitPoints(lit) : fitArea(lit);
}

/// HSE section 3.1: one direction an azimuth, spread evenly over the disk, which is lit or not.
HorizonEllipse EllipseFitter::fitPoints(const std::vector<float>& lit) const {
    Moments m;
    for (std::size_t k = 0; k < lit.size(); ++k) {
        if (radii_[k] > lit[k]) continue;
        const Vec2 p = Vec2(cosines_[k], sines_[k]) * static_cast<double>(radii_[k]);
        m.lit += 1;
        m.centre += p;
        m.xx += p.x * p.x, m.xy += p.x * p.y, m.yy += p.y * p.y;
    }
    if (m.lit == static_cast<double>(lit.size())) return always(true);
    if (m.lit == 0) return always(false);
    m.centre /= m.lit;
    m.xx = m.xx / m.lit - m.centre.x * m.centre.x;
    m.xy = m.xy / m.lit - m.centre.x * m.centre.y;
    m.yy = m.yy / m.lit - m.centre.y * m.centre.y;
    const Cost wrong = [&](const Parameters& e) {
        float count = 0;
        for (std::size_t k = 0; k < lit.size(); ++k) {
            const float x = cosines_[k] * radii_[k], y = sines_[k] * radii_[k];
            const float mx = e[0] * x + e[1] * y + e[3], my = e[1] * x + e[2] * y + e[4];
            count += (mx * mx + my * my <= 1) != (radii_[k] <= lit[k]);
        }
        return count;
    };
    return fitRadii(m, wrong);
}

HorizonEllipse EllipseFitter::fitArea(const std::vector<float>& lit) const {
    const int count = static_cast<int>(lit.size());
    const Cost cost = [&](const Parameters& p) {
        return kMisjudged(lit.data(), cosines_.data(), sines_.data(), count, p.data()) / static_cast<float>(count);
    };
    Moments m;  // of the area within the radii
    for (std::size_t k = 0; k < lit.size(); ++k) {
        const double r = lit[k], square = r * r, x = cosines_[k], y = sines_[k];
        m.lit += square / 2;
        m.centre += Vec2(x, y) * (square * r / 3);
        m.xx += x * x * square * square / 4, m.xy += x * y * square * square / 4, m.yy += y * y * square * square / 4;
    }
    const double share = 2 * m.lit / count;
    constexpr double kNothing = 1e-5;  // of the disk
    if (share > 1 - kNothing) return always(true);
    if (share < kNothing) return always(false);
    m.centre /= m.lit;
    m.xx = m.xx / m.lit - m.centre.x * m.centre.x;
    m.xy = m.xy / m.lit - m.centre.x * m.centre.y;
    m.yy = m.yy / m.lit - m.centre.y * m.centre.y;
    Parameters best = toParameters(fitRadii(m, cost));
    const double value = simplex(best, cost);
    if (std::min(share, 1 - share) <= value) return always(share > 0.5);
    return normalised(best);
}

}  // namespace nacre
