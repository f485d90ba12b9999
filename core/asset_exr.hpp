// What the writer and the reader of asset files agree on (asset_write.cpp, asset_read.cpp). Not part of the interface.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace nacre::exr {

inline constexpr const char* kAttribute = "nacre";  ///< the string attribute of part 0
inline constexpr int kMaxEdge = 16384;              ///< largest texture edge [texels]
inline constexpr std::size_t kMaxParts = 160;
inline constexpr std::size_t kMaxValues = std::size_t{1} << 27;  ///< texels × channels of all parts together
inline constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 30;

/// Channel names of an image with 1 to 4 channels, in the order of its channels.
inline std::vector<std::string> channelNames(int channels) {
    if (channels == 1) return {"Y"};
    const std::vector<std::string> all = {"R", "G", "B", "A"};
    return {all.begin(), all.begin() + channels};
}

/// What is wrong with the file's start, in words that follow "found"; nothing when it is an EXR file whose headers end
/// within it. asset_scan.cpp
std::optional<std::string> brokenStart(std::span<const std::uint8_t> bytes);

}  // namespace nacre::exr
