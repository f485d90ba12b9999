#include "bump/height_map.hpp"

#include <fmt/format.h>

#include <limits>

#include "core/error.hpp"

namespace nacre {

std::string toString(Wrap wrap) {
    switch (wrap) {
        case Wrap::Repeat:
            return "repeat";
        case Wrap::Clamp:
            return "clamp";
        case Wrap::Mirror:
            return "mirror";
    }
    return "?";
}

Wrap wrapFromString(const std::string& name) {
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror})
        if (name == toString(wrap)) return wrap;
    throw std::invalid_argument(fmt::format("unknown wrap '{}'; known: repeat, clamp, mirror", name));
}

int wrapIndex(int i, int n, Wrap wrap) {
    if (wrap == Wrap::Clamp) return std::min(std::max(i, 0), n - 1);
    const int period = wrap == Wrap::Mirror ? 2 * n : n;
    const int k = ((i % period) + period) % period;
    return k < n ? k : period - 1 - k;
}

void validateHeightMap(const HeightMap& map) {
    require(!map.heights.empty() && map.heights.channels() == 1, "height map: expected one channel of heights");
    for (int y = 0; y < map.height(); ++y)
        for (int x = 0; x < map.width(); ++x)
            if (std::isinf(map.heights.at(x, y, 0)))
                throw std::invalid_argument(
                    fmt::format("height map: expected finite heights or NaN, found infinity at ({}, {})", x, y));
}

double reachOf(const HeightMap& map) { return 16.0 * std::max(map.width(), map.height()) + 1024; }

double heightAt(const HeightMap& map, const Vec2& p) {
    const double x = std::floor(p.x - 0.5), y = std::floor(p.y - 0.5);
    const double s = p.x - 0.5 - x, t = p.y - 0.5 - y;
    const int i = static_cast<int>(x), j = static_cast<int>(y);
    const auto row = [&](int k) {  // a corner of weight 0 is no corner: a texel's own centre has a height beside holes
        if (s == 0) return static_cast<double>(map.at(i, k));
        return (1 - s) * map.at(i, k) + s * map.at(i + 1, k);
    };
    return t == 0 ? row(j) : (1 - t) * row(j) + t * row(j + 1);
}

HeightRange heightRange(const HeightMap& map) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    float low = kInfinity, high = -kInfinity;
    for (const float z : map.heights.data()) {  // comparisons with NaN are false
        low = z < low ? z : low;
        high = z > high ? z : high;
    }
    if (low > high) return {};
    return {low, high};
}

}  // namespace nacre
