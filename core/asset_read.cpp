#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <memory>
#include <set>

#include "core/asset.hpp"
#include "core/asset_exr.hpp"
#include "core/error.hpp"
#include "core/exr_stream.hpp"
#include "core/file.hpp"

namespace nacre {

namespace {

/// What the JSON says of one texture.
struct TableEntry {
    AssetTexture texture;
    int width = 0, height = 0, channels = 0;
};

}  // namespace

/// One line: file, part (empty = the file itself), expected, found.
[[noreturn]] static void fail(const std::string& path, const std::string& part, const std::string& expected,
                              const std::string& found) {
    std::string text =
        fmt::format("{}: {}expected {}, found {}", path, part.empty() ? "" : "part " + part + ": ", expected, found);
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    throw Error(text);
}

static std::string shortened(std::string text) {
    if (text.size() > 60) text = text.substr(0, 57) + "...";
    return text;
}

/// What OpenEXR says, without the name that it gives every file here, as words that follow "found".
static std::string foundByOpenExr(const std::exception& error) {
    std::string text = error.what();
    for (const char* opening :
         {"Cannot read image file \"file\". ", "Error reading pixel data from image file \"file\". "})
        if (text.rfind(opening, 0) == 0) text.erase(0, std::strlen(opening));
    while (!text.empty() && (text.back() == '.' || text.back() == '\n')) text.pop_back();
    return text.rfind("bytes ", 0) == 0 ? text : "it corrupt: " + text;
}

static nlohmann::json parseMetadata(const std::string& path, const std::string& text) {
    static constexpr int kMaxDepth = 32;  // nested deeper, a printer would exhaust the stack
    const auto shallow = [&](int depth, nlohmann::json::parse_event_t, nlohmann::json&) {
        if (depth > kMaxDepth) fail(path, "", "JSON nested at most 32 deep in attribute 'nacre'", "deeper nesting");
        return true;
    };
    try {
        nlohmann::json json = nlohmann::json::parse(text, shallow);
        if (!json.is_object()) fail(path, "", "a JSON object in attribute 'nacre'", json.type_name());
        return json;
    } catch (const nlohmann::json::parse_error& error) {
        fail(path, "", "JSON in attribute 'nacre'", fmt::format("none from its byte {} on", error.byte));
    } catch (const nlohmann::json::exception& error) {
        fail(path, "", "JSON in attribute 'nacre'", error.what());
    }
}

/// The member `key` of `json` as a T; `what` names the type in messages.
template <typename T>
static T member(const std::string& path, const std::string& part, const nlohmann::json& json, const char* key,
                const char* what) {
    const auto found = json.find(key);
    if (found == json.end()) fail(path, part, fmt::format("{} '{}' in attribute 'nacre'", what, key), "none");
    const bool fits = std::is_same_v<T, std::string> ? found->is_string() : found->is_number_integer();
    if (!fits) fail(path, part, fmt::format("{} '{}' in attribute 'nacre'", what, key), shortened(found->dump()));
    return found->get<T>();
}

static glm::vec4 vectorMember(const std::string& path, const std::string& part, const nlohmann::json& json,
                              const char* key) {
    const auto found = json.find(key);
    glm::vec4 out(0.0f);
    bool good = found != json.end() && found->is_array() && found->size() == 4;
    for (int c = 0; good && c < 4; ++c) {
        const nlohmann::json& number = (*found)[static_cast<std::size_t>(c)];
        good = number.is_number();
        if (good) out[c] = static_cast<float>(number.get<double>());
        good = good && std::isfinite(out[c]);
    }
    if (!good)
        fail(path, part, fmt::format("four finite numbers '{}' in attribute 'nacre'", key),
             found == json.end() ? "none" : shortened(found->dump()));
    return out;
}

static TableEntry entryOf(const std::string& path, const nlohmann::json& json) {
    if (!json.is_object()) fail(path, "", "an object for each texture in attribute 'nacre'", shortened(json.dump()));
    TableEntry entry;
    AssetTexture& texture = entry.texture;
    texture.name = member<std::string>(path, "", json, "name", "string");
    texture.mapping = member<std::string>(path, texture.name, json, "mapping", "string");
    const auto size = [&](const char* key, int limit) {
        const auto value = member<std::int64_t>(path, texture.name, json, key, "integer");
        if (value < 1 || value > limit)
            fail(path, texture.name, fmt::format("{} 1 to {}", key, limit), fmt::format("{}", value));
        return static_cast<int>(value);
    };
    entry.width = size("width", exr::kMaxEdge);
    entry.height = size("height", exr::kMaxEdge);
    entry.channels = size("channels", 4);
    const auto format = member<std::string>(path, texture.name, json, "format", "string");
    if (format != "half" && format != "float" && format != "unorm8")
        fail(path, texture.name, "format half, float or unorm8", shortened(format));
    texture.format = texelFormatFromString(format);
    texture.scale = vectorMember(path, texture.name, json, "scale");
    texture.bias = vectorMember(path, texture.name, json, "bias");
    return entry;
}

/// Memory is bounded by the file's size: zip packs at most 1032 bytes into one, and a value takes two or more.
static std::size_t maxValues(std::size_t fileBytes) { return std::min(exr::kMaxValues, 600 * fileBytes); }

static std::vector<TableEntry> tableOf(const std::string& path, std::size_t fileBytes, const nlohmann::json& json,
                                       int parts) {
    const auto table = json.find("textures");
    if (table == json.end() || !table->is_array() || table->size() != static_cast<std::size_t>(parts))
        fail(path, "", fmt::format("'textures' in attribute 'nacre' with one entry for each of {} parts", parts),
             table == json.end() ? "none" : fmt::format("{} of size {}", table->type_name(), table->size()));
    std::vector<TableEntry> entries;
    std::size_t values = 0;
    std::set<std::string> names;
    for (const nlohmann::json& item : *table) {
        entries.push_back(entryOf(path, item));
        const TableEntry& entry = entries.back();
        if (!names.insert(entry.texture.name).second)
            fail(path, entry.texture.name, "unique texture names", "this one twice");
        values += static_cast<std::size_t>(entry.width) * static_cast<std::size_t>(entry.height) *
                  static_cast<std::size_t>(entry.channels);
        if (values > maxValues(fileBytes))
            fail(path, entry.texture.name,
                 fmt::format("at most {} values in a file of {} bytes", maxValues(fileBytes), fileBytes), "more");
    }
    return entries;
}

static void checkHeader(const std::string& path, const Imf::Header& header, const TableEntry& entry) {
    const std::string& part = entry.texture.name;
    const std::string name = header.hasName() ? header.name() : "";
    if (name != part) fail(path, part, "a part of that name", "'" + shortened(name) + "'");
    if (header.hasType() && header.type() != Imf::SCANLINEIMAGE)
        fail(path, part, "a part of type scanlineimage", shortened(header.type()));
    const Imath::Box2i& window = header.dataWindow();
    if (window.min != Imath::V2i(0, 0) || window.max != Imath::V2i(entry.width - 1, entry.height - 1))
        fail(path, part, fmt::format("data window (0, 0)-({}, {})", entry.width - 1, entry.height - 1),
             fmt::format("({}, {})-({}, {})", window.min.x, window.min.y, window.max.x, window.max.y));
    std::string wanted, found;
    const bool isFloat = entry.texture.format == TexelFormat::Float;
    std::set<std::string> sorted;
    for (const std::string& channel : exr::channelNames(entry.channels)) sorted.insert(channel);
    for (const std::string& channel : sorted) wanted += fmt::format(" {}:{}", channel, isFloat ? "float" : "half");
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
        const Imf::Channel& channel = c.channel();
        found += fmt::format(" {}:{}", c.name(),
                             channel.type == Imf::HALF    ? "half"
                             : channel.type == Imf::FLOAT ? "float"
                                                          : "uint");
        if (channel.xSampling != 1 || channel.ySampling != 1) found += "(subsampled)";
    }
    if (wanted != found) fail(path, part, "channels" + wanted, shortened("channels" + found));
}

/// Non-finite values, and for unorm8 values that are no code k/255, are an error.
static void checkTexels(const std::string& path, AssetTexture& texture) {
    static constexpr float kHalfStep = 255.0f / 2048;  // half keeps 11 bits: k/255 is off by less than this × 1/255
    const auto place = [&](std::size_t i) {
        const std::size_t texel = i / static_cast<std::size_t>(texture.image.channels());
        const std::size_t width = static_cast<std::size_t>(texture.image.width());
        return fmt::format("at texel ({}, {})", texel % width, texel / width);
    };
    std::vector<float>& data = texture.image.data();
    for (std::size_t i = 0; i < data.size(); ++i) {
        if (!std::isfinite(data[i])) fail(path, texture.name, "finite values", fmt::format("{} {}", data[i], place(i)));
        if (texture.format != TexelFormat::Unorm8) continue;
        const float code = std::nearbyint(data[i] * 255.0f);
        if (!(code >= 0 && code <= 255) || std::abs(data[i] * 255.0f - code) > kHalfStep)
            fail(path, texture.name, "unorm8 codes k/255", fmt::format("{} {}", data[i], place(i)));
        data[i] = code / 255.0f;
    }
}

static AssetTexture readPart(const std::string& path, Imf::MultiPartInputFile& file, int part, TableEntry entry) {
    AssetTexture texture = std::move(entry.texture);
    try {
        texture.image = Image(entry.width, entry.height, entry.channels);
        const std::size_t texel = sizeof(float) * static_cast<std::size_t>(entry.channels);
        char* base = reinterpret_cast<char*>(texture.image.data().data());
        Imf::FrameBuffer frame;
        for (const std::string& name : exr::channelNames(entry.channels)) {
            frame.insert(name, Imf::Slice(Imf::FLOAT, base, texel, texel * static_cast<std::size_t>(entry.width)));
            base += sizeof(float);
        }
        Imf::InputPart in(file, part);
        in.setFrameBuffer(frame);
        in.readPixels(0, entry.height - 1);
    } catch (const std::exception& error) {
        fail(path, texture.name, "complete pixel data", foundByOpenExr(error));
    }
    checkTexels(path, texture);
    return texture;
}

static Asset readOpened(const std::string& path, std::size_t fileBytes, Imf::MultiPartInputFile& file) {
    const int parts = file.parts();
    const auto* attribute = file.header(0).findTypedAttribute<Imf::StringAttribute>(exr::kAttribute);
    if (!attribute) fail(path, "", "a string attribute 'nacre'", "an EXR that is no nacre asset");
    Asset asset;
    asset.meta = parseMetadata(path, attribute->value());
    const auto version = member<std::int64_t>(path, "", asset.meta, "version", "integer");
    if (version != kAssetVersion)
        fail(path, "", fmt::format("format version {}", kAssetVersion), fmt::format("{}", version));
    asset.kind = member<std::string>(path, "", asset.meta, "kind", "string");
    if (asset.kind.empty()) fail(path, "", "a kind", "an empty string");
    if (static_cast<std::size_t>(parts) > exr::kMaxParts)
        fail(path, "", fmt::format("at most {} parts", exr::kMaxParts), fmt::format("{}", parts));
    std::vector<TableEntry> entries = tableOf(path, fileBytes, asset.meta, parts);
    for (int i = 0; i < parts; ++i) checkHeader(path, file.header(i), entries[static_cast<std::size_t>(i)]);
    for (int i = 0; i < parts; ++i)
        asset.textures.push_back(readPart(path, file, i, std::move(entries[static_cast<std::size_t>(i)])));
    return asset;
}

Asset parseAsset(std::span<const std::uint8_t> bytes, const std::string& name) {
    if (const auto broken = exr::brokenStart(bytes)) fail(name, "", "an OpenEXR file", *broken);
    exr::MemoryIStream stream(bytes);
    std::unique_ptr<Imf::MultiPartInputFile> file;
    try {
        // No thread pool, and no reconstruction of a broken chunk table: a truncated file is an error.
        file = std::make_unique<Imf::MultiPartInputFile>(stream, 0, false);
    } catch (const std::exception& error) {
        fail(name, "", "an OpenEXR file", foundByOpenExr(error));
    }
    try {
        return readOpened(name, bytes.size(), *file);
    } catch (const IEX_NAMESPACE::BaseExc& error) {
        fail(name, "", "a valid OpenEXR file", foundByOpenExr(error));
    }
}

Asset readAsset(const std::filesystem::path& path) {
    return parseAsset(readFile(path, exr::kMaxFileBytes), path.string());
}

}  // namespace nacre
