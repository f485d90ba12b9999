// The asset file: what is written comes back, and what is no asset is refused in one line that says why.
#include "core/asset.hpp"

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <gmock/gmock.h>
#include <half.h>

#include <fstream>
#include <limits>

#include "core/error.hpp"
#include "core/file.hpp"
#include "tests/core/scratch.hpp"

namespace nacre {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using tests::messageOf;
using tests::Scratch;

Image ramp(int width, int height, int channels, float scale = 1) {
    Image image(width, height, channels);
    for (std::size_t i = 0; i < image.data().size(); ++i)
        image.data()[i] = scale * (0.37f * static_cast<float>(i) - 1.25f);
    return image;
}

Asset sampleAsset() {
    Asset asset;
    asset.kind = "brdf";
    asset.meta["command_line"] = "nacre factorize lambert -o out.exr";
    asset.meta["error"] = {{"l2_rel", 0.0125}, {"reciprocity_residual", nullptr}};
    asset.textures.push_back(makeTexture("T", "half_diff", ramp(5, 3, 4), TexelFormat::Half));
    asset.textures.push_back(makeTexture("B", "elevations", ramp(2, 7, 3, 1e20f), TexelFormat::Float));
    asset.textures.push_back(makeTexture("P", "parabolic", ramp(4, 4, 1), TexelFormat::Unorm8));
    asset.textures.push_back(makeTexture("Q", "parabolic", ramp(1, 1, 2), TexelFormat::Half));
    return asset;
}

void expectSameTextures(const Asset& a, const Asset& b) {
    ASSERT_EQ(a.textures.size(), b.textures.size());
    for (std::size_t i = 0; i < a.textures.size(); ++i) {
        const AssetTexture &x = a.textures[i], &y = b.textures[i];
        EXPECT_EQ(x.name, y.name);
        EXPECT_EQ(x.mapping, y.mapping);
        EXPECT_EQ(x.format, y.format);
        EXPECT_EQ(x.scale, y.scale);
        EXPECT_EQ(x.bias, y.bias);
        EXPECT_EQ(x.image.width(), y.image.width());
        EXPECT_EQ(x.image.height(), y.image.height());
        EXPECT_EQ(x.image.channels(), y.image.channels());
        EXPECT_EQ(x.image.data(), y.image.data()) << x.name;
    }
}

TEST(Asset, RoundTripKeepsEveryBit) {
    const Scratch scratch;
    const Asset asset = sampleAsset();
    writeAsset(asset, scratch / "a.exr");
    const Asset back = readAsset(scratch / "a.exr");
    EXPECT_EQ(back.kind, "brdf");
    expectSameTextures(asset, back);
    EXPECT_EQ(back.meta["command_line"], asset.meta["command_line"]);
    EXPECT_EQ(back.meta["error"], asset.meta["error"]);
    EXPECT_EQ(back.meta["bytes"], 5u * 3 * 4 * 2 + 2 * 7 * 3 * 4 + 4 * 4 + 2 * 2);
    EXPECT_EQ(back.meta["version"], kAssetVersion);
    EXPECT_EQ(back.meta["textures"][2]["format"], "unorm8");
    EXPECT_EQ(scratch.fileCount(), 1u) << "no temporary file stays";
}

TEST(Asset, RewritingWhatWasReadGivesTheSameBytes) {  // no dates, no order that depends on the run
    const Scratch scratch;
    writeAsset(sampleAsset(), scratch / "a.exr");
    writeAsset(readAsset(scratch / "a.exr"), scratch / "b.exr");
    EXPECT_EQ(readFile(scratch / "a.exr", 1 << 20), readFile(scratch / "b.exr", 1 << 20));
}

TEST(Asset, OneTextureMakesAnAssetToo) {
    const Scratch scratch;
    Asset asset = sampleAsset();
    asset.textures.resize(1);
    writeAsset(asset, scratch / "a.exr");
    expectSameTextures(asset, readAsset(scratch / "a.exr"));
}

TEST(Asset, AnyExrReaderSeesPartsAndChannels) {
    const Scratch scratch;
    writeAsset(sampleAsset(), scratch / "a.exr");
    Imf::MultiPartInputFile file((scratch / "a.exr").c_str());
    ASSERT_EQ(file.parts(), 4);
    EXPECT_EQ(file.header(0).name(), "T");
    EXPECT_EQ(file.header(1).channels()["G"].type, Imf::FLOAT);
    EXPECT_EQ(file.header(2).channels()["Y"].type, Imf::HALF);
}

TEST(Asset, HalfRoundsToNearestEven) {
    Image image(3, 1, 1);
    image.data() = {1.0f + 1.0f / 2048, 1.0f + 3.0f / 2048, 1e-8f};  // half-way below, half-way above, underflow
    const AssetTexture texture = makeTexture("T", "m", image, TexelFormat::Half);
    EXPECT_EQ(texture.image.data(), (std::vector<float>{1.0f, 1.0f + 4.0f / 2048, 0.0f}));
}

TEST(Asset, HalfOverflowIsAnErrorThatNamesTheTexel) {
    Image image(3, 2, 2);
    image.at(1, 1, 1) = 65504.0f;
    EXPECT_NO_THROW(makeTexture("T", "m", image, TexelFormat::Half));
    image.at(1, 1, 1) = 65505.0f;
    const auto bake = [&] { makeTexture("T", "m", image, TexelFormat::Half); };
    EXPECT_THAT(messageOf<StorageError>(bake),
                AllOf(HasSubstr("texture T: texel (1, 1) channel 1"), HasSubstr("65504"), HasSubstr("65505")));
    EXPECT_NO_THROW(makeTexture("T", "m", image, TexelFormat::Float));
}

TEST(Asset, NonFiniteValuesAreRefusedInEveryFormat) {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
        for (const auto format : {TexelFormat::Half, TexelFormat::Float, TexelFormat::Unorm8}) {
            Image image(2, 2, 1);
            image.at(0, 1, 0) = bad;
            EXPECT_THROW(makeTexture("T", "m", image, format), StorageError) << bad << toString(format);
        }
}

TEST(Asset, Unorm8CoversEachChannelsRange) {
    Image image(2, 2, 2);
    image.data() = {-3, 7, 5, 7, 1, 7, -1, 7};  // channel 0 in [-3, 5]; channel 1 constant
    const AssetTexture t = makeTexture("T", "m", image, TexelFormat::Unorm8);
    EXPECT_FLOAT_EQ(t.bias[0], -3);
    EXPECT_FLOAT_EQ(t.scale[0], 8);
    constexpr float kHalfStep = 8.0f / 255 / 2 * 1.0001f;  // half a code of the range, plus rounding
    for (std::size_t i = 0; i < 8; i += 2)
        EXPECT_NEAR(t.bias[0] + t.scale[0] * t.image.data()[i], image.data()[i], kHalfStep);
    for (std::size_t i = 1; i < 8; i += 2) EXPECT_EQ(t.bias[1] + t.scale[1] * t.image.data()[i], 7.0f);
    Image wide(2, 1, 1);
    wide.data() = {-3e38f, 3e38f};
    EXPECT_THROW(makeTexture("T", "m", wide, TexelFormat::Unorm8), StorageError);
}

TEST(Asset, AllUnorm8CodesSurviveTheHalfFile) {
    const Scratch scratch;
    Image image(256, 1, 1);
    for (int k = 0; k < 256; ++k) image.at(k, 0, 0) = static_cast<float>(k);
    Asset asset;
    asset.kind = "brdf";
    asset.textures = {makeTexture("T", "m", image, TexelFormat::Unorm8)};
    writeAsset(asset, scratch / "a.exr");
    const Asset back = readAsset(scratch / "a.exr");
    for (int k = 0; k < 256; ++k) EXPECT_EQ(back.textures[0].image.at(k, 0, 0), static_cast<float>(k) / 255.0f) << k;
}

TEST(Asset, FormatNamesAreAPair) {
    for (const auto format : {TexelFormat::Half, TexelFormat::Float, TexelFormat::Unorm8})
        EXPECT_EQ(texelFormatFromString(toString(format)), format);
    EXPECT_THAT(messageOf<std::invalid_argument>([] { texelFormatFromString("bfloat"); }),
                AllOf(HasSubstr("bfloat"), HasSubstr("half, float or unorm8")));
}

TEST(Asset, UnknownTextureNameListsTheKnown) {
    EXPECT_THAT(messageOf<Error>([] { sampleAsset().texture("Z"); }), AllOf(HasSubstr("'Z'"), HasSubstr("T, B, P, Q")));
    EXPECT_EQ(sampleAsset().texture("B").image.height(), 7);
}

TEST(Asset, WriterRefusesWhatReadersWouldRefuse) {
    const Scratch scratch;
    const auto refused = [&](const std::function<void(Asset&)>& change) {
        Asset asset = sampleAsset();
        change(asset);
        EXPECT_THROW(writeAsset(asset, scratch / "a.exr"), std::invalid_argument);
    };
    refused([](Asset& a) { a.textures.clear(); });
    refused([](Asset& a) { a.textures[1].name = "T"; });
    refused([](Asset& a) { a.textures[0].name = ""; });
    refused([](Asset& a) { a.kind = ""; });
    refused([](Asset& a) { a.textures[1].image.at(0, 0, 0) = std::numeric_limits<float>::quiet_NaN(); });
    refused([](Asset& a) { a.textures[0].scale.x = std::numeric_limits<float>::infinity(); });
    EXPECT_EQ(scratch.fileCount(), 0u);
}

TEST(Asset, CommandLineWithBytesThatAreNoUtf8) {
    const Scratch scratch;
    Asset asset = sampleAsset();
    asset.meta["command_line"] = "nacre \xff\xfe";
    writeAsset(asset, scratch / "a.exr");
    EXPECT_EQ(readAsset(scratch / "a.exr").meta["command_line"], "nacre \xef\xbf\xbd\xef\xbf\xbd");
}

}  // namespace
}  // namespace nacre
