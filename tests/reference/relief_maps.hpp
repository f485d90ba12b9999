// Reliefs for tests, and random numbers that are the same everywhere.
#pragma once

#include <functional>
#include <limits>
#include <random>

#include "bump/height_map.hpp"

namespace nacre {

inline constexpr double kExact = 1e-12;
inline constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

inline HeightMap makeMap(int width, int height, Wrap wrap, const std::function<double(int, int)>& f) {
    HeightMap map{Image(width, height, 1), wrap};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) map.heights.at(x, y, 0) = static_cast<float>(f(x, y));
    return map;
}

inline Vec2 centre(int x, int y) { return {x + 0.5, y + 0.5}; }
inline Vec3 onSurface(const HeightMap& map, const Vec2& p) { return {p.x, p.y, heightAt(map, p)}; }

class Random {
public:
    explicit Random(std::uint64_t seed) : bits_(seed) {}
    double operator()(double low = 0, double high = 1) {
        return low + (high - low) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
    }
    Vec3 direction() {
        const double z = (*this)(-1, 1), phi = (*this)(0, 2 * kPi), r = std::sqrt(1 - z * z);
        return {r * std::cos(phi), r * std::sin(phi), z};
    }

private:
    std::mt19937_64 bits_;
};

inline HeightMap roughMap(int width, int height, Wrap wrap, double scale, std::uint64_t seed = 1) {
    Random random(seed);
    return makeMap(width, height, wrap, [&](int, int) { return scale * random(); });
}

}  // namespace nacre
