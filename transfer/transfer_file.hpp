// Transfer vectors of a moving mesh in one file, with the mesh, so that it can be lit again from the file alone.
//
// Numbers are little endian, floats are IEEE binary32, nothing is aligned but by chance:
//   bytes    what
//   8        "NACRE_TV"
//   4        version, uint32: 1
//   4        H, uint32
//   H        header: JSON in UTF-8
//   4 S      uint32: the vertex that each vertex of the animation has become (those that stay together are one)
//   12 T     3 uint32 a triangle: its vertices, counter-clockwise seen from outside
//   then for each of the B blocks
//   12 V     3 float a vertex: its position
//   4 V C    C = (order + 1)² float a vertex: its transfer vector, index l² + l + m (transfer/self_transfer.hpp)
// The header's keys that the numbers need: source_vertices S, triangles T, vertices V, blocks B, order, and
// frames_per_second; "frames", the animation's numbers of the frames that are there, ascending; "block_of_frame", as
// long: frames in which nothing moves share a block. "glossy", when the coefficients are one viewer's: exponent,
// specular, eye as RecordedGloss. What else is there says how it was made (command line, options,
// measured error).
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "core/math.hpp"
#include "transfer/surface.hpp"

namespace nacre {

inline constexpr int kTransferFileVersion = 1;

/// V = (1 − specular) V of f = 1/π + specular V of Phong's lobe (transfer/mask_shading.hpp), seen from `eye`.
struct RecordedGloss {
    double exponent = 0, specular = 1;
    Vec3 eye{0};
    bool operator==(const RecordedGloss&) const = default;
};

struct TransferRecording {
    struct Block {
        std::vector<glm::vec3> positions;  ///< [vertex]
        std::vector<float> coefficients;   ///< [vertex][(order + 1)²]
    };
    struct Frame {
        int number = 0, block = 0;
    };
    int order = 4;
    double framesPerSecond = 30;
    std::vector<std::uint32_t> weldOf;  ///< as WeldedMesh
    std::vector<glm::uvec3> triangles;
    std::vector<Block> blocks;
    std::vector<Frame> frames;
    std::optional<RecordedGloss> gloss{};            ///< none: matt, the same from everywhere
    nlohmann::json meta = nlohmann::json::object();  ///< the header; the writer adds what the numbers need

    std::size_t vertexCount() const { return blocks.empty() ? 0 : blocks.front().positions.size(); }
    std::size_t coefficientCount() const { return static_cast<std::size_t>((order + 1) * (order + 1)); }
};

/// Writes to a temporary name in the same folder, flushes, and renames. \throws nacre::Error naming the path;
/// std::invalid_argument when there is no block, sizes differ, or a number is out of range or not finite
void writeTransfer(const TransferRecording& recording, const std::filesystem::path& path);

/// Checks version, header, size, indices, that every block has a frame and every float is finite.
/// \throws nacre::Error naming file, expected and found
TransferRecording readTransfer(const std::filesystem::path& path);

/// readTransfer of a file's bytes. \param name  what messages call the file
TransferRecording parseTransfer(std::span<const std::uint8_t> bytes, const std::string& name);

/// Whether a file begins as these do; false when it can't be read.
bool isTransferFile(const std::filesystem::path& path);

}  // namespace nacre
