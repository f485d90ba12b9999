// Cut PNG files are refused before libpng writes lines of its own about them.
#include "core/png_scan.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "core/file.hpp"
#include "tests/core/scratch.hpp"

namespace nacre {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using tests::messageOf;

TEST(PngScan, WholePassesEveryCutIsRefusedOthersPass) {
    const std::vector<std::uint8_t> whole =
        readFile(NACRE_SOURCE_DIR "/tests/fuzz/corpus/png/grey.png", std::uint64_t{1} << 16);
    EXPECT_NO_THROW(scanPng(whole, "a"));
    for (std::size_t size = 8; size < whole.size(); ++size)
        EXPECT_THAT(messageOf<Error>([&] { scanPng(std::span(whole).first(size), "a.png"); }),
                    AllOf(HasSubstr("a.png: expected a complete PNG"), HasSubstr("found")))
            << size;
    for (std::size_t size = 0; size < 8; ++size) EXPECT_NO_THROW(scanPng(std::span(whole).first(size), "a")) << size;
    std::vector<std::uint8_t> longer = whole;
    longer.push_back(7);  // what follows IEND is nobody's business
    EXPECT_NO_THROW(scanPng(longer, "a"));
    longer = whole;
    longer[8] = 0xff;  // a length beyond the file
    EXPECT_THROW(scanPng(longer, "a"), Error);
}

}  // namespace
}  // namespace nacre
