// What verbs that bake share: whether the output can be written, before the work; files that go away; time spent.
#pragma once

#include <chrono>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

namespace nacre::cli {

/// A name in the folder of `output` that no other process uses.
std::filesystem::path provisionalName(const std::string& output);

/// Fails before the bake when nothing can be written there.
/// \param ending  that the name must have; empty: any
/// \throws std::invalid_argument when output is empty or one of the sources, UsageError when its name ends otherwise;
///         nacre::Error when it can't be written
void requireWritable(const std::vector<std::filesystem::path>& sources, const std::string& output,
                     const std::filesystem::path& provisional, const std::string& ending = ".exr");

class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
    /// Of all threads of the process.
    double cpuSeconds() const { return static_cast<double>(std::clock() - cpuStart_) / CLOCKS_PER_SEC; }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::clock_t cpuStart_ = std::clock();
};

}  // namespace nacre::cli
