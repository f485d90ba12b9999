#include "demos/orientation_chart.hpp"

#include <array>

#include "core/parallel.hpp"
#include "envmaps/convert.hpp"

namespace nacre {
namespace {

/// 5 × 7 dots, a bit a dot, left is the highest bit.
using Glyph = std::array<unsigned char, 7>;
constexpr Glyph kPlus{0, 4, 4, 31, 4, 4, 0}, kMinus{0, 0, 0, 31, 0, 0, 0};
constexpr std::array<Glyph, 3> kLetters{{{17, 17, 10, 4, 10, 17, 17},  // X
                                         {17, 17, 10, 4, 4, 4, 4},     // Y
                                         {31, 1, 2, 4, 8, 16, 31}}};   // Z

bool dot(const Glyph& glyph, double x, double y) {
    if (x < 0 || y < 0 || x >= 5 || y >= 7) return false;
    return (glyph[static_cast<std::size_t>(y)] >> (4 - static_cast<int>(x)) & 1) != 0;
}

const std::array<Rgb, 6> kColors{
    {{0.85, 0.08, 0.06}, {0.05, 0.65, 0.75}, {0.1, 0.6, 0.1}, {0.65, 0.1, 0.6}, {0.08, 0.15, 0.85}, {0.85, 0.7, 0.05}}};

/// a to the right and b down, both in [−1, 1], as one sees the face from inside.
Rgb faceColor(int face, double a, double b) {
    constexpr double kDot = 0.13;  // edge of a letter's dot
    const double row = (b + 0.45) / kDot;
    const bool name = dot(face % 2 == 0 ? kPlus : kMinus, (a + 0.75) / kDot, row) ||
                      dot(kLetters[static_cast<std::size_t>(face / 2)], (a - 0.05) / kDot, row);
    const bool arrow = face / 2 != 1 && b > -0.9 && b < -0.62 && std::abs(a) < (b + 0.9) * 0.7;
    if (name || arrow) return Rgb(1);
    const Rgb color = kColors[static_cast<std::size_t>(face)];
    if (std::max(std::abs(a), std::abs(b)) > 0.95) return 0.15 * color;
    const auto nearLine = [](double c) { return std::abs(c / 0.5 - std::round(c / 0.5)) < 0.03; };
    return nearLine(a) || nearLine(b) ? 0.5 * color : color;
}

}  // namespace

Rgb orientationChart(const Vec3& d) {
    const glm::dvec2 p = envPosition(EnvLayout::Cube, 1, d);
    const int face = std::min(5, static_cast<int>(p.y));
    return faceColor(face, 2 * p.x - 1, 2 * (p.y - face) - 1);
}

EnvMap orientationChartMap(EnvLayout layout, int size) {
    constexpr int kPoints = 4;
    EnvMap cube(EnvLayout::Cube, 256);
    parallelFor(static_cast<std::size_t>(cube.image.height()), 0, [&](std::size_t row) {
        for (int x = 0; x < cube.image.width(); ++x) {
            const int y = static_cast<int>(row);
            Rgb sum(0);
            for (int k = 0; k < kPoints * kPoints; ++k)
                sum += orientationChart(envDirection(cube.layout, cube.size(), x + (k % kPoints + 0.5) / kPoints,
                                                     y + (k / kPoints + 0.5) / kPoints));
            cube.image.setRgb(x, y, sum / static_cast<double>(kPoints * kPoints));
        }
    });
    return convertEnv(cube, layout, size);
}

}  // namespace nacre
