// Which files changed since the last look. Times and sizes are polled: that works on every file system.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace nacre {

class FileWatch {
public:
    /// Watches exactly these from now on; those that were watched before keep what was known of them.
    void watch(const std::vector<std::filesystem::path>& files);
    /// Those whose time or size isn't what it was, or that came or went, each told once, in order of their names.
    std::vector<std::filesystem::path> changed();

private:
    std::map<std::filesystem::path, std::string> stamps_;
};

/// Every regular file under `folder`, sorted; empty when there is no such folder.
std::vector<std::filesystem::path> filesUnder(const std::filesystem::path& folder);

/// `file`, and every file that the texts in it name if it is JSON (scene.json, .gltf), and so on; sorted. Broken files
/// name nothing.
std::vector<std::filesystem::path> filesNamedIn(const std::filesystem::path& file);

}  // namespace nacre
