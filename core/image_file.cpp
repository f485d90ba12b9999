#include "core/image_file.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "core/asset_exr.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/oiio_reader.h"
#include "core/png_scan.hpp"
#include "core/tiff_scan.hpp"

namespace nacre {

namespace fs = std::filesystem;

double srgbToLinear(double code) {
    if (code < 0) return -srgbToLinear(-code);
    if (code > 1) return code;
    return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

namespace {

struct OiioModule {
    NacreOiioRead read = nullptr;
    NacreOiioFree free = nullptr;
};

}  // namespace

/// Where the module may be: NACRE_OIIO alone when it is set; else beside the program, in the library folder beside the
/// program's, where it was built and where it was to be installed.
static std::vector<fs::path> modulePaths() {
    static constexpr const char* kModule = "libnacre_oiio.so";
    if (const char* chosen = std::getenv("NACRE_OIIO"); chosen && *chosen) return {chosen};
    std::error_code failure;
    const fs::path folder = fs::read_symlink("/proc/self/exe", failure).parent_path();
    return {folder / kModule, folder / ".." / NACRE_LIBDIR / kModule, NACRE_OIIO_BUILT,
            fs::path(NACRE_OIIO_INSTALLED) / kModule};
}

/// Loads the module once a call; it stays loaded, as its own threads do.
static OiioModule loadModule(const std::string& name) {
    std::string tried, reason;
    for (const fs::path& path : modulePaths()) {
        tried += (tried.empty() ? "" : ", ") + path.string();
        void* library = fs::exists(path) ? ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE) : nullptr;
        if (!library) {
            if (fs::exists(path)) reason = fmt::format(" ({})", ::dlerror());
            continue;
        }
        const OiioModule module{reinterpret_cast<NacreOiioRead>(::dlsym(library, "nacre_oiio_read")),
                                reinterpret_cast<NacreOiioFree>(::dlsym(library, "nacre_oiio_free"))};
        if (module.read && module.free) return module;
        reason = fmt::format(" ({}: not the module)", path.string());
    }
    throw Error(
        fmt::format("{}: expected an OpenEXR or Radiance picture, or the module that reads others, found neither{}; "
                    "tried {} (set NACRE_OIIO)",
                    name, reason, tried));
}

static bool statesLinear(const std::string& colorSpace) {
    for (const char* word : {"linear", "Linear", "scene_linear", "lin_srgb", "lin_rec709"})
        if (colorSpace == word) return true;
    return false;
}

static std::string oneLine(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    return text;
}

static ImageFile readByOiio(const fs::path& path, Samples samples) {
    const OiioModule module = loadModule(path.string());
    NacreOiioImage raw{};
    raw.codes = samples == Samples::Codes;
    raw.max_edge = exr::kMaxEdge;
    raw.max_values = static_cast<long long>(exr::kMaxValues);
    const bool failed = module.read(path.c_str(), &raw) != 0;
    const std::unique_ptr<NacreOiioImage, NacreOiioFree> releaseLater(&raw, module.free);
    if (failed)
        throw Error(fmt::format("{}: expected a complete picture with edges of at most {}, found: {}", path.string(),
                                exr::kMaxEdge, oneLine(raw.message)));
    ImageFile out;
    out.format = raw.format;
    out.sampleType = raw.sample_type;
    out.image = Image(raw.width, raw.height, raw.channels);
    out.image.data().assign(raw.values, raw.values + out.image.data().size());
    out.srgbDecoded = samples == Samples::Light &&
                      (std::strcmp(raw.color_space, "sRGB") == 0 || (raw.is_integer && !statesLinear(raw.color_space)));
    if (!out.srgbDecoded) return out;
    const int alpha = raw.channels % 2 == 0 ? raw.channels - 1 : raw.channels;
    for (std::size_t i = 0; i < out.image.data().size(); ++i)
        if (static_cast<int>(i % static_cast<std::size_t>(raw.channels)) != alpha)
            out.image.data()[i] = static_cast<float>(srgbToLinear(out.image.data()[i]));
    return out;
}

ImageFile readImageFile(const fs::path& path, Samples samples) {
    static constexpr std::array<std::uint8_t, 4> kExrMagic{0x76, 0x2f, 0x31, 0x01};
    const std::vector<std::uint8_t> bytes = readFile(path, exr::kMaxFileBytes);
    const auto startsWith = [&](std::string_view start) {
        return bytes.size() >= start.size() && std::memcmp(bytes.data(), start.data(), start.size()) == 0;
    };
    if (startsWith({reinterpret_cast<const char*>(kExrMagic.data()), kExrMagic.size()}))
        return parseExrImage(bytes, path.string(), samples);
    if (startsWith("#?")) return parseRadianceImage(bytes, path.string());
    if (bytes.empty()) throw Error(fmt::format("{}: expected a picture, found an empty file", path.string()));
    scanPng(bytes, path.string());
    const std::optional<double> nodata = scanTiff(bytes, path.string());
    ImageFile out = readByOiio(path, samples);
    out.nodata = nodata;
    out.hash = contentHash({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    return out;
}

}  // namespace nacre
