// The baked-asset file: one multi-part OpenEXR file, one part a texture, and a string attribute
// `nacre` with JSON in the first part.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/texture.hpp"

namespace nacre {

inline constexpr int kAssetVersion = 1;

/// Textures and what is known of them. meta holds at least `kind`; writeAsset adds format version, texture table and
/// bytes.
struct Asset {
    std::string kind;  ///< brdf, …
    std::vector<AssetTexture> textures;
    nlohmann::json meta = nlohmann::json::object();

    std::size_t bytes() const;
    /// \throws nacre::Error naming the asset's kind when there is none of that name
    const AssetTexture& texture(const std::string& name) const;
};

/// Writes to a temporary name in the same folder, flushes, and renames: a reader never sees half a file.
/// \throws nacre::Error naming the path; the temporary file is removed
void writeAsset(const Asset& asset, const std::filesystem::path& path);

/// Checks that it is an EXR file with a `nacre` attribute, the version, part names, sizes, formats and finite values.
/// \throws nacre::Error naming file, part, expected and found
Asset readAsset(const std::filesystem::path& path);

/// readAsset of a file's bytes. \param name  what messages call the file
Asset parseAsset(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace nacre
