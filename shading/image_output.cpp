#include "shading/image_output.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <fmt/format.h>
#include <zlib.h>

#include <string_view>

#include "core/error.hpp"
#include "core/file.hpp"

namespace nacre {
namespace {

double srgbTransfer(double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055; }

void appendBigEndian(std::vector<std::uint8_t>& out, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

/// Length, type, data, and the CRC of type and data (PNG specification, section 5.3).
void appendChunk(std::vector<std::uint8_t>& out, std::string_view type, const std::vector<std::uint8_t>& data) {
    appendBigEndian(out, static_cast<std::uint32_t>(data.size()));
    const std::size_t start = out.size();
    out.insert(out.end(), type.begin(), type.end());
    out.insert(out.end(), data.begin(), data.end());
    appendBigEndian(out,
                    static_cast<std::uint32_t>(crc32(0, out.data() + start, static_cast<uInt>(out.size() - start))));
}

/// Rows with the `sub` filter (difference to the pixel on the left), deflated.
std::vector<std::uint8_t> deflateRows(const std::vector<std::uint8_t>& codes, int width, int height) {
    std::vector<std::uint8_t> rows;
    const std::size_t stride = static_cast<std::size_t>(width) * 3;
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
        rows.push_back(1);
        for (std::size_t i = 0; i < stride; ++i) {
            const int left = i < 3 ? 0 : codes[y * stride + i - 3];
            rows.push_back(static_cast<std::uint8_t>(codes[y * stride + i] - left));
        }
    }
    uLongf size = compressBound(rows.size());
    std::vector<std::uint8_t> out(size);
    if (compress2(out.data(), &size, rows.data(), rows.size(), 9) != Z_OK) throw Error("zlib could not deflate a PNG");
    out.resize(size);
    return out;
}

}  // namespace

std::vector<std::uint8_t> toneMap(const Image& image, const ToneMap& options) {
    require(std::isfinite(options.white) && options.white > 0, "toneMap: white must be finite and > 0");
    std::vector<std::uint8_t> out;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const Rgb value = image.rgb(x, y);
            require(isFinite(value), fmt::format("toneMap: texel ({}, {}) is not finite", x, y));
            for (int c = 0; c < 3; ++c)
                out.push_back(
                    static_cast<std::uint8_t>(std::lround(255 * srgbTransfer(clamp01(value[c] / options.white)))));
        }
    return out;
}

std::vector<std::uint8_t> encodePng(const std::vector<std::uint8_t>& codes, int width, int height) {
    require(width >= 1 && height >= 1 &&
                codes.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3,
            "encodePng: needs width * height * 3 codes");
    std::vector<std::uint8_t> out{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    std::vector<std::uint8_t> header;
    appendBigEndian(header, static_cast<std::uint32_t>(width));
    appendBigEndian(header, static_cast<std::uint32_t>(height));
    header.insert(header.end(), {8, 2, 0, 0, 0});  // 8 bits, RGB, deflate, adaptive filters, not interlaced
    appendChunk(out, "IHDR", header);
    appendChunk(out, "sRGB", {0});  // perceptual intent
    appendChunk(out, "IDAT", deflateRows(codes, width, height));
    appendChunk(out, "IEND", {});
    return out;
}

void writePng(const Image& image, const std::filesystem::path& path, const ToneMap& options) {
    const std::vector<std::uint8_t> bytes = encodePng(toneMap(image, options), image.width(), image.height());
    writeFile(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

void writeExr(const Image& image, const std::filesystem::path& path) {
    require(!image.empty(), "writeExr: empty image");
    static const char* const kNames[4][4] = {{"Y"}, {"R", "G"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
    const int channels = image.channels();
    Imf::Header header(image.width(), image.height());
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer pixels;
    std::vector<float> data = image.data();  // OpenEXR takes a non-const pointer
    for (int c = 0; c < channels; ++c) {
        header.channels().insert(kNames[channels - 1][c], Imf::Channel(Imf::FLOAT));
        const std::size_t stride = sizeof(float) * static_cast<std::size_t>(channels);
        pixels.insert(kNames[channels - 1][c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(data.data() + c), stride,
                                                          stride * static_cast<std::size_t>(image.width())));
    }
    writeThenRename(path, [&](const std::filesystem::path& temporary) {
        try {
            Imf::OutputFile file(temporary.string().c_str(), header);
            file.setFrameBuffer(pixels);
            file.writePixels(image.height());
        } catch (const std::exception& error) {
            throw Error(fmt::format("{}: could not write EXR: {}", path.string(), error.what()));
        }
    });
}

}  // namespace nacre
