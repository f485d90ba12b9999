#include "shading/hybrid/plane_factors.hpp"

#include "core/error.hpp"
#include "core/math.hpp"

namespace nacre {
namespace {

double fromMiddle(double x, double y, PlaneSource source) {
    if (source == PlaneSource::Uniform) return std::atan(x * y / std::sqrt(1 + x * x + y * y));
    const double rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
    return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2 * kPi);
}

}  // namespace

std::vector<double> planeFactors(int size, double halfWidth, PlaneSource source) {
    require(size >= 1 && halfWidth > 0 && std::isfinite(halfWidth), "planeFactors: expected size >= 1, halfWidth > 0");
    const int corners = size + 1;
    std::vector<double> sums;
    for (int j = 0; j < corners; ++j)
        for (int i = 0; i < corners; ++i)
            sums.push_back(fromMiddle(halfWidth * (2.0 * i / size - 1), halfWidth * (2.0 * j / size - 1), source));
    const auto at = [&](int i, int j) { return sums[static_cast<std::size_t>(j * corners + i)]; };
    std::vector<double> out;
    for (int j = 0; j < size; ++j)
        for (int i = 0; i < size; ++i) out.push_back(at(i + 1, j + 1) - at(i, j + 1) - at(i + 1, j) + at(i, j));
    return out;
}

}  // namespace nacre
