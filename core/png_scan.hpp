// What has to be known of a PNG file before OpenImageIO reads it: libpng writes lines of its own about a cut file.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace nacre {

/// Walks the chunks of a PNG file: each must end within the file, and the last one is IEND. Other bytes pass.
/// \throws nacre::Error naming the file when it is cut
void scanPng(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace nacre
