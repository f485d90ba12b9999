// Quake 2's key frames: meshes with names like "run01".
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace nacre {

/// Frames one after the other whose names differ in their last one or two digits alone (zeros before them are no
/// part of the name).
struct Md2Clip {
    std::string name;
    std::size_t first = 0, count = 0;
};

inline constexpr double kMd2Rate = 10;  ///< the game's own clock [frames/s]: the file names none

/// Whether the bytes begin as an MD2 file does.
bool isMd2(std::span<const std::uint8_t> bytes);

/// \throws nacre::Error naming the file: cut, no frame
std::vector<Md2Clip> md2Clips(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace nacre
