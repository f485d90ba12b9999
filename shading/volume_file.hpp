// Volumes from files: VolPack's .den (8 bits) and INRIA's .inr (INRIMAGE-4: 8-bit, 16-bit, float, double).
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "core/volume.hpp"

namespace nacre {

/// Values in the file's own units: 0 … 255 of a .den. A .den names no spacing: 1. Recognised by content.
/// \throws nacre::Error naming the path, expected and found: unreadable, another format, a header that makes no sense,
///         more than 1024 texels along an edge, data cut or left over, values that aren't finite
Volume readVolume(const std::filesystem::path& path);

/// The same of bytes at hand. \param name  for messages
Volume parseVolume(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace nacre
