#include "shading/gltf_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/json_field.hpp"

namespace nacre {

using nlohmann::json;

namespace {

constexpr std::uint64_t kMaxBytes = 4ull << 30;  // glTF's own limit of a container
constexpr std::size_t kHeader = 12, kChunkHeader = 8;
constexpr std::uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A;  // "glTF", "JSON"

std::uint32_t word(std::span<const std::uint8_t> bytes, std::size_t at) {
    std::uint32_t out = 0;
    for (std::size_t i = 0; i < 4; ++i) out |= static_cast<std::uint32_t>(bytes[at + i]) << (8 * i);
    return out;
}

void putWord(std::vector<std::uint8_t>& out, std::size_t value) {
    for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

/// \return the JSON text; leaves what follows it in file.chunks
std::string openContainer(GltfFile& file, std::span<const std::uint8_t> bytes) {
    const std::string name = file.path.string();
    if (bytes.size() < kHeader + kChunkHeader)
        throw Error(fmt::format("{}: expected a glTF container, found {} bytes", name, bytes.size()));
    if (word(bytes, 4) != 2) throw Error(fmt::format("{}: expected glTF version 2, found {}", name, word(bytes, 4)));
    const std::size_t length = word(bytes, kHeader), begin = kHeader + kChunkHeader;
    if (word(bytes, kHeader + 4) != kJsonChunk)
        throw Error(fmt::format("{}: expected a JSON chunk first, found another", name));
    if (length > bytes.size() - begin)
        throw Error(fmt::format("{}: expected {} bytes of JSON, found {}", name, length, bytes.size() - begin));
    const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(begin),
               last = first + static_cast<std::ptrdiff_t>(length);
    file.chunks.assign(last, bytes.end());
    return {first, last};
}

/// Those that change nothing of what is read, or that are read.
bool isKnownExtension(const std::string& name) {
    for (const char* prefix : {"KHR_lights_punctual", "KHR_materials_", "KHR_texture_", "EXT_texture_"})
        if (name.rfind(prefix, 0) == 0) return true;
    return false;
}

/// The document in place of the file's own.
std::vector<std::uint8_t> contained(const json& document, const GltfFile& file) {
    std::string text = document.dump();
    if (!file.isBinary) return {text.begin(), text.end()};
    text.resize((text.size() + 3) / 4 * 4, ' ');  // chunks begin at multiples of four
    std::vector<std::uint8_t> bytes;
    putWord(bytes, kMagic);
    putWord(bytes, 2);
    putWord(bytes, kHeader + kChunkHeader + text.size() + file.chunks.size());
    putWord(bytes, text.size());
    putWord(bytes, kJsonChunk);
    bytes.insert(bytes.end(), text.begin(), text.end());
    bytes.insert(bytes.end(), file.chunks.begin(), file.chunks.end());
    return bytes;
}

json bare(const std::string& name) { return {{"name", name}}; }

}  // namespace

GltfFile readGltf(const std::filesystem::path& path) { return parseGltf(readFile(path, kMaxBytes), path); }

GltfFile parseGltf(std::span<const std::uint8_t> bytes, const std::filesystem::path& path) {
    GltfFile file;
    file.path = path;
    const std::string name = path.string();
    file.isBinary = bytes.size() >= 4 && word(bytes, 0) == kMagic;
    file.document =
        parseJson(file.isBinary ? openContainer(file, bytes) : std::string(bytes.begin(), bytes.end()), name);
    const JsonField root(file.document, name);
    const JsonField version = root.at("asset").at("version");
    if (version.text().rfind("2.", 0) != 0) version.fail("expected version 2, found \"" + version.text() + '"');
    if (const auto required = root.find("extensionsRequired"))
        for (const JsonField& extension : required->items())
            if (!isKnownExtension(extension.text()))
                extension.fail(
                    fmt::format("expected no extension that isn't read here, found \"{}\"", extension.text()));
    return file;
}

std::vector<std::uint8_t> geometryOf(const GltfFile& file) {
    json out = {{"asset", {{"version", "2.0"}}}};
    for (const char* part : {"accessors", "bufferViews", "buffers", "meshes", "animations"})
        if (file.document.contains(part)) out[part] = file.document[part];
    const auto countOf = [&](const char* part) {
        return file.document.contains(part) && file.document[part].is_array() ? file.document[part].size() : 0;
    };
    for (std::size_t i = 0; i < countOf("materials"); ++i) out["materials"].push_back(bare("m" + std::to_string(i)));
    json roots = json::array();
    for (std::size_t i = 0; i < countOf("nodes"); ++i) {
        roots.push_back(out["nodes"].size());
        out["nodes"].push_back(bare("n" + std::to_string(i)));
    }
    for (std::size_t i = 0; i < countOf("meshes"); ++i) {
        roots.push_back(out["nodes"].size());
        out["nodes"].push_back(bare("m" + std::to_string(i)));
        out["nodes"].back()["mesh"] = i;
    }
    out["scenes"] = {{{"nodes", roots}}};
    out["scene"] = 0;
    return contained(out, file);
}

std::vector<std::uint8_t> withNumberedNodes(const GltfFile& file) {
    json out = file.document;
    if (out.contains("nodes"))
        for (std::size_t i = 0; out["nodes"].is_array() && i < out["nodes"].size(); ++i)
            if (out["nodes"][i].is_object()) out["nodes"][i]["name"] = "n" + std::to_string(i);
    return contained(out, file);
}

}  // namespace nacre
