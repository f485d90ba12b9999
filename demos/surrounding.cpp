#include "demos/surrounding.hpp"

#include <fmt/format.h>

#include "demos/stage.hpp"
#include "envmaps/source.hpp"

namespace nacre {
namespace {

/// 1 within `radiusDeg` of the axis.
bool within(const Vec3& d, const Vec3& axis, double radiusDeg) {
    return glm::dot(d, axis) > std::cos(radiusDeg * kPi / 180);
}

Rgb skyFrom(const Vec3& d) {
    const Rgb zenith(0.15, 0.32, 0.75), horizon(0.85, 0.9, 0.95), ground(0.16, 0.12, 0.08);
    const double up = std::sqrt(std::max(0.0, d.y));
    Rgb sum = d.y >= 0 ? horizon + up * (zenith - horizon) : ground * (1 + 0.5 * d.y);
    if (within(d, directionFromDeg(150, 40), 0.5)) sum += Rgb(2e4, 1.9e4, 1.7e4);
    const Vec3 lamp = directionFromDeg(-90, 15);
    if (d.x < 0 && std::abs(d.z / d.x) < 0.35 && std::abs(d.y / d.x - lamp.y / lamp.x) < 0.25) sum += Rgb(9, 8.5, 8);
    if (within(d, directionFromDeg(20, 8), 5)) sum += Rgb(14, 2, 1);
    if (within(d, directionFromDeg(-25, -10), 5)) sum += Rgb(1, 4, 14);
    return sum;
}

}  // namespace

EnvMap syntheticSky(int size) {
    EnvMap map(EnvLayout::LatLong, size);
    for (int y = 0; y < map.image.height(); ++y)
        for (int x = 0; x < map.image.width(); ++x) {
            Rgb sum(0);  // 4 × 4 points a texel: the sun has a few texels
            for (int k = 0; k < 16; ++k)
                sum += skyFrom(envDirection(map.layout, size, x + (k % 4 + 0.5) / 4, y + (k / 4 + 0.5) / 4));
            map.image.setRgb(x, y, sum / 16.0);
        }
    return map;
}

Surrounding openSurrounding(const std::string& name, const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / (name + ".exr");
    if (!std::filesystem::exists(file))
        return {syntheticSky(), "", "a made-up sky",
                fmt::format("{} is not there (demos/fetch.sh gets it): a made-up sky stands in.", file.string())};
    Environment read = readEnvironment(file.string());
    return {std::move(read.map), file.string(),
            fmt::format("{} (Blender's studio lights, CC0), {} × {}", name, read.report.width, read.report.height), ""};
}

}  // namespace nacre
