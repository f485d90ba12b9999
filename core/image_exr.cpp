// OpenEXR pictures: any compression, pixel type and part layout into floats.
#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfEnvmapAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <memory>

#include "core/asset_exr.hpp"
#include "core/error.hpp"
#include "core/exr_stream.hpp"
#include "core/file.hpp"
#include "core/image_file.hpp"

namespace nacre {

[[noreturn]] static void fail(const std::string& name, const std::string& expected, std::string found) {
    if (found.size() > 200) found = found.substr(0, 197) + "...";
    std::string text = fmt::format("{}: expected {}, found {}", name, expected, found);
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    throw Error(text);
}

/// Its name when there is one channel alone.
static std::vector<std::string> onlyChannel(const Imf::ChannelList& channels) {
    std::vector<std::string> names;
    for (auto c = channels.begin(); c != channels.end(); ++c) names.emplace_back(c.name());
    return names.size() == 1 ? names : std::vector<std::string>{};
}

/// The channels to read, in the image's order; empty when the part has no colours and, as data, not one channel alone.
static std::vector<std::string> colourChannels(const Imf::ChannelList& channels, Samples samples) {
    std::vector<std::string> names;
    if (channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B"))
        names = {"R", "G", "B"};
    else if (channels.findChannel("Y") && !channels.findChannel("RY"))
        names = {"Y"};
    else
        return samples == Samples::Codes ? onlyChannel(channels) : names;
    if (channels.findChannel("A")) names.emplace_back("A");
    return names;
}

static std::string channelText(const Imf::ChannelList& channels) {
    std::string text;
    for (auto c = channels.begin(); c != channels.end(); ++c) text += fmt::format(" {}", c.name());
    return text.empty() ? "none" : text.substr(1);
}

/// The first part with colours. \throws nacre::Error when there is none
static int colourPart(const Imf::MultiPartInputFile& file, const std::string& name, Samples samples) {
    for (int part = 0; part < file.parts(); ++part)
        if (!colourChannels(file.header(part).channels(), samples).empty()) return part;
    fail(name, "channels R, G, B or Y", channelText(file.header(0).channels()));
}

/// The image that the header announces, still black.
static Image imageFor(const Imf::Header& header, std::size_t channels, std::size_t fileBytes, const std::string& name) {
    // DWA and B44 keep 8 × 8 texels in a few numbers, which zip packs again.
    static constexpr std::size_t kMaxPacking = 64 * 1032;
    if (header.hasType() && header.type() != Imf::SCANLINEIMAGE && header.type() != Imf::TILEDIMAGE)
        fail(name, "a part of scanlines or tiles", header.type());
    const Imath::Box2i& window = header.dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1,
                       height = std::int64_t{window.max.y} - window.min.y + 1;
    if (width < 1 || height < 1 || width > exr::kMaxEdge || height > exr::kMaxEdge)
        fail(name, fmt::format("edges of 1 to {} texels", exr::kMaxEdge), fmt::format("{} x {}", width, height));
    const std::size_t values = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * channels;
    const std::size_t limit = std::min(exr::kMaxValues, kMaxPacking * fileBytes);
    if (values > limit)
        fail(name, fmt::format("at most {} values in a file of {} bytes", limit, fileBytes), fmt::format("{}", values));
    return Image(static_cast<int>(width), static_cast<int>(height), static_cast<int>(channels));
}

static void readPixels(Imf::MultiPartInputFile& file, int part, const std::vector<std::string>& names, Image& image) {
    const Imath::Box2i window = file.header(part).dataWindow();
    const std::size_t texel = sizeof(float) * names.size(), row = texel * static_cast<std::size_t>(image.width());
    Imf::FrameBuffer frame;
    // Slice::Make takes the window's corner off the address without leaving the array.
    for (std::size_t c = 0; c < names.size(); ++c)
        frame.insert(names[c], Imf::Slice::Make(Imf::FLOAT, image.data().data() + c, window, texel, row));
    Imf::InputPart in(file, part);
    in.setFrameBuffer(frame);
    in.readPixels(window.min.y, window.max.y);
}

static std::string sampleType(const Imf::ChannelList& channels, const std::vector<std::string>& names,
                              const std::string& path) {
    for (const std::string& name : names) {
        const Imf::Channel& channel = *channels.findChannel(name);
        if (channel.xSampling != 1 || channel.ySampling != 1)
            fail(path, "channels of full resolution", "channel " + name + " subsampled");
    }
    const Imf::PixelType type = channels.findChannel(names.front())->type;
    return type == Imf::HALF ? "half" : type == Imf::FLOAT ? "float" : "uint";
}

static ImageFile readOpened(Imf::MultiPartInputFile& file, std::size_t fileBytes, const std::string& name,
                            Samples samples) {
    const int part = colourPart(file, name, samples);
    const Imf::Header& header = file.header(part);
    const std::vector<std::string> names = colourChannels(header.channels(), samples);
    ImageFile out;
    out.format = "openexr";
    out.sampleType = sampleType(header.channels(), names, name);
    if (Imf::hasEnvmap(header)) out.envmap = Imf::envmap(header) == Imf::ENVMAP_CUBE ? "cube" : "latlong";
    if (const auto* json = file.header(0).findTypedAttribute<Imf::StringAttribute>(exr::kAttribute))
        out.asset = json->value();
    out.image = imageFor(header, names.size(), fileBytes, name);
    try {
        readPixels(file, part, names, out.image);
    } catch (const std::exception& error) {
        fail(name, "complete pixel data", error.what());
    }
    return out;
}

ImageFile parseExrImage(std::span<const std::uint8_t> bytes, const std::string& name, Samples samples) {
    if (const auto broken = exr::brokenStart(bytes)) fail(name, "an OpenEXR file", *broken);
    exr::MemoryIStream stream(bytes);
    try {
        // No thread pool, and no reconstruction of a broken chunk table: a truncated file is an error.
        Imf::MultiPartInputFile file(stream, 0, false);
        ImageFile out = readOpened(file, bytes.size(), name, samples);
        out.hash = contentHash({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        return out;
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        fail(name, "a complete OpenEXR file", error.what());
    }
}

}  // namespace nacre
