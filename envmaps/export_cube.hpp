// What the exporters for engines share: faces in OpenGL's orientation as RGBA half floats. Not part of the interface.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/environment.hpp"

namespace nacre {

struct CubeExport {
    double scale = 1;  ///< the file holds radiance / scale, and says so where the format has room for words
};

namespace exporting {

/// Cubes, finest first, each half as large as the one before (rounded down), scale finite and > 0.
/// \throws std::invalid_argument when they are not
void requireChain(std::span<const EnvMap> levels, double scale);

/// Appends one face, row 0 on top, R G B A of 16 bits little-endian, A = 1, turned by glFace.
/// \throws StorageError when a value / scale is not finite or above 65504: never an infinity in the file
void appendFace(const EnvMap& level, int face, double scale, std::string& bytes);

template <typename Integer>
void appendNumber(std::string& bytes, Integer value) {
    for (std::size_t i = 0; i < sizeof value; ++i)
        bytes.push_back(static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xff));
}

}  // namespace exporting
}  // namespace nacre
