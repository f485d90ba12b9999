#include "factorize/micro/direction_table.hpp"

#include <array>

#include "core/directions.hpp"
#include "core/sampling.hpp"

namespace nacre {

Vec2 directionToSquare(const Vec3& direction) {
    const double sine = std::hypot(direction.x, direction.y);
    if (sine == 0) return {0.5, 0.5};
    const double radius = std::min(1.0, std::atan2(sine, direction.z) / kMaxTableTheta);
    const bool wide = std::abs(direction.x) > std::abs(direction.y);
    const double major = wide ? direction.x : direction.y, minor = wide ? direction.y : direction.x;
    const double along = std::copysign(radius, major), across = along * (4 / kPi) * std::atan(minor / major);
    return 0.5 + 0.5 * (wide ? Vec2(along, across) : Vec2(across, along));
}

Vec3 squareToDirection(const Vec2& square) {
    const Vec2 disk = concentricDisk(square);
    return sphericalDirection(glm::length(disk) * kMaxTableTheta, std::atan2(disk.y, disk.x));
}

Vec3 nodeDirection(int resolution, std::size_t node) {
    const auto n = static_cast<std::size_t>(resolution);
    return squareToDirection(Vec2(node % n, node / n) / static_cast<double>(resolution - 1));
}

namespace {
struct Corner {
    std::size_t node;
    float weight;
};
}  // namespace

static std::array<Corner, 4> cornersOf(int resolution, const Vec3& direction) {
    const Vec2 at = directionToSquare(direction) * static_cast<double>(resolution - 1);
    const int x = std::min(static_cast<int>(at.x), resolution - 2),
              y = std::min(static_cast<int>(at.y), resolution - 2);
    const auto u = static_cast<float>(at.x - x), v = static_cast<float>(at.y - y);
    const auto n = static_cast<std::size_t>(resolution),
               first = static_cast<std::size_t>(y) * n + static_cast<std::size_t>(x);
    return {
        Corner{first, (1 - u) * (1 - v)}, {first + 1, u * (1 - v)}, {first + n, (1 - u) * v}, {first + n + 1, u * v}};
}

Rgb evaluate(const DirectionTable& table, const Vec3& wi, const Vec3& wo) {
    if (!(wi.z > 0 && wo.z > 0)) return Rgb(0);
    const auto toWi = cornersOf(table.resolution, wi), toWo = cornersOf(table.resolution, wo);
    const std::size_t nodes = static_cast<std::size_t>(table.resolution) * static_cast<std::size_t>(table.resolution);
    Rgb sum(0);
    for (const Corner& i : toWi)
        for (const Corner& o : toWo)
            sum += Rgb(table.values[i.node * nodes + o.node]) * (static_cast<double>(i.weight) * o.weight);
    return sum;
}

}  // namespace nacre
