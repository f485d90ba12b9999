// Asset files that are broken, each in one way: the reader refuses them with nacre::Error, one line that names the
// file, the part, what was expected and what was found.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputFile.h>
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <functional>
#include <limits>

#include "core/asset.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "tests/core/scratch.hpp"

namespace nacre {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using tests::messageOf;
using tests::Scratch;

/// A 3×2 RGB float part named T and the JSON that goes with it; both may be broken before writing.
struct RawFile {
    Imf::Header header{3, 2};
    json meta = {{"kind", "brdf"},
                 {"version", 1},
                 {"textures",
                  {{{"name", "T"},
                    {"mapping", "half_diff"},
                    {"width", 3},
                    {"height", 2},
                    {"channels", 3},
                    {"format", "float"},
                    {"scale", {1, 1, 1, 1}},
                    {"bias", {0, 0, 0, 0}}}}}};
    std::string text;  ///< instead of meta when not empty
    std::vector<float> texels = std::vector<float>(18, 0.5f);
    bool attribute = true;

    RawFile() {
        header.setName("T");
        header.setType(Imf::SCANLINEIMAGE);
        for (const char* c : {"R", "G", "B"}) header.channels().insert(c, Imf::Channel(Imf::FLOAT));
    }
    json& entry() { return meta["textures"][0]; }

    void write(const std::filesystem::path& path) {
        if (attribute) header.insert("nacre", Imf::StringAttribute(text.empty() ? meta.dump() : text));
        Imf::MultiPartOutputFile file(path.c_str(), &header, 1);
        Imf::FrameBuffer frame;
        char* base = reinterpret_cast<char*>(texels.data());
        for (const char* c : {"R", "G", "B"}) {
            frame.insert(c, Imf::Slice(Imf::FLOAT, base, 12, 36));
            base += sizeof(float);
        }
        Imf::OutputPart part(file, 0);
        part.setFrameBuffer(frame);
        part.writePixels(header.dataWindow().max.y + 1);
    }
};

/// The message of readAsset for a file with one thing broken; it must be one line that starts with the path.
std::string complaint(const std::function<void(RawFile&)>& breakIt) {
    const Scratch scratch;
    RawFile raw;
    breakIt(raw);
    raw.write(scratch / "a.exr");
    const std::string message = messageOf<Error>([&] { readAsset(scratch / "a.exr"); });
    EXPECT_THAT(message, AllOf(::testing::StartsWith((scratch / "a.exr").string()), Not(HasSubstr("\n"))));
    return message;
}

TEST(BrokenAsset, TheUnbrokenFileIsRead) {
    const Scratch scratch;
    RawFile().write(scratch / "a.exr");
    EXPECT_EQ(readAsset(scratch / "a.exr").texture("T").image.data(), std::vector<float>(18, 0.5f));
}

TEST(BrokenAsset, ExrThatIsNoNacreAsset) {
    EXPECT_THAT(complaint([](RawFile& f) { f.attribute = false; }), HasSubstr("an EXR that is no nacre asset"));
}

TEST(BrokenAsset, WrongVersion) {
    EXPECT_THAT(complaint([](RawFile& f) { f.meta["version"] = 7; }), HasSubstr("expected format version 1, found 7"));
    EXPECT_THAT(complaint([](RawFile& f) { f.meta.erase("version"); }), HasSubstr("'version'"));
    EXPECT_THAT(complaint([](RawFile& f) { f.meta["version"] = "1"; }), HasSubstr("found \"1\""));
}

TEST(BrokenAsset, AttributeThatIsNoJsonObject) {
    EXPECT_THAT(complaint([](RawFile& f) { f.text = "{\"kind\": \n"; }), HasSubstr("expected JSON"));
    EXPECT_THAT(complaint([](RawFile& f) { f.text = "[1, 2]"; }), HasSubstr("found array"));
    EXPECT_THAT(complaint([](RawFile& f) {
                    f.text = "{\"kind\":" + std::string(100000, '[') + std::string(100000, ']') + "}";
                }),
                HasSubstr("deeper nesting"));
}

TEST(BrokenAsset, TableThatDoesNotMatchTheParts) {
    EXPECT_THAT(complaint([](RawFile& f) { f.meta.erase("textures"); }), HasSubstr("'textures'"));
    EXPECT_THAT(complaint([](RawFile& f) { f.meta["textures"].push_back(f.entry()); }), HasSubstr("size 2"));
    EXPECT_THAT(complaint([](RawFile& f) { f.entry()["name"] = "U"; }),
                HasSubstr("part U: expected a part of that name, found 'T'"));
    EXPECT_THAT(complaint([](RawFile& f) { f.entry()["width"] = 4; }),
                HasSubstr("part T: expected data window (0, 0)-(3, 1), found (0, 0)-(2, 1)"));
    EXPECT_THAT(complaint([](RawFile& f) { f.entry()["channels"] = 1; }), HasSubstr("channels Y:float"));
    EXPECT_THAT(complaint([](RawFile& f) { f.entry()["format"] = "half"; }),
                HasSubstr("expected channels B:half G:half R:half, found channels B:float"));
    EXPECT_THAT(complaint([](RawFile& f) { f.entry()["format"] = "bc6"; }), HasSubstr("found bc6"));
    EXPECT_THAT(complaint([](RawFile& f) { f.entry().erase("mapping"); }), HasSubstr("'mapping'"));
    EXPECT_THAT(complaint([](RawFile& f) { f.entry()["scale"] = {1, 1}; }), HasSubstr("four finite numbers 'scale'"));
    EXPECT_THAT(complaint([](RawFile& f) { f.entry()["bias"] = {1, 1, 1e300, 0}; }), HasSubstr("'bias'"));
}

TEST(BrokenAsset, SizesOutOfRange) {
    EXPECT_THAT(complaint([](RawFile& f) { f.entry()["width"] = 16385; }), HasSubstr("width 1 to 16384, found 16385"));
    EXPECT_THAT(complaint([](RawFile& f) { f.entry()["height"] = 0; }), HasSubstr("height 1 to 16384, found 0"));
    EXPECT_THAT(complaint([](RawFile& f) { f.entry()["channels"] = 5; }), HasSubstr("channels 1 to 4, found 5"));
    EXPECT_THAT(complaint([](RawFile& f) {
                    f.entry()["width"] = 16384;
                    f.entry()["height"] = 16384;
                }),
                HasSubstr("values in a file of"));
}

TEST(BrokenAsset, OversizedDataWindow) {  // the header claims 2^20 columns, the table 3
    EXPECT_THAT(complaint([](RawFile& f) {
                    f.header.dataWindow().max.x = 1 << 20;
                    f.texels.resize(3 * (std::size_t{1} << 20) + 64);
                }),
                HasSubstr("data window"));
}

TEST(BrokenAsset, NonFiniteTexelsNameTheTexel) {
    EXPECT_THAT(complaint([](RawFile& f) { f.texels[10] = std::numeric_limits<float>::quiet_NaN(); }),
                HasSubstr("part T: expected finite values, found nan at texel (0, 1)"));
    EXPECT_THAT(complaint([](RawFile& f) { f.texels[2] = -std::numeric_limits<float>::infinity(); }),
                HasSubstr("found -inf at texel (0, 0)"));
}

TEST(BrokenAsset, TruncatedAnywhere) {
    const Scratch scratch;
    RawFile raw;
    raw.texels = std::vector<float>(18);
    for (std::size_t i = 0; i < 18; ++i) raw.texels[i] = 1.0f / static_cast<float>(i + 3);
    raw.write(scratch / "whole.exr");
    const auto bytes = readFile(scratch / "whole.exr", 1 << 20);
    for (std::ptrdiff_t size = 0; size < std::ssize(bytes); ++size) {
        std::ofstream(scratch / "a.exr", std::ios::binary) << std::string(bytes.begin(), bytes.begin() + size);
        EXPECT_THAT(messageOf<Error>([&] { readAsset(scratch / "a.exr"); }),
                    AllOf(HasSubstr("a.exr: "), HasSubstr("expected "), Not(HasSubstr("\"file\"")),
                          HasSubstr(size < 8 ? "found a file of " + std::to_string(size) + " bytes"
                                             : "it is cut short or corrupt")))
            << "cut at byte " << size << " of " << bytes.size();
    }
}

TEST(BrokenAsset, FlippedBytesNeverDoMoreThanThrow) {  // the fuzzer's little sister: every byte, two values
    const Scratch scratch;
    RawFile().write(scratch / "whole.exr");
    const auto bytes = readFile(scratch / "whole.exr", 1 << 20);
    for (std::size_t at = 0; at < bytes.size(); ++at)
        for (const std::uint8_t value : {std::uint8_t{0xff}, static_cast<std::uint8_t>(bytes[at] ^ 1u)}) {
            std::string broken(bytes.begin(), bytes.end());
            broken[at] = static_cast<char>(value);
            std::ofstream(scratch / "a.exr", std::ios::binary) << broken;
            try {
                readAsset(scratch / "a.exr");
            } catch (const Error&) {
            }
        }
}

TEST(BrokenAsset, CorruptPixelsReadAsOneLine) {  // OpenEXR's own words, without the name it knows no file by
    const Scratch scratch;
    RawFile raw;
    raw.texels.assign(18, 0.25f);
    raw.write(scratch / "whole.exr");
    const auto whole = readFile(scratch / "whole.exr", 1 << 20);
    std::string bytes(whole.begin(), whole.end());
    bytes[bytes.size() - 6] ^= 0x55;  // within the last chunk's zip stream
    writeFile(scratch / "a.exr", bytes);
    EXPECT_THAT(messageOf<Error>([&] { readAsset(scratch / "a.exr"); }),
                AllOf(HasSubstr("part T: expected complete pixel data, found it corrupt: "), Not(HasSubstr("\n")),
                      Not(HasSubstr("\"file\""))));
}

TEST(BrokenAsset, JsonThatEndsEarlyNamesTheByte) {
    EXPECT_THAT(complaint([](RawFile& f) { f.text = "{\"kind\": \"brdf\", oh}"; }),
                HasSubstr("expected JSON in attribute 'nacre', found none from its byte 18 on"));
}

TEST(BrokenAsset, AttributeLargerThanTheFile) {  // found by fuzzing: OpenEXR made room for it first
    const Scratch scratch;
    RawFile().write(scratch / "a.exr");
    const auto whole = readFile(scratch / "a.exr", 1 << 20);
    std::string bytes(whole.begin(), whole.end());
    const std::size_t size = bytes.find(std::string("nacre\0string\0", 13)) + 13;
    bytes.replace(size, 4, std::string("\x00\x00\x00\x60", 4));
    std::ofstream(scratch / "a.exr", std::ios::binary) << bytes;
    EXPECT_THAT(messageOf<Error>([&] { readAsset(scratch / "a.exr"); }),
                HasSubstr("attribute 'nacre' of 1610612736 bytes with"));
}

TEST(BrokenAsset, NoExrAtAll) {
    const Scratch scratch;
    writeFile(scratch / "a.exr", "P6 2 2 255 and so on");
    EXPECT_THAT(
        messageOf<Error>([&] { readAsset(scratch / "a.exr"); }),
        HasSubstr("expected an OpenEXR file, found a file that starts with bytes 50 36 20 32, not 76 2f 31 01"));
    EXPECT_THAT(messageOf<Error>([&] { readAsset(scratch / "none.exr"); }), HasSubstr("expected a file, found none"));
    EXPECT_THAT(messageOf<Error>([&] { readAsset(scratch.folder()); }), HasSubstr("found a folder or device"));
}

TEST(BrokenAsset, TiledFileIsRefused) {
    const Scratch scratch;
    RawFile raw;
    raw.header.setTileDescription(Imf::TileDescription(8, 8, Imf::ONE_LEVEL));
    raw.header.setType(Imf::TILEDIMAGE);
    raw.header.insert("nacre", Imf::StringAttribute(raw.meta.dump()));
    {
        Imf::TiledOutputFile file((scratch / "a.exr").c_str(), raw.header);
        Imf::FrameBuffer frame;
        for (const char* c : {"R", "G", "B"})
            frame.insert(c, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(raw.texels.data()), 12, 36));
        file.setFrameBuffer(frame);
        file.writeTile(0, 0);
    }
    EXPECT_THAT(messageOf<Error>([&] { readAsset(scratch / "a.exr"); }), HasSubstr("scanlineimage, found tiledimage"));
}

TEST(BrokenAsset, Unorm8ThatIsNoCode) {
    const Scratch scratch;
    Asset asset;
    asset.kind = "brdf";
    Image image(2, 1, 1);
    image.data() = {0.0f, 1.0f};
    asset.textures = {makeTexture("T", "m", image, TexelFormat::Unorm8)};
    for (const float bad : {0.5f, 1.5f, -1.0f / 255}) {
        asset.textures[0].image.data()[1] = bad;
        writeAsset(asset, scratch / "a.exr");
        EXPECT_THAT(messageOf<Error>([&] { readAsset(scratch / "a.exr"); }), HasSubstr("codes k/255")) << bad;
    }
}

Asset bigAsset() {
    Asset asset;
    asset.kind = "brdf";
    Image image(64, 64, 4);
    for (std::size_t i = 0; i < image.data().size(); ++i)
        image.data()[i] = std::sin(static_cast<float>(i) * 12.9898f) * 43758.5453f;
    asset.textures = {makeTexture("T", "m", image, TexelFormat::Float)};
    return asset;
}

TEST(AssetOnFullDisk, DevFullIsRefused) {
    EXPECT_THAT(messageOf<Error>([] { writeAsset(bigAsset(), "/dev/full"); }),
                AllOf(HasSubstr("/dev/full"), HasSubstr("can't write")));
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST(AssetOnFullDisk, WriteThatFailsHalfWayLeavesNothing) {
    const Scratch scratch;
    rlimit before{};
    ::getrlimit(RLIMIT_FSIZE, &before);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    rlimit small = before;
    small.rlim_cur = 4096;
    ::setrlimit(RLIMIT_FSIZE, &small);
    const std::string message = messageOf<Error>([&] { writeAsset(bigAsset(), scratch / "a.exr"); });
    ::setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_THAT(message, AllOf(HasSubstr("a.exr: can't write"), HasSubstr("too large")));
    EXPECT_EQ(scratch.fileCount(), 0u);
}

TEST(AssetOnFullDisk, FailedWriteKeepsTheOldFile) {
    const Scratch scratch;
    writeAsset(bigAsset(), scratch / "a.exr");
    const auto before = readFile(scratch / "a.exr", 1 << 24);
    EXPECT_THROW(writeThenRename(scratch / "a.exr",
                                 [](const std::filesystem::path& temporary) {
                                     std::ofstream(temporary) << "half a file";
                                     throw Error("disk on fire");
                                 }),
                 Error);
    EXPECT_EQ(readFile(scratch / "a.exr", 1 << 24), before);
    EXPECT_EQ(scratch.fileCount(), 1u);
}

TEST(AssetOnFullDisk, FolderThatDoesNotExist) {
    EXPECT_THAT(messageOf<Error>([] { writeAsset(bigAsset(), "/nonexistent/a.exr"); }),
                AllOf(HasSubstr("/nonexistent/a.exr"), HasSubstr("No such file")));
}

}  // namespace
}  // namespace nacre
