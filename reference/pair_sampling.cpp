#include "reference/pair_sampling.hpp"

namespace nacre {

static constexpr double kSmallestThetaH = 1e-6;  // [rad]; a thousandth of the width of a lobe of alpha = 1e-3
static const double kPeakLogRange = std::log(kPi / 2 / kSmallestThetaH);

static double fraction(double x) { return x - std::floor(x); }

std::array<double, 4> kroneckerPoint(std::uint64_t n, std::uint64_t seed) {
    constexpr double g = 1.1673039782614187;
    // n < 2^32 keeps 20 bits behind the point in n·α.
    std::array<double, 4> point{};
    double alpha = 1;
    for (std::size_t k = 0; k < point.size(); ++k) {
        alpha /= g;
        const double start =
            fraction(0.5 + static_cast<double>(seed % 65536) * 0.6180339887498949 * (static_cast<double>(k) + 1));
        point[k] = fraction(start + static_cast<double>(n) * alpha);
    }
    return point;
}

double drawThetaH(ThetaHDraw draw, double u) {
    if (draw == ThetaHDraw::Body) return kPi / 2 * u * u;
    return kSmallestThetaH * std::exp(kPeakLogRange * u);
}

double thetaHDensity(double thetaH) {
    const double body = 0.5 * std::sqrt(2 / (kPi * thetaH));  // du/dθh of θh = (π/2)u²
    const double peak = thetaH < kSmallestThetaH ? 0 : 1 / (thetaH * kPeakLogRange);
    return 0.5 * (body + peak);
}

WeightedPair drawPair(std::uint64_t n, std::uint64_t count, std::uint64_t seed) {
    const auto [u0, u1, u2, u3] = kroneckerPoint(n, seed);
    HalfDifference angles;
    angles.thetaH = drawThetaH(n < count / 2 ? ThetaHDraw::Body : ThetaHDraw::Peak, u0);
    angles.thetaD = std::asin(std::sqrt(u1));
    angles.phiD = 2 * kPi * u2;
    angles.phiH = 2 * kPi * u3;
    WeightedPair out{fromHalfDifference(angles), 0};
    const double cosI = out.pair.wi.z, cosO = out.pair.wo.z;
    if (cosI <= 0 || cosO <= 0 || angles.thetaH <= 0) return out;
    out.weight = 8 * kPi * kPi * cosI * cosO * std::sin(angles.thetaH) / thetaHDensity(angles.thetaH);
    return out;
}

}  // namespace nacre
