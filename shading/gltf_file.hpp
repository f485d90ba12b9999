// The JSON half of a glTF 2.0 file, and the geometry half as assimp can read it without loss.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

namespace nacre {

/// A .gltf, or a .glb taken apart.
struct GltfFile {
    std::filesystem::path path;
    nlohmann::json document;
    bool isBinary = false;
    std::vector<std::uint8_t> chunks;  ///< of a .glb: what follows the JSON
};

/// \throws nacre::Error naming the file: unreadable, no glTF 2 container, wrong JSON, a required extension that isn't
///         read
GltfFile readGltf(const std::filesystem::path& path);
/// readGltf of a file's bytes. \param path  what messages name
GltfFile parseGltf(std::span<const std::uint8_t> bytes, const std::filesystem::path& path);

/// The file with its meshes each in a node of its own, "m0", "m1", …, and its nodes bare and side by side, "n0", "n1",
/// …, for the key frames; materials are names alone, "m0", "m1", …, because assimp counts them as they come. No
/// hierarchy, textures, skins or lights. \return bytes of the same container
std::vector<std::uint8_t> geometryOf(const GltfFile& file);

/// The whole file with its nodes named "n0", "n1", … by their place, because assimp 5.2 finds nodes by name and files
/// may use a name twice. \return bytes of the same container
std::vector<std::uint8_t> withNumberedNodes(const GltfFile& file);

}  // namespace nacre
