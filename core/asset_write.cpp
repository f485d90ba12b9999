#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>
#include <half.h>

#include <set>

#include "core/asset.hpp"
#include "core/asset_exr.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/version.hpp"

namespace nacre {

namespace {

/// The file is built in memory: OpenEXR writes its chunk tables in a destructor, which hides a full disk.
class MemoryOStream : public Imf::OStream {
public:
    MemoryOStream() : Imf::OStream("memory") {}
    void write(const char c[], int n) override {
        const std::size_t end = position_ + static_cast<std::size_t>(n);
        if (end > bytes_.size()) bytes_.resize(end);
        std::copy(c, c + n, bytes_.begin() + static_cast<std::ptrdiff_t>(position_));
        position_ = end;
    }
    uint64_t tellp() override { return position_; }
    void seekp(uint64_t pos) override { position_ = pos; }
    const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_;
    std::size_t position_ = 0;
};

}  // namespace

static nlohmann::json textureTable(const Asset& asset) {
    const auto four = [](const glm::vec4& v) { return nlohmann::json::array({v.x, v.y, v.z, v.w}); };
    nlohmann::json table = nlohmann::json::array();
    for (const AssetTexture& t : asset.textures)
        table.push_back({{"name", t.name},
                         {"mapping", t.mapping},
                         {"width", t.image.width()},
                         {"height", t.image.height()},
                         {"channels", t.image.channels()},
                         {"format", toString(t.format)},
                         {"scale", four(t.scale)},
                         {"bias", four(t.bias)}});
    return table;
}

static std::string metadataText(const Asset& asset) {
    nlohmann::json json = asset.meta;
    json["kind"] = asset.kind;
    json["version"] = kAssetVersion;
    json["nacre"] = nacreVersion();
    json["bytes"] = asset.bytes();
    json["textures"] = textureTable(asset);
    // A command line may hold any bytes: those that are no UTF-8 become U+FFFD.
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

static void requireWritable(const Asset& asset) {
    require(!asset.kind.empty(), "writeAsset: kind is empty");
    require(asset.meta.is_object(), "writeAsset: meta must be a JSON object");
    require(!asset.textures.empty() && asset.textures.size() <= exr::kMaxParts, "writeAsset: needs 1 to 160 textures");
    std::set<std::string> names;
    std::size_t values = 0;
    for (const AssetTexture& t : asset.textures) {
        require(!t.name.empty() && names.insert(t.name).second,
                fmt::format("writeAsset: texture name '{}' is empty or not unique", t.name));
        require(!t.image.empty() && std::max(t.image.width(), t.image.height()) <= exr::kMaxEdge,
                fmt::format("writeAsset: texture {}: edges must be 1 to {}", t.name, exr::kMaxEdge));
        values += t.image.data().size();
        for (const float v : t.image.data())
            if (!std::isfinite(v) || (t.format != TexelFormat::Float && std::abs(v) > 65504.0f))
                throw std::invalid_argument(
                    fmt::format("writeAsset: texture {}: {} does not fit {}", t.name, v, toString(t.format)));
        for (int c = 0; c < 4; ++c)
            require(std::isfinite(t.scale[c]) && std::isfinite(t.bias[c]),
                    fmt::format("writeAsset: texture {}: scale and bias must be finite", t.name));
    }
    require(values <= exr::kMaxValues, fmt::format("writeAsset: more than {} values", exr::kMaxValues));
}

/// \param display  the same for all parts, as OpenEXR wants it: the size of the largest
static Imf::Header headerOf(const AssetTexture& texture, const Imath::Box2i& display) {
    Imf::Header header(texture.image.width(), texture.image.height());
    header.displayWindow() = display;
    header.compression() = Imf::ZIP_COMPRESSION;
    header.setName(texture.name);
    header.setType(Imf::SCANLINEIMAGE);
    const Imf::PixelType type = texture.format == TexelFormat::Float ? Imf::FLOAT : Imf::HALF;
    for (const std::string& name : exr::channelNames(texture.image.channels()))
        header.channels().insert(name, Imf::Channel(type));
    return header;
}

static void writePart(Imf::MultiPartOutputFile& file, int part, const AssetTexture& texture) {
    const Image& image = texture.image;
    std::vector<half> halves;
    char* base = nullptr;
    std::size_t size = sizeof(float);
    std::vector<float> floats;
    if (texture.format == TexelFormat::Float) {
        floats = image.data();
        base = reinterpret_cast<char*>(floats.data());
    } else {
        halves.assign(image.data().begin(), image.data().end());
        base = reinterpret_cast<char*>(halves.data());
        size = sizeof(half);
    }
    const std::size_t texel = size * static_cast<std::size_t>(image.channels());
    Imf::FrameBuffer frame;
    std::size_t offset = 0;
    for (const std::string& name : exr::channelNames(image.channels())) {
        frame.insert(name, Imf::Slice(texture.format == TexelFormat::Float ? Imf::FLOAT : Imf::HALF, base + offset,
                                      texel, texel * static_cast<std::size_t>(image.width())));
        offset += size;
    }
    Imf::OutputPart out(file, part);
    out.setFrameBuffer(frame);
    out.writePixels(image.height());
}

void writeAsset(const Asset& asset, const std::filesystem::path& path) {
    requireWritable(asset);
    std::vector<Imf::Header> headers;
    Imath::Box2i display(Imath::V2i(0, 0));
    for (const AssetTexture& t : asset.textures)
        display.extendBy(Imath::V2i(t.image.width() - 1, t.image.height() - 1));
    for (const AssetTexture& texture : asset.textures) headers.push_back(headerOf(texture, display));
    headers.front().insert(exr::kAttribute, Imf::StringAttribute(metadataText(asset)));
    MemoryOStream stream;
    {
        Imf::MultiPartOutputFile file(stream, headers.data(), static_cast<int>(headers.size()), false, 0);
        for (std::size_t i = 0; i < asset.textures.size(); ++i) writePart(file, static_cast<int>(i), asset.textures[i]);
    }
    writeFile(path, stream.bytes());
}

}  // namespace nacre
