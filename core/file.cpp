#include "core/file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/error.hpp"
#include "core/temporary_files.hpp"

namespace nacre {

namespace fs = std::filesystem;

static void requireRegularFile(const fs::path& path) {
    std::error_code failure;
    const fs::file_status status = fs::status(path, failure);
    if (!fs::exists(status)) throw Error(fmt::format("{}: expected a file, found none", path.string()));
    if (!fs::is_regular_file(status))
        throw Error(fmt::format("{}: expected a file, found a folder or device", path.string()));
}

std::vector<std::uint8_t> readFile(const fs::path& path, std::uint64_t limit) {
    requireRegularFile(path);
    std::error_code failure;
    const std::uint64_t size = fs::file_size(path, failure);
    if (failure) throw Error(fmt::format("{}: can't read: {}", path.string(), failure.message()));
    if (size > limit) throw Error(fmt::format("{}: expected at most {} bytes, found {}", path.string(), limit, size));
    std::ifstream in(path, std::ios::binary);
    std::vector<std::uint8_t> bytes(size);
    if (!in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size)))
        throw Error(fmt::format("{}: can't read: {}", path.string(), std::strerror(errno)));
    return bytes;
}

static void flushToDisk(const fs::path& path) {
    const int descriptor = ::open(path.c_str(), O_RDWR);
    if (descriptor < 0) throw Error(std::strerror(errno));
    const int failed = ::fsync(descriptor);
    const int code = errno;
    ::close(descriptor);
    if (failed) throw Error(std::strerror(code));
}

void writeThenRename(const fs::path& path, const std::function<void(const fs::path&)>& write) {
    std::error_code failure;
    // A rename would replace a device such as /dev/full by a file, and hide that nothing can be stored there.
    if (fs::exists(path, failure) && !fs::is_regular_file(path, failure))
        throw Error(
            fmt::format("{}: can't write: expected a file or a free name, found a folder or device", path.string()));
    const fs::path temporary = path.string() + fmt::format(".{}.tmp", ::getpid());
    const TemporaryFile removeLater(temporary);  // gone by its name after the rename
    try {
        write(temporary);
        flushToDisk(temporary);
        fs::rename(temporary, path);
    } catch (const std::exception& error) {
        throw Error(fmt::format("{}: can't write: {}", path.string(), error.what()));
    }
}

void writeFile(const fs::path& path, std::string_view bytes) {
    writeThenRename(path, [&](const fs::path& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        out.close();
        if (!out) throw Error(std::strerror(errno));
    });
}

static constexpr std::uint64_t kHashStart = 0xcbf29ce484222325ull;

static std::uint64_t hashOn(std::uint64_t hash, std::string_view bytes) {
    for (const char byte : bytes) hash = (hash ^ static_cast<std::uint8_t>(byte)) * 0x100000001b3ull;
    return hash;
}

std::string contentHash(std::string_view bytes) { return fmt::format("{:016x}", hashOn(kHashStart, bytes)); }

std::string fileHash(const fs::path& path) {
    requireRegularFile(path);
    std::ifstream in(path, std::ios::binary);
    std::vector<char> block(1 << 20);
    std::uint64_t hash = kHashStart;
    while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0)
        hash = hashOn(hash, {block.data(), static_cast<std::size_t>(in.gcount())});
    if (!in.eof()) throw Error(fmt::format("{}: can't read: {}", path.string(), std::strerror(errno)));
    return fmt::format("{:016x}", hash);
}

}  // namespace nacre
