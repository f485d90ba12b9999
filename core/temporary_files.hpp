// Files that must not outlive the process: registered while they exist, removed by its signals too.
#pragma once

#include <filesystem>

namespace nacre {

/// Registers `path` for removal by a signal, and removes it at the end of the scope; a file renamed by then is left.
class TemporaryFile {
public:
    explicit TemporaryFile(const std::filesystem::path& path);
    ~TemporaryFile();
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

private:
    std::filesystem::path path_;
    int slot_;  ///< −1: no room, or a name too long, to be removed by a signal
};

/// SIGINT, SIGTERM and SIGHUP, where they aren't ignored, first remove the registered files and then end the process as
/// they always do. For programs, not libraries: an application has handlers of its own.
void removeTemporaryFilesOnSignals();

}  // namespace nacre
