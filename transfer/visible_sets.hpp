// Potentially visible sets of a known animation (HEMI section 3.2): which triangles ever block for each group
// of vertices, by their places in SilhouetteMesh.
//
// The file, little-endian: "NACRE_PV", four uint32 (version, groups, places, windows), uint64 key, uint64 check (FNV-1a
// of what follows); for each window two int32 (first frame, end), then for each window and group ⌈places/64⌉ uint64 of
// bits.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "transfer/self_transfer.hpp"

namespace nacre {

struct VisibleSets {
    struct Window {
        int first = 0, end = 0;           ///< frames first … end − 1
        std::vector<std::uint64_t> bits;  ///< [group][⌈places/64⌉]
    };
    std::uint64_t key = 0;  ///< SelfTransfer::key of the one that they are of
    std::uint32_t groups = 0, places = 0;
    std::vector<Window> windows;

    /// Of the window that holds the frame; empty when none does.
    std::span<const std::uint64_t> at(int frame) const;
};

struct NumberedFrame {
    int number = 0;
    std::vector<glm::vec3> positions;  ///< of the welded vertices, finite
};

/// Exact for these frames: with the sets SelfTransfer gives the same masks. \param frames  ascending
/// \param windowFrames  numbers of frames that share a set; 0 = all
VisibleSets findVisibleSets(const SelfTransfer& transfer, std::span<const NumberedFrame> frames, int windowFrames);

/// Writes to a temporary name in the same folder, flushes, and renames. \throws nacre::Error naming the path
void writeVisibleSets(const VisibleSets& sets, const std::filesystem::path& path);

/// \throws nacre::Error naming file, expected and found
VisibleSets readVisibleSets(const std::filesystem::path& path);
VisibleSets parseVisibleSets(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace nacre
