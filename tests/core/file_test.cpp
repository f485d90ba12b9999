// Bounded reads, writes that are complete or absent, and the hash that names sources.
#include "core/file.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>

#include "core/error.hpp"
#include "tests/core/scratch.hpp"

namespace nacre {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using tests::messageOf;
using tests::Scratch;

std::string contents(const std::filesystem::path& path) {
    const auto bytes = readFile(path, 1 << 20);
    return {bytes.begin(), bytes.end()};
}

TEST(File, WriteThenReadBack) {
    const Scratch scratch;
    writeFile(scratch / "a", std::string("one\0two\n", 8));
    EXPECT_EQ(contents(scratch / "a"), std::string("one\0two\n", 8));
    writeFile(scratch / "a", "");
    EXPECT_EQ(contents(scratch / "a"), "") << "replaced, and empty files are files";
    EXPECT_EQ(scratch.fileCount(), 1u);
}

TEST(File, LimitIsCheckedBeforeReading) {
    const Scratch scratch;
    writeFile(scratch / "a", "12345");
    EXPECT_NO_THROW(readFile(scratch / "a", 5));
    EXPECT_THAT(messageOf<Error>([&] { readFile(scratch / "a", 4); }), HasSubstr("at most 4 bytes, found 5"));
}

TEST(File, MissingFoldersAndDevices) {
    const Scratch scratch;
    EXPECT_THAT(messageOf<Error>([&] { readFile(scratch / "none", 9); }), HasSubstr("found none"));
    EXPECT_THAT(messageOf<Error>([&] { readFile(scratch.folder(), 9); }), HasSubstr("folder or device"));
    EXPECT_THAT(messageOf<Error>([&] { readFile("/dev/zero", 9); }), HasSubstr("folder or device"));
    EXPECT_THAT(messageOf<Error>([&] { writeFile(scratch.folder(), "x"); }), HasSubstr("folder or device"));
}

TEST(File, FailedWriterLeavesNothing) {
    const Scratch scratch;
    const auto failing = [](const std::filesystem::path& temporary) {
        std::ofstream(temporary) << "half";
        throw std::runtime_error("no more ink");
    };
    EXPECT_THAT(messageOf<Error>([&] { writeThenRename(scratch / "a", failing); }),
                AllOf(HasSubstr((scratch / "a").string()), HasSubstr("no more ink")));
    EXPECT_EQ(scratch.fileCount(), 0u);
}

TEST(File, TemporaryIsInTheSameFolder) {  // else the rename could cross file systems and be no rename
    const Scratch scratch;
    writeThenRename(scratch / "a", [&](const std::filesystem::path& temporary) {
        EXPECT_EQ(temporary.parent_path(), scratch.folder());
        EXPECT_NE(temporary, scratch / "a");
        std::ofstream(temporary) << "x";
    });
    EXPECT_EQ(contents(scratch / "a"), "x");
}

TEST(File, UnwritableFolder) {
    const Scratch scratch;
    std::filesystem::permissions(scratch.folder(),
                                 std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    const bool isRoot = ::geteuid() == 0;  // root may write anywhere: be somebody else for a moment
    if (isRoot) {
        ASSERT_EQ(::seteuid(65534), 0);
    }
    const std::string message = messageOf<Error>([&] { writeFile(scratch / "a", "x"); });
    if (isRoot) {
        ASSERT_EQ(::seteuid(0), 0);
    }
    EXPECT_THAT(message, AllOf(HasSubstr((scratch / "a").string()), HasSubstr("Permission denied")));
}

TEST(File, WriterThatMakesNoFile) {
    const Scratch scratch;
    EXPECT_THROW(writeThenRename(scratch / "a", [](const std::filesystem::path&) {}), Error);
}

TEST(ContentHash, KnownValues) {  // FNV-1a test vectors: empty, "a", "foobar"
    EXPECT_EQ(contentHash(""), "cbf29ce484222325");
    EXPECT_EQ(contentHash("a"), "af63dc4c8601ec8c");
    EXPECT_EQ(contentHash("foobar"), "85944171f73967e8");
}

TEST(FileHash, IsTheContents) {
    const tests::Scratch scratch;
    std::string text(3 << 20, 'x');  // several blocks
    text.back() = 'y';
    for (const std::string& content : {std::string(), std::string("foobar"), text}) {
        writeFile(scratch / "f", content);
        EXPECT_EQ(fileHash(scratch / "f"), contentHash(content));
    }
    EXPECT_THROW(fileHash(scratch / "gone"), Error);
    EXPECT_THROW(fileHash(scratch.folder()), Error);
}

}  // namespace
}  // namespace nacre
