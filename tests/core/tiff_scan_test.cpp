// Cut TIFF files are refused before a reader fills them up; the nodata number is found.
#include "core/tiff_scan.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "core/error.hpp"
#include "tests/core/height_files.hpp"
#include "tests/core/scratch.hpp"

namespace nacre {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using tests::messageOf;
using tests::tiff16;

TEST(TiffScan, BothByteOrdersInlineAndFarText) {
    for (const char* text : {"nan", "-32768", "-3.4028234663852886e+38", " 7 ", "0"}) {
        const std::string bytes = tiff16(2, 1, {1, 2}, false, text);
        const auto found = scanTiff({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, "a");
        ASSERT_TRUE(found) << text;
        EXPECT_TRUE(std::isnan(*found) ? std::string(text) == "nan" : *found == std::stod(text)) << text;
    }
    const std::string bad = tiff16(2, 1, {1, 2}, false, "none\n");
    EXPECT_THAT(messageOf<Error>([&] {
                    scanTiff({reinterpret_cast<const std::uint8_t*>(bad.data()), bad.size()}, "a.tif");
                }),
                AllOf(HasSubstr("a.tif"), HasSubstr("GDAL_NODATA"), HasSubstr("none?")));
    // Big-endian BigTIFF: one entry, text of 5 bytes inside the entry.
    const std::vector<std::uint8_t> big = {'M', 'M', 0, 43, 0, 8, 0,   0,   0,   0,    0,    0, 0, 0, 0,
                                           16,  0,   0, 0,  0, 0, 0,   0,   1,   0xa4, 0x81, 0, 2, 0, 0,
                                           0,   0,   0, 0,  0, 5, '-', '9', '.', '5',  0,    0, 0, 0};
    EXPECT_EQ(scanTiff(big, "a"), -9.5);
    for (std::size_t size = 0; size < big.size(); ++size) {
        std::optional<double> cut;
        EXPECT_NO_THROW(cut = scanTiff(std::span(big).first(size), "a")) << size;
        EXPECT_TRUE(size >= 41 || !cut) << size;
    }
}

TEST(TiffScan, CutBlocksAreAnErrorOtherBytesPass) {
    const std::string whole = tiff16(20, 20, std::vector<int>(400, 3), true, "");
    const std::span bytes(reinterpret_cast<const std::uint8_t*>(whole.data()), whole.size());
    EXPECT_FALSE(scanTiff(bytes, "a"));
    EXPECT_THAT(messageOf<Error>([&] { scanTiff(bytes.first(whole.size() - 1), "a.tif"); }),
                AllOf(HasSubstr("a.tif: expected a complete TIFF"), HasSubstr("block 0 of 1")));
    for (const std::size_t size : {0, 1, 4, 8, 9, 20}) EXPECT_FALSE(scanTiff(bytes.first(size), "a")) << size;
    const std::vector<std::uint8_t> other(100, 'I');
    EXPECT_FALSE(scanTiff(other, "a"));
}

}  // namespace
}  // namespace nacre
