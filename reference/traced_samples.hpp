// Random numbers of a pixel's rays, and directions drawn with them.
#pragma once

#include <cstdint>
#include <utility>

#include "core/math.hpp"
#include "envmaps/lobes.hpp"

namespace nacre {

/// Numbers of one ray and purpose (SplitMix64).
class PixelRandom {
public:
    PixelRandom(std::uint64_t seed, std::uint64_t ray, std::uint64_t purpose)
        : state_(mixed(mixed(seed + 0x9e3779b97f4a7c15u * (ray + 1)) + purpose)) {}
    double operator()() {
        state_ += 0x9e3779b97f4a7c15u;
        return static_cast<double>(mixed(state_) >> 11) * 0x1p-53;
    }
    Vec2 pair() {
        const double u = (*this)();
        return {u, (*this)()};
    }

private:
    static std::uint64_t mixed(std::uint64_t z) {
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    std::uint64_t state_;
};

/// Point i of a plane sequence that fills a pixel evenly: Roberts' R2, shifted by the pixel's own numbers. Errors of a
/// pixel's mean fall nearly as fast as its points grow, where independent ones would take their square.
class PixelSequence {
public:
    PixelSequence(std::uint64_t seed, std::uint64_t pixel, std::uint64_t purpose, std::uint64_t first)
        : shift_(PixelRandom(seed, pixel, purpose).pair()), next_(first) {}
    Vec2 operator()() {
        const double i = static_cast<double>(next_++);
        const Vec2 p(shift_.x + 0.7548776662466927 * i, shift_.y + 0.5698402909980532 * i);
        return p - glm::floor(p);
    }

private:
    Vec2 shift_;
    std::uint64_t next_;
};

/// d of a frame whose z is n. Both unit.
Vec3 turnedTo(const Vec3& n, const Vec3& d);

/// A direction of the lobe about r and its weight; the density is the lobe but for that. \param u  of the unit square
std::pair<Vec3, double> lobeSample(const Lobe& lobe, const Vec3& r, const Vec2& u);

}  // namespace nacre
