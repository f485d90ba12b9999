// Whole files in and out: bounded reads, writes that are complete or absent, and the hash that names a source.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace nacre {

/// \param limit  largest size accepted [bytes]
/// \throws nacre::Error naming the path when it can't be read, is no regular file, or is larger than `limit`
std::vector<std::uint8_t> readFile(const std::filesystem::path& path, std::uint64_t limit);

/// Calls write(temporary path in the same folder), flushes that file to disk, then renames it to `path`.
/// On any failure the temporary file is removed. \throws nacre::Error naming `path`
void writeThenRename(const std::filesystem::path& path, const std::function<void(const std::filesystem::path&)>& write);

/// writeThenRename of `bytes`.
void writeFile(const std::filesystem::path& path, std::string_view bytes);

/// FNV-1a, 64 bits, as 16 hexadecimal digits. Names a source; no protection against intent.
std::string contentHash(std::string_view bytes);

/// contentHash of a file of any size. \throws nacre::Error naming the path when it can't be read or is no regular file
std::string fileHash(const std::filesystem::path& path);

}  // namespace nacre
