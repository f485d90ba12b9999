// Heights come in as the numbers that the file holds, or are refused with one line.
#include "bump/read_height.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "core/file.hpp"
#include "tests/core/exr_files.hpp"
#include "tests/core/height_files.hpp"
#include "tests/core/scratch.hpp"

namespace nacre {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using tests::greyBmp;
using tests::messageOf;
using tests::Scratch;
using tests::tiff16;
using tests::writeExr;

const float kNan = std::nanf("");

ImageFile picture(std::vector<float> values, int width, int channels, const std::string& type = "float") {
    ImageFile file;
    file.image = Image(width, static_cast<int>(values.size()) / width / channels, channels);
    file.image.data() = std::move(values);
    file.sampleType = type;
    return file;
}

std::string readError(const std::filesystem::path& path, const HeightOptions& options = {}) {
    return messageOf<Error>([&] { readHeight(path, options); });
}

TEST(ReadHeight, EightBitCodesAreNormalisedAndNotDecodedAsSrgb) {
    const Scratch scratch;
    writeFile(scratch / "a.bmp", greyBmp(3, 2, {0, 64, 128, 255, 10, 20}));
    const HeightField field = readHeight(scratch / "a.bmp", {.scale = 51, .texelSize = 2});
    const std::vector<int> codes = {0, 64, 128, 255, 10, 20};
    for (std::size_t i = 0; i < codes.size(); ++i)
        EXPECT_FLOAT_EQ(field.map.heights.data()[i], static_cast<float>(codes[i] / 255.0 * 51 / 2)) << i;
    EXPECT_EQ(field.report.sampleType, "uint8");
    EXPECT_EQ(field.report.file.high, 255);
    EXPECT_EQ(field.report.hash.size(), 16u);
    EXPECT_EQ(field.map.wrap, Wrap::Repeat);
}

TEST(ReadHeight, SixteenBitsStaySixteenBits) {
    const Scratch scratch;
    writeFile(scratch / "a.tif", tiff16(4, 1, {0, 1, 32768, 65535}, false, ""));
    const HeightField field = readHeight(scratch / "a.tif", {.scale = 65535});
    EXPECT_EQ(field.report.sampleType, "uint16");
    EXPECT_EQ(field.map.heights.data(), (std::vector<float>{0, 1, 32768, 65535}));
}

TEST(ReadHeight, SignedGeoTiffIsTakenAsItIsAndItsOwnNodataMakesHoles) {
    const Scratch scratch;
    writeFile(scratch / "a.tif", tiff16(3, 2, {-32768, -5, 0, 7, 30000, -32768}, true, "-32768"));
    const HeightField field = readHeight(scratch / "a.tif", {.texelSize = 10});
    EXPECT_EQ(field.report.sampleType, "int16");
    EXPECT_EQ(field.report.holes, 2u);
    EXPECT_EQ(field.report.fileNodata, -32768);
    EXPECT_TRUE(std::isnan(field.map.heights.at(0, 0, 0)));
    EXPECT_FLOAT_EQ(field.map.heights.at(1, 0, 0), -0.5f);
    EXPECT_FLOAT_EQ(field.map.heights.at(1, 1, 0), 3000);
    EXPECT_EQ(readHeight(scratch / "a.tif", {.nodata = 7}).report.holes, 3u) << "both numbers";
}

TEST(ReadHeight, FloatsKeepTheirRangeAndEveryChannelNameDoes) {
    const Scratch scratch;
    Image image(2, 1, 1);
    image.data() = {-1e6f, 1e6f};
    writeExr(image, scratch / "y.exr");
    writeExr(image, scratch / "z.exr", {.channels = {"Z"}});
    for (const char* name : {"y.exr", "z.exr"})
        EXPECT_EQ(readHeight(scratch / name).map.heights.data(), image.data()) << name;
    image.data() = {1e-6f, 2e-6f};
    writeExr(image, scratch / "y.exr");
    EXPECT_EQ(readHeight(scratch / "y.exr").map.heights.data(), image.data());
}

TEST(ReadHeight, GreyIsTakenColoursNeedAChannel) {
    EXPECT_EQ(heightFromImage(picture({1, 1, 1, 2, 2, 2}, 2, 3), "a").report.channel, "r=g=b");
    EXPECT_EQ(heightFromImage(picture({1, 9, 2, 9}, 2, 2), "a").map.heights.data(), (std::vector<float>{1, 2}));
    const ImageFile colours = picture({1, 1, 1, 8, 1, 2, 3, 9}, 2, 4);
    EXPECT_THAT(messageOf<Error>([&] { heightFromImage(colours, "a.png"); }),
                AllOf(HasSubstr("a.png: expected"), HasSubstr("(1, 0)"), HasSubstr("--channel")));
    const auto value = [&](const char* channel) {
        return heightFromImage(colours, "a", {.channel = channel}).map.heights.at(1, 0, 0);
    };
    EXPECT_EQ(value("r"), 1);
    EXPECT_EQ(value("g"), 2);
    EXPECT_EQ(value("b"), 3);
    EXPECT_EQ(value("a"), 9);
    EXPECT_FLOAT_EQ(value("y"), static_cast<float>(luminance({1, 2, 3})));
    EXPECT_THAT(messageOf<Error>([] {
                    heightFromImage(picture({1, 2}, 2, 1), "a", {.channel = "g"});
                }),
                AllOf(HasSubstr("channel g"), HasSubstr("found Y")));
}

TEST(ReadHeight, NanInfinityAndHolesAreErrorsThatNameTheTexel) {
    const ImageFile holes = picture({1, kNan, 2, kNan}, 2, 1);
    EXPECT_THAT(messageOf<Error>([&] { heightFromImage(holes, "a"); }),
                AllOf(HasSubstr("2 NaN"), HasSubstr("(1, 0)"), HasSubstr("--nodata nan")));
    EXPECT_EQ(heightFromImage(holes, "a", {.nodata = NAN}).report.holes, 2u);
    EXPECT_THAT(messageOf<Error>([] {
                    heightFromImage(picture({1, 2, 3, INFINITY}, 2, 1), "a");
                }),
                HasSubstr("infinity at texel (1, 1)"));
    EXPECT_THAT(messageOf<Error>([] {
                    heightFromImage(picture({7, 7}, 2, 1), "a", {.nodata = 7});
                }),
                HasSubstr("2 holes and nothing else"));
    EXPECT_THAT(messageOf<Error>([] {
                    heightFromImage(picture({7, 1e38f}, 2, 1), "a", {.scale = 100});
                }),
                HasSubstr("texel (1, 0)"));
}

TEST(ReadHeight, BadOptionsAreTheCallers) {
    const ImageFile file = picture({1, 2}, 2, 1);
    for (const HeightOptions& bad :
         {HeightOptions{.scale = 0}, HeightOptions{.scale = NAN}, HeightOptions{.texelSize = -1},
          HeightOptions{.texelSize = 0}, HeightOptions{.nodata = INFINITY}, HeightOptions{.channel = "x"}})
        EXPECT_THROW(heightFromImage(file, "a", bad), std::invalid_argument);
}

TEST(ReadHeight, CutFilesAreRefusedInOneLine) {
    const Scratch scratch;
    const std::string tiff = tiff16(20, 20, std::vector<int>(400, 3), true, "nan");
    for (std::size_t size = 0; size < tiff.size(); size += 37) {
        writeFile(scratch / "cut.tif", tiff.substr(0, size));
        const std::string message = readError(scratch / "cut.tif");
        EXPECT_THAT(message, AllOf(HasSubstr("cut.tif: expected"), HasSubstr("found"))) << size;
        EXPECT_EQ(message.find('\n'), std::string::npos);
    }
    writeFile(scratch / "a.txt", "no picture");
    EXPECT_THAT(readError(scratch / "a.txt"), HasSubstr("a.txt: expected a complete picture"));
    EXPECT_THAT(readError(scratch / "none.png"), HasSubstr("found none"));
}

}  // namespace
}  // namespace nacre
