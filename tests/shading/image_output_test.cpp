#include "shading/image_output.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include "core/error.hpp"
#include "core/file.hpp"

namespace nacre {
namespace {

std::filesystem::path scratch(const std::string& name) {
    return std::filesystem::temp_directory_path() / (std::to_string(getpid()) + "_" + name);
}

std::uint32_t bigEndian(const std::vector<std::uint8_t>& bytes, std::size_t at) {
    return static_cast<std::uint32_t>(bytes[at] << 24 | bytes[at + 1] << 16 | bytes[at + 2] << 8 | bytes[at + 3]);
}

/// A reader for what encodePng writes; checks each CRC.
std::vector<std::uint8_t> decode(const std::vector<std::uint8_t>& png, int width, int height) {
    std::vector<std::uint8_t> packed,
        rows(static_cast<std::size_t>(height) * (3 * static_cast<std::size_t>(width) + 1));
    for (std::size_t at = 8; at + 12 <= png.size();) {
        const std::uint32_t size = bigEndian(png, at);
        EXPECT_EQ(crc32(0, png.data() + at + 4, size + 4), bigEndian(png, at + 8 + size));
        if (std::string(png.begin() + at + 4, png.begin() + at + 8) == "IDAT")
            packed.insert(packed.end(), png.begin() + at + 8, png.begin() + at + 8 + size);
        at += 12 + size;
    }
    uLongf size = rows.size();
    EXPECT_EQ(uncompress(rows.data(), &size, packed.data(), packed.size()), Z_OK);
    EXPECT_EQ(size, rows.size());
    std::vector<std::uint8_t> out;
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
        const std::uint8_t* row = rows.data() + y * (3 * static_cast<std::size_t>(width) + 1);
        EXPECT_EQ(row[0], 1);
        for (std::size_t i = 0; i < 3 * static_cast<std::size_t>(width); ++i)
            out.push_back(static_cast<std::uint8_t>(row[1 + i] + (i < 3 ? 0 : out[out.size() - 3])));
    }
    return out;
}

// sRGB's own table: linear 0.5 is code 188, 0.18 is 118, and the linear toe 0.001 is 3.
TEST(ToneMap, KnowsSrgb) {
    Image image(6, 1, 3);
    const double values[] = {0, 0.5, 0.18, 0.001, 1, 7};
    for (int x = 0; x < 6; ++x) image.setRgb(x, 0, Rgb(values[x]));
    const auto codes = toneMap(image);
    const int expected[] = {0, 188, 118, 3, 255, 255};
    for (std::size_t x = 0; x < 6; ++x) EXPECT_EQ(codes[3 * x], expected[x]) << x;
    EXPECT_EQ(toneMap(image, {.white = 2})[3 * 4], 188);
    image.setRgb(2, 0, Rgb(-1));
    EXPECT_EQ(toneMap(image)[6], 0);
}

TEST(ToneMap, RejectsWhatHasNoColor) {
    Image image(2, 1, 3);
    EXPECT_THROW(toneMap(image, {.white = 0}), std::invalid_argument);
    image.at(1, 0, 2) = std::nanf("");
    EXPECT_THROW(toneMap(image), std::invalid_argument);
}

TEST(Png, RoundTrip) {
    std::vector<std::uint8_t> codes;
    for (int i = 0; i < 7 * 5 * 3; ++i) codes.push_back(static_cast<std::uint8_t>(i * 73));
    const auto png = encodePng(codes, 7, 5);
    EXPECT_EQ(bigEndian(png, 16), 7u);
    EXPECT_EQ(bigEndian(png, 20), 5u);
    EXPECT_EQ(decode(png, 7, 5), codes);
    EXPECT_THROW(encodePng(codes, 5, 5), std::invalid_argument);
    const auto path = scratch("picture.png");
    writePng(Image(3, 2, 1), path);
    EXPECT_EQ(decode(readFile(path, 1 << 20), 3, 2), std::vector<std::uint8_t>(18, 0));
    std::filesystem::remove(path);
    EXPECT_THROW(writePng(Image(3, 2, 3), "/no/such/folder/a.png"), Error);
}

TEST(Exr, KeepsFloatsExactly) {
    for (int channels : {1, 3, 4}) {
        Image image(5, 3, channels);
        for (std::size_t i = 0; i < image.data().size(); ++i)
            image.data()[i] = 1e5f / (1.0f + static_cast<float>(i * i));
        const auto path = scratch("linear.exr");
        writeExr(image, path);
        Imf::InputFile file(path.string().c_str());
        std::vector<float> red(15);
        Imf::FrameBuffer frame;
        frame.insert(channels == 1 ? "Y" : "R",
                     Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(red.data()), sizeof(float), 5 * sizeof(float)));
        file.setFrameBuffer(frame);
        file.readPixels(0, 2);
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 5; ++x) EXPECT_EQ(red[static_cast<std::size_t>(5 * y + x)], image.at(x, y, 0));
        std::filesystem::remove(path);
    }
    EXPECT_THROW(writeExr(Image(3, 2, 3), "/no/such/folder/a.exr"), Error);
    EXPECT_THROW(writeExr(Image(), scratch("none.exr")), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
