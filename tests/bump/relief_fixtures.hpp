// Reliefs that the tests of this room share.
#pragma once

#include <random>

#include "bump/height_map.hpp"

namespace nacre {

/// Rough everywhere, from bumps of a quarter of the map down to single texels; repeats when the wrap does.
inline HeightMap roughMap(int width, int height, float amplitude, Wrap wrap = Wrap::Repeat) {
    HeightMap map{Image(width, height, 1), wrap};
    std::mt19937 generator(11);
    const auto noise = [&] { return static_cast<float>(generator() % 2048) / 1024 - 1; };
    for (int cell = std::max(width, height) / 4; cell >= 1; cell /= 2, amplitude *= 0.55f) {
        const int across = (width + cell - 1) / cell, down = (height + cell - 1) / cell;
        std::vector<float> nodes(static_cast<std::size_t>(across) * down);
        for (float& node : nodes) node = amplitude * noise();
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const int i = x / cell, j = y / cell;
                const float step = static_cast<float>(cell);
                const float s = static_cast<float>(x % cell) / step, t = static_cast<float>(y % cell) / step;
                const auto node = [&](int a, int b) {
                    return nodes[static_cast<std::size_t>(b % down) * across + static_cast<std::size_t>(a % across)];
                };
                map.heights.at(x, y, 0) += (1 - t) * ((1 - s) * node(i, j) + s * node(i + 1, j)) +
                                           t * ((1 - s) * node(i, j + 1) + s * node(i + 1, j + 1));
            }
    }
    return map;
}

inline HeightMap flatMap(int width, int height, float z = 0) {
    HeightMap map{Image(width, height, 1), Wrap::Repeat};
    for (float& h : map.heights.data()) h = z;
    return map;
}

}  // namespace nacre
