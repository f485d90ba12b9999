// Volumes for tests, and their files.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/volume.hpp"

namespace nacre::test {

/// Values of a function of the texture coordinates of the texels' centres.
inline Volume volumeOf(const glm::ivec3& size, const std::function<double(const Vec3&)>& value) {
    Volume out;
    out.size = size;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                out.values.push_back(static_cast<float>(value((Vec3(x, y, z) + 0.5) / Vec3(size))));
    return out;
}

/// An egg with a dent, off the middle: no symmetry hides a swapped axis. Positive inside.
inline Volume egg(const glm::ivec3& size) {
    Volume out = volumeOf(size, [](const Vec3& p) {
        const double ball = 0.36 - glm::length((p - Vec3(0.45, 0.52, 0.5)) * Vec3(1, 0.9, 1.1));
        const double dent = glm::length(p - Vec3(0.75, 0.75, 0.8)) - 0.25;
        return 40 * std::min(ball, dent);
    });
    out.spacing = {1, 1.2, 0.8};
    return out;
}

using Bytes = std::vector<std::uint8_t>;

inline void put(Bytes& out, std::uint32_t value, int width) {
    for (int i = 0; i < width; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

/// A .den file whose values count up from 0.
inline Bytes den(int x, int y, int z) {
    Bytes out;
    put(out, 1, 2);
    for (int map = 0; map < 3; ++map) {
        for (int c = 0; c < 3; ++c) put(out, 0, 2);
        for (const int n : {x, y, z}) put(out, static_cast<std::uint32_t>(n - 1), 2);
        for (const int n : {x, y, z}) put(out, static_cast<std::uint32_t>(n), 2);
    }
    put(out, 3, 2);
    put(out, static_cast<std::uint32_t>(x * y * z), 4);
    for (int i = 0; i < x * y * z; ++i) out.push_back(static_cast<std::uint8_t>(i));
    return out;
}

inline std::string text(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

}  // namespace nacre::test
