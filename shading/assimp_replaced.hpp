// Lets assimp read changed bytes of a file. Not for applications: it names assimp's types.
#pragma once

#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>

#include <cstdint>
#include <string>
#include <vector>

namespace nacre {

/// Other bytes in the place of one file; what they refer to is read from the disk. `bytes` must outlive it.
class AssimpReplaced : public Assimp::DefaultIOSystem {
public:
    AssimpReplaced(std::string path, const std::vector<std::uint8_t>& bytes) : path_(std::move(path)), bytes_(bytes) {}
    Assimp::IOStream* Open(const char* file, const char* mode) override {
        if (path_ == file) return new Assimp::MemoryIOStream(bytes_.data(), bytes_.size());
        return DefaultIOSystem::Open(file, mode);
    }

private:
    std::string path_;
    const std::vector<std::uint8_t>& bytes_;
};

}  // namespace nacre
