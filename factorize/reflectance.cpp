#include "factorize/reflectance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

#include "core/error.hpp"
#include "factorize/measured/merl.hpp"
#include "factorize/measured/rgl.hpp"
#include "factorize/measured/samples.hpp"
#include "factorize/micro/micro.hpp"
#include "factorize/models/models.hpp"

namespace nacre {

namespace fs = std::filesystem;

namespace {
struct FileKind {
    const char* suffix;
    const char* firstBytes;  // how a file without the suffix is known; null: not at all
    Reflectance (*open)(const fs::path&);
};
}  // namespace

static constexpr std::array kFileKinds = {
    FileKind{".binary", "\x5a\0\0\0\x5a\0\0\0\xb4\0\0\0", openMerl},  // int32 90, 90, 180
    FileKind{".bsdf", "tensor_file\0", openRgl},
    FileKind{".csv", nullptr, openSamples},
};
static constexpr std::size_t kFirstBytes = 12;

static const FileKind* kindBySuffix(const fs::path& path) {
    const std::string suffix = path.extension().string();
    const auto found = std::find_if(kFileKinds.begin(), kFileKinds.end(), [&](auto& k) { return suffix == k.suffix; });
    return found == kFileKinds.end() ? nullptr : &*found;
}

static const FileKind* kindByContent(const fs::path& path) {
    std::string start(kFirstBytes, '\0');
    std::ifstream(path, std::ios::binary).read(start.data(), kFirstBytes);
    const auto found = std::find_if(kFileKinds.begin(), kFileKinds.end(), [&](auto& k) {
        return k.firstBytes && start == std::string(k.firstBytes, kFirstBytes);
    });
    return found == kFileKinds.end() ? nullptr : &*found;
}

/// A slash after a colon belongs to a colour (`ward:specular=0.9/0.6/0.2`), not to a path.
static bool looksLikePath(const std::string& source) {
    return source.substr(0, source.find(':')).find('/') != std::string::npos;
}

static Reflectance openFile(const std::string& source) {
    if (!fs::is_regular_file(source))
        throw Error(
            fmt::format("{}: expected a file, found {}", source, fs::exists(source) ? "a folder or device" : "none"));
    if (const FileKind* kind = kindBySuffix(source)) return kind->open(source);
    if (const FileKind* kind = kindByContent(source)) return kind->open(source);
    throw Error(
        fmt::format("{}: expected a reflectance file (MERL .binary, RGL .bsdf, samples .csv), found neither that "
                    "suffix nor its content",
                    source));
}

/// `micro` and `ridges` lack a part of `micro:ridges`.
static void requireNoBareRelief(const std::string& source) {
    const std::string name = source.substr(0, source.find_first_of(":,"));
    std::string known;
    bool isPart = kMicroPrefix == name + ":";
    for (const ModelInfo& relief : listMicro()) {
        known += (known.empty() ? "" : ", ") + relief.name;
        isPart = isPart || relief.name == kMicroPrefix + name;
    }
    require(!isPart, fmt::format("unknown model '{}'; micro-geometries: {}", name, known));
}

Reflectance openReflectance(const std::string& source) {
    if (source.rfind(kMicroPrefix, 0) == 0) return openMicro(source);
    std::error_code unreadable;
    const bool isFile = kindBySuffix(source) || looksLikePath(source) || fs::is_regular_file(source, unreadable);
    if (isFile) return openFile(source);
    requireNoBareRelief(source);
    return makeModel(source);
}

}  // namespace nacre
