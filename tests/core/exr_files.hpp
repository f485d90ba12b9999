// Small OpenEXR pictures in every way of writing them, for the tests of the readers.
#pragma once

#include <ImfChannelList.h>
#include <ImfEnvmap.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledOutputFile.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/image.hpp"

namespace nacre::tests {

struct ExrStyle {
    Imf::PixelType type = Imf::FLOAT;
    Imf::Compression compression = Imf::ZIP_COMPRESSION;
    bool tiled = false;
    Imath::V2i corner{0, 0};              ///< of the data window
    std::optional<Imf::Envmap> envmap{};  ///< the attribute
    std::vector<std::string> channels{};  ///< instead of Y, Y A, R G B, R G B A
};

inline void writeExr(const Image& image, const std::filesystem::path& path, const ExrStyle& style = {}) {
    const std::vector<std::vector<std::string>> kNames = {{}, {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
    const std::vector<std::string> names =
        style.channels.empty() ? kNames[static_cast<std::size_t>(image.channels())] : style.channels;
    const Imath::Box2i window(style.corner, style.corner + Imath::V2i(image.width() - 1, image.height() - 1));
    Imf::Header header(window, window);
    header.compression() = style.compression;
    if (style.envmap) Imf::addEnvmap(header, *style.envmap);
    // One plane a channel in the file's type: OpenEXR converts nothing while writing.
    std::vector<std::vector<char>> planes;
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < names.size(); ++c) {
        header.channels().insert(names[c], Imf::Channel(style.type));
        const std::size_t size = style.type == Imf::HALF ? 2 : 4;
        std::vector<char>& plane = planes.emplace_back(image.texelCount() * size);
        for (std::size_t i = 0; i < image.texelCount(); ++i) {
            const float v = image.data()[i * static_cast<std::size_t>(image.channels()) + c];
            if (style.type == Imf::HALF) reinterpret_cast<half*>(plane.data())[i] = half(v);
            if (style.type == Imf::FLOAT) reinterpret_cast<float*>(plane.data())[i] = v;
            if (style.type == Imf::UINT) reinterpret_cast<unsigned*>(plane.data())[i] = static_cast<unsigned>(v);
        }
        frame.insert(names[c], Imf::Slice::Make(style.type, plane.data(), window, size,
                                                size * static_cast<std::size_t>(image.width())));
    }
    if (style.tiled) {
        header.setTileDescription(Imf::TileDescription(8, 8, Imf::ONE_LEVEL));
        Imf::TiledOutputFile file(path.c_str(), header);
        file.setFrameBuffer(frame);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    } else {
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(frame);
        file.writePixels(image.height());
    }
}

}  // namespace nacre::tests
