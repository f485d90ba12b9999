#include "core/sampling.hpp"

namespace nacre {

double radicalInverse(std::uint64_t i, unsigned base) {
    const double scale = 1.0 / base;
    double digitWeight = scale, value = 0;
    for (; i > 0; i /= base, digitWeight *= scale) value += static_cast<double>(i % base) * digitWeight;
    return value;
}

Vec2 concentricDisk(const Vec2& square) {
    const double a = 2 * square.x - 1, b = 2 * square.y - 1;
    if (a == 0 && b == 0) return {0, 0};
    const bool wide = std::abs(a) > std::abs(b);
    const double r = wide ? a : b;
    const double phi = wide ? kPi / 4 * b / a : kPi / 2 - kPi / 4 * a / b;
    return {r * std::cos(phi), r * std::sin(phi)};
}

Vec3 cosineHemisphere(const Vec2& square) {
    const Vec2 d = concentricDisk(square);
    return {d.x, d.y, std::sqrt(std::max(0.0, 1 - d.x * d.x - d.y * d.y))};
}

}  // namespace nacre
