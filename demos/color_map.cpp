#include "demos/color_map.hpp"

#include <fmt/format.h>

#include <array>

#include "core/error.hpp"

namespace nacre {
namespace {

/// Equally spaced; luminance of the stops rises roughly evenly after encoding.
constexpr std::array<Vec3, 6> kStops = {{{0.02, 0.02, 0.04},
                                         {0.23, 0.10, 0.44},
                                         {0.62, 0.16, 0.43},
                                         {0.92, 0.38, 0.22},
                                         {0.98, 0.74, 0.27},
                                         {1.00, 1.00, 0.90}}};

}  // namespace

Vec3 falseColorSrgb(double share) {
    const double at = clamp01(share) * (kStops.size() - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
    return mix(kStops[i], kStops[i + 1], at - static_cast<double>(i));
}

std::string falseColorGradient() {
    std::string css = "linear-gradient(to right";
    for (const Vec3& c : kStops) css += fmt::format(", rgb({:.0f} {:.0f} {:.0f})", 255 * c.r, 255 * c.g, 255 * c.b);
    return css + ")";
}

double roundUpScale(double value) {
    require(std::isfinite(value) && value > 0, "roundUpScale: value must be finite, > 0");
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= value * (1 - 1e-9)) return factor * power;  // rounding must not skip a step
    return 10 * power;
}

}  // namespace nacre
