// What the tests of measured reflectance share: temporary files, the data folder, direction pairs.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/directions.hpp"
#include "core/sampling.hpp"

namespace nacre::test {

/// A folder that goes away with the object.
class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "nacre-test-XXXXXX").string();
        path_ = ::mkdtemp(pattern.data());
    }
    ~TemporaryFolder() { std::filesystem::remove_all(path_); }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::filesystem::path write(const std::string& name, const void* bytes, std::size_t size) const {
        std::ofstream(path_ / name, std::ios::binary)
            .write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
        return path_ / name;
    }
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        return write(name, text.data(), text.size());
    }

private:
    std::filesystem::path path_;
};

/// A file of the shared data folder (../shared beside the repository, or NACRE_SHARED); empty when it isn't there.
inline std::filesystem::path sharedFile(const std::string& name) {
    const char* shared = std::getenv("NACRE_SHARED");
    const std::filesystem::path folder = shared ? std::filesystem::path(shared) : NACRE_SOURCE_DIR "/../shared";
    const std::filesystem::path path = folder / "data" / name;
    return std::filesystem::exists(path) ? path : std::filesystem::path();
}

/// Pairs spread over half/difference angles, both at most maxTheta from the normal [rad].
inline std::vector<DirectionPair> samplePairs(std::size_t count, double maxTheta) {
    std::vector<DirectionPair> out;
    for (std::uint64_t i = 1; out.size() < count; ++i) {
        const Vec3 u = halton3(i);
        const DirectionPair pair =
            fromHalfDifference({kPi / 2 * u.x * u.x, 2 * kPi * radicalInverse(i, 7), kPi / 2 * u.y, 2 * kPi * u.z});
        if (std::min(pair.wi.z, pair.wo.z) > std::cos(maxTheta)) out.push_back(pair);
    }
    return out;
}

/// The message of the T that `action` throws; empty when it throws none.
template <class T, class Action>
std::string messageOf(const Action& action) {
    try {
        action();
    } catch (const T& error) {
        return error.what();
    }
    return {};
}

}  // namespace nacre::test
