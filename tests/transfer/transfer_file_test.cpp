#include "transfer/transfer_file.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "core/error.hpp"
#include "core/file.hpp"
#include "tests/core/scratch.hpp"

namespace nacre {
namespace {

using ::testing::HasSubstr;
using tests::messageOf;
using tests::Scratch;

/// Three vertices of four in the animation, three frames of which two stand still.
TransferRecording small() {
    TransferRecording r;
    r.order = 1;
    r.framesPerSecond = 24;
    r.weldOf = {0, 1, 2, 0};
    r.triangles = {{0, 1, 2}};
    for (int b = 0; b < 2; ++b) {
        TransferRecording::Block block;
        for (int v = 0; v < 3; ++v) block.positions.emplace_back(v, b, 0.5f);
        for (int i = 0; i < 12; ++i) block.coefficients.push_back(0.1f * static_cast<float>(i - b));
        r.blocks.push_back(block);
    }
    r.frames = {{3, 0}, {4, 0}, {6, 1}};
    r.meta["command_line"] = "nacre transfer";
    return r;
}

std::string refused(const std::vector<std::uint8_t>& bytes) {
    return messageOf<Error>([&] { parseTransfer(bytes, "a.bin"); });
}

std::vector<std::uint8_t> bytesOf(const TransferRecording& recording) {
    const Scratch scratch;
    writeTransfer(recording, scratch / "a");
    return readFile(scratch / "a", 1 << 20);
}

/// Found once in the bytes, replaced by as many.
std::vector<std::uint8_t> with(std::vector<std::uint8_t> bytes, const std::string& from, const std::string& to) {
    EXPECT_EQ(from.size(), to.size());
    const auto at = std::search(bytes.begin(), bytes.end(), from.begin(), from.end());
    EXPECT_NE(at, bytes.end()) << from;
    std::copy(to.begin(), to.end(), at);
    return bytes;
}

TEST(TransferFile, WhatIsWrittenComesBack) {
    const Scratch scratch;
    const TransferRecording before = small();
    writeTransfer(before, scratch / "a");
    EXPECT_EQ(scratch.fileCount(), 1u) << "no temporary file stays";
    EXPECT_TRUE(isTransferFile(scratch / "a"));
    const TransferRecording after = readTransfer(scratch / "a");
    EXPECT_EQ(after.order, 1);
    EXPECT_EQ(after.framesPerSecond, 24);
    EXPECT_EQ(after.weldOf, before.weldOf);
    EXPECT_EQ(after.triangles, before.triangles);
    ASSERT_EQ(after.blocks.size(), 2u);
    for (std::size_t b = 0; b < 2; ++b) {
        EXPECT_EQ(after.blocks[b].positions, before.blocks[b].positions);
        EXPECT_EQ(after.blocks[b].coefficients, before.blocks[b].coefficients);
    }
    ASSERT_EQ(after.frames.size(), 3u);
    EXPECT_EQ(after.frames[2].number, 6);
    EXPECT_EQ(after.frames[2].block, 1);
    EXPECT_EQ(after.meta["command_line"], "nacre transfer");
    EXPECT_EQ(after.meta["vertices"], 3);
}

TEST(TransferFile, BytesLieWhereTheHeaderSays) {  // what another program relies on
    const std::vector<std::uint8_t> bytes = bytesOf(small());
    EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + 8), "NACRE_TV");
    EXPECT_EQ(bytes[8], 1);
    const std::size_t header = bytes[12] + 256u * bytes[13];
    EXPECT_EQ(bytes.size(), 16 + header + 4 * 4 + 12 + 2 * 3 * (12 + 16));
    float lastPosition[3];
    std::memcpy(lastPosition, &bytes[bytes.size() - 12 * 4 - 12], sizeof(lastPosition));
    EXPECT_EQ(lastPosition[0], 2.0f);
    EXPECT_EQ(lastPosition[1], 1.0f);
}

TEST(TransferFile, EveryCutIsRefused) {
    const std::vector<std::uint8_t> bytes = bytesOf(small());
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_THAT(refused({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}), HasSubstr("a.bin: "))
            << size;
    std::vector<std::uint8_t> longer = bytes;
    longer.push_back(0);
    EXPECT_THAT(refused(longer), HasSubstr("bytes behind the header"));
}

TEST(TransferFile, WrongHeadersNameWhatWasExpected) {
    const std::vector<std::uint8_t> bytes = bytesOf(small());
    EXPECT_THAT(refused(with(bytes, "NACRE_TV", "nacre_tv")), HasSubstr("begins with NACRE_TV"));
    EXPECT_THAT(refused(with(bytes, std::string("NACRE_TV\1", 9), "NACRE_TV\2")),
                HasSubstr("expected version 1, found 2"));
    EXPECT_THAT(refused(with(bytes, "\"order\": 1", "\"order\": 9")), HasSubstr("/order"));
    EXPECT_THAT(refused(with(bytes, "\"order\": 1", "\"order\": 0")), HasSubstr("bytes behind the header"));
    EXPECT_THAT(refused(with(bytes, "\"blocks\": 2", "\"blocks\": 0")), HasSubstr("bytes behind the header"));
    EXPECT_THAT(refused(with(bytes, "\"vertices\": 3", "\"vertixes\": 3")), HasSubstr("vertices"));
    EXPECT_THAT(refused(with(bytes, "\"frames_per_second\": 24", "\"frames_per_second\": -4")),
                HasSubstr("/frames_per_second"));
    EXPECT_THAT(refused(with(bytes, "  6\n", "  4\n")), HasSubstr("ascending frame numbers"));
    EXPECT_THAT(refused(with(bytes, "  1\n", "  5\n")), HasSubstr("expected blocks 0 to 1, found 5 for frame 6"));
    EXPECT_THAT(refused(with(bytes, "  1\n", "  0\n")), HasSubstr("found none for block 1"));
}

TEST(TransferFile, CountsBeyondAnyMemoryAreRefusedByTheSize) {
    TransferRecording roomy = small();
    roomy.meta["vertices!"] = 10;  // sorted behind "vertices": its line is room for a longer number
    const std::vector<std::uint8_t> bytes =
        with(bytesOf(roomy), "\"vertices\": 3,\n \"vertices!\": 10", "\"vertices\": 2147483647         ");
    EXPECT_THAT(refused(bytes), HasSubstr("bytes behind the header"));
}

TEST(TransferFile, WrongNumbersNameTheirPlace) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::vector<std::uint8_t> bytes = bytesOf(small());
    std::memcpy(&bytes[bytes.size() - 4], &nan, 4);
    EXPECT_THAT(refused(bytes), HasSubstr("expected finite coefficients, found nan in block 1"));
    bytes = bytesOf(small());
    std::memcpy(&bytes[bytes.size() - 12 * 4 - 4], &nan, 4);
    EXPECT_THAT(refused(bytes), HasSubstr("expected finite positions, found another at vertex 2 of block 1"));
    bytes = bytesOf(small());
    bytes[bytes.size() - 2 * 3 * 28 - 4] = 7;  // the triangle's last corner
    EXPECT_THAT(refused(bytes), HasSubstr("expected vertices below 3, found 7 in triangle 0"));
    bytes = bytesOf(small());
    bytes[bytes.size() - 2 * 3 * 28 - 12 - 4] = 8;
    EXPECT_THAT(refused(bytes), HasSubstr("found 8 for source vertex 3"));
}

TEST(TransferFile, WriterRefusesWhatTheReaderWould) {
    const Scratch scratch;
    TransferRecording ragged = small(), still = small(), none = small();
    ragged.blocks[1].coefficients.pop_back();
    still.framesPerSecond = 0;
    none.blocks.clear();
    for (const TransferRecording* r : {&ragged, &still, &none})
        EXPECT_THROW(writeTransfer(*r, scratch / "a"), std::invalid_argument);
    EXPECT_THROW(writeTransfer(small(), scratch / "no" / "a"), Error);
    EXPECT_EQ(scratch.fileCount(), 0u);
    EXPECT_FALSE(isTransferFile(scratch / "a"));
}

}  // namespace
}  // namespace nacre
