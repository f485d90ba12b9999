// Pictures of every kind come in as linear floats, or are refused with one line that says what was expected.
#include "core/image_file.hpp"

#include <gmock/gmock.h>

#include <cstdlib>

#include "core/error.hpp"
#include "core/file.hpp"
#include "tests/core/exr_files.hpp"
#include "tests/core/scratch.hpp"

namespace nacre {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using tests::ExrStyle;
using tests::messageOf;
using tests::Scratch;
using tests::writeExr;

/// Smooth, different in every channel, of whole numbers when `whole`.
Image ramp(int width, int height, int channels, bool whole = false) {
    Image image(width, height, channels);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c)
                image.at(x, y, c) =
                    whole ? static_cast<float>(x + 10 * y + 100 * c)
                          : 0.25f + 0.01f * static_cast<float>(x) + 0.02f * static_cast<float>(y * (c + 1));
    return image;
}

std::vector<std::uint8_t> bytesOf(const std::string& text) { return {text.begin(), text.end()}; }

std::string readError(const std::filesystem::path& path) {
    return messageOf<Error>([&] { readImageFile(path); });
}

TEST(ImageFileExr, EveryCompressionTypeAndTiling) {
    const Scratch scratch;
    const std::filesystem::path path = scratch / "a.exr";
    for (int compression = 0; compression < Imf::NUM_COMPRESSION_METHODS; ++compression)
        for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT, Imf::UINT})
            for (const bool tiled : {false, true}) {
                ExrStyle style{type, static_cast<Imf::Compression>(compression), tiled, {}, {}, {}};
                const Image image = ramp(19, 11, 3, type == Imf::UINT);
                writeExr(image, path, style);
                const ImageFile read = readImageFile(path);
                ASSERT_EQ(read.image.channels(), 3);
                ASSERT_EQ(read.image.width(), 19);
                EXPECT_EQ(read.sampleType, type == Imf::HALF ? "half" : type == Imf::FLOAT ? "float" : "uint");
                // B44 and DWA are lossy on halves, PXR24 drops float bits, DWA stores other floats as they are.
                for (std::size_t i = 0; i < image.data().size(); ++i)
                    ASSERT_NEAR(read.image.data()[i], image.data()[i], 0.03f)
                        << "compression " << compression << " type " << type << " tiled " << tiled;
            }
}

TEST(ImageFileExr, ChannelsWindowAndEnvmapAttribute) {
    const Scratch scratch;
    for (int channels = 1; channels <= 4; ++channels) {
        const Image image = ramp(5, 3, channels);
        writeExr(image, scratch / "a.exr", {.corner = {-7, 12}});
        const ImageFile read = readImageFile(scratch / "a.exr");
        EXPECT_EQ(read.image.data(), image.data()) << channels;
        EXPECT_EQ(read.format, "openexr");
        EXPECT_FALSE(read.envmap);
        EXPECT_EQ(read.hash.size(), 16u);
    }
    writeExr(ramp(2, 12, 3), scratch / "cube.exr", {.envmap = Imf::ENVMAP_CUBE});
    EXPECT_EQ(readImageFile(scratch / "cube.exr").envmap, "cube");
    writeExr(ramp(4, 2, 3), scratch / "latlong.exr", {.envmap = Imf::ENVMAP_LATLONG});
    EXPECT_EQ(readImageFile(scratch / "latlong.exr").envmap, "latlong");
}

TEST(ImageFileExr, RefusesWhatHasNoColoursOrIsCut) {
    const Scratch scratch;
    writeExr(ramp(4, 2, 2), scratch / "z.exr", {.channels = {"Z", "N"}});
    EXPECT_THAT(readError(scratch / "z.exr"),
                AllOf(HasSubstr("z.exr: expected channels R, G, B or Y"), HasSubstr("N Z")));
    writeExr(ramp(64, 64, 3), scratch / "whole.exr");
    const std::vector<std::uint8_t> bytes = readFile(scratch / "whole.exr", 1 << 20);
    for (std::size_t part = 1; part < 40; ++part) {
        const std::span<const std::uint8_t> cut = std::span(bytes).first(bytes.size() * part / 40);
        const std::string message = messageOf<Error>([&] { parseExrImage(cut, "cut.exr"); });
        EXPECT_THAT(message, AllOf(HasSubstr("cut.exr: expected"), HasSubstr("found"))) << part;
        EXPECT_EQ(message.find('\n'), std::string::npos);
    }
}

TEST(ImageFileExr, WhatIsNotFiniteIsPassedOn) {
    const Scratch scratch;
    Image image(2, 1, 3);
    image.data() = {1e6f, -2, 3, INFINITY, NAN, 0};
    writeExr(image, scratch / "a.exr", {.type = Imf::HALF});
    const Image read = readImageFile(scratch / "a.exr").image;
    EXPECT_TRUE(std::isinf(read.at(0, 0, 0)) && std::isinf(read.at(1, 0, 0)) && std::isnan(read.at(1, 0, 1)));
    EXPECT_EQ(read.at(0, 0, 1), -2);
}

const std::string kHeader = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";

TEST(ImageFileRadiance, FlatTexelsAndExposure) {
    const std::string pixels("\x80\x40\x20\x81\x00\x00\x00\x00", 8);
    const ImageFile read = parseRadianceImage(bytesOf(kHeader + "-Y 1 +X 2\n" + pixels), "a.hdr");
    EXPECT_EQ(read.image.data(), (std::vector<float>{1, 0.5f, 0.25f, 0, 0, 0}));  // m · 2^(e − 136)
    const ImageFile brighter =
        parseRadianceImage(bytesOf("#?RGBE\nEXPOSURE= 2\nEXPOSURE=0.25\n\n+Y 1 -X 2\n" + pixels), "a.hdr");
    EXPECT_EQ(brighter.exposure, 0.5);
    EXPECT_EQ(brighter.image.data(), (std::vector<float>{0, 0, 0, 2, 1, 0.5f}));
    const ImageFile flipped = parseRadianceImage(bytesOf(kHeader + "+Y 2 +X 1\n" + pixels), "a.hdr");
    EXPECT_EQ(flipped.image.data(), (std::vector<float>{0, 0, 0, 1, 0.5f, 0.25f}));
}

TEST(ImageFileRadiance, RunsOfBothKinds) {
    std::string row("\x02\x02\x00\x0a", 4);
    row += std::string("\x8a\x80", 2);                                       // ten of 0x80
    row += std::string("\x03\x01\x02\x03\x87\x04", 6);                       // three, then seven
    row += std::string("\x0a\x00\x01\x02\x03\x04\x05\x06\x07\x08\x09", 11);  // ten as they are
    row += std::string("\x8a\x88", 2);
    const Image image = parseRadianceImage(bytesOf(kHeader + "-Y 1 +X 10\n" + row), "a.hdr").image;
    for (int x = 0; x < 10; ++x) EXPECT_EQ(image.rgb(x, 0), Rgb(128, std::min(x + 1, 4), x)) << x;
    const std::string old("\x80\x40\x20\x88\x01\x01\x01\x03", 8);
    EXPECT_EQ(parseRadianceImage(bytesOf(kHeader + "-Y 1 +X 4\n" + old), "a.hdr").image.rgb(3, 0), Rgb(128, 64, 32));
}

TEST(ImageFileRadiance, RefusesWhatIsCutOrStrange) {
    const auto refused = [](const std::string& text) {
        return messageOf<Error>([&] { parseRadianceImage(bytesOf(text), "a.hdr"); });
    };
    const std::string pixels(8, '\x80');
    const std::string whole = kHeader + "-Y 2 +X 1\n" + pixels;
    EXPECT_NO_THROW(parseRadianceImage(bytesOf(whole), "a.hdr"));
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_THAT(refused(whole.substr(0, size)), HasSubstr("a.hdr: expected")) << size;
    EXPECT_THAT(refused("P6\n"), HasSubstr("#?"));
    EXPECT_THAT(refused("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n1234"), HasSubstr("32-bit_rle_rgbe"));
    EXPECT_THAT(refused("#?RADIANCE\nEXPOSURE=0\n\n-Y 1 +X 1\n1234"), HasSubstr("EXPOSURE"));
    EXPECT_THAT(refused(kHeader + "+X 2 -Y 1\n" + pixels), HasSubstr("-Y 512 +X 1024"));
    EXPECT_THAT(refused(kHeader + "-Y 99999999 +X 1\n" + pixels), HasSubstr("edges"));
    EXPECT_THAT(refused(kHeader + "-Y 16384 +X 16384\n" + pixels), HasSubstr("values"));
    EXPECT_THAT(refused(kHeader + "-Y 1 +X 8\n" + std::string("\x02\x02\x00\x09", 4) + pixels), HasSubstr("row 0"));
    EXPECT_THAT(refused(kHeader + "-Y 1 +X 8\n" + std::string("\x02\x02\x00\x08\xff\x01", 6)), HasSubstr("runs"));
}

TEST(ImageFileOther, IntegersAreDecodedFromSrgb) {
    const Scratch scratch;
    const std::vector<std::uint8_t> codes = {0, 128, 255, 10, 64, 200};
    std::string ppm = "P6\n2 1\n255\n";
    ppm.append(codes.begin(), codes.end());
    writeFile(scratch / "a.ppm", ppm);
    const ImageFile read = readImageFile(scratch / "a.ppm");
    EXPECT_TRUE(read.srgbDecoded);
    EXPECT_EQ(read.sampleType, "uint8");
    for (std::size_t i = 0; i < codes.size(); ++i)
        EXPECT_NEAR(read.image.data()[i], srgbToLinear(codes[i] / 255.0), 1e-6) << i;
}

TEST(ImageFileOther, CodesAreTheNumbersOfTheFile) {
    const Scratch scratch;
    const std::vector<std::uint8_t> codes = {0, 128, 255, 10, 64, 200};
    std::string ppm = "P6\n2 1\n255\n";
    ppm.append(codes.begin(), codes.end());
    writeFile(scratch / "a.ppm", ppm);
    const ImageFile read = readImageFile(scratch / "a.ppm", Samples::Codes);
    EXPECT_FALSE(read.srgbDecoded);
    EXPECT_EQ(read.image.data(), (std::vector<float>{0, 128, 255, 10, 64, 200}));
    EXPECT_FALSE(read.nodata);
}

TEST(ImageFileOther, FloatsAreLinear) {
    const Scratch scratch;
    const std::vector<float> values = {0.5f, 2, 1000};
    std::string pfm = "PF\n1 1\n-1.0\n";
    pfm.append(reinterpret_cast<const char*>(values.data()), 12);
    writeFile(scratch / "a.pfm", pfm);
    const ImageFile read = readImageFile(scratch / "a.pfm");
    EXPECT_FALSE(read.srgbDecoded);
    EXPECT_EQ(read.image.data(), values);
}

TEST(ImageFileOther, RefusesWhatIsNoPictureAndAMissingModule) {
    const Scratch scratch;
    writeFile(scratch / "a.txt", "no picture");
    EXPECT_THAT(readError(scratch / "a.txt"), HasSubstr("a.txt: expected a complete picture"));
    writeFile(scratch / "empty", "");
    EXPECT_THAT(readError(scratch / "empty"), HasSubstr("an empty file"));
    EXPECT_THAT(readError(scratch / "none.exr"), HasSubstr("expected a file, found none"));
    ::setenv("NACRE_OIIO", "/no/such/module.so", 1);
    EXPECT_THAT(readError(scratch / "a.txt"), AllOf(HasSubstr("/no/such/module.so"), HasSubstr("NACRE_OIIO")));
    ::unsetenv("NACRE_OIIO");
}

TEST(SrgbToLinear, HasItsKnownPoints) {
    EXPECT_EQ(srgbToLinear(0), 0);
    EXPECT_NEAR(srgbToLinear(1), 1, 1e-12);
    EXPECT_NEAR(srgbToLinear(0.5), 0.21404114, 1e-7);
    EXPECT_NEAR(srgbToLinear(0.04045), 0.04045 / 12.92, 1e-12);
    EXPECT_EQ(srgbToLinear(3), 3);
}

}  // namespace
}  // namespace nacre
