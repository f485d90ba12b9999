// The asset of kind bump: what goes in comes back, and what a file lacks or holds wrongly is named.
#include "bump/bump_asset.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "tests/core/scratch.hpp"

namespace nacre {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using tests::messageOf;
using tests::Scratch;

constexpr int kWidth = 6, kHeight = 3;

Image filled(int channels, float first) {
    Image out(kWidth, kHeight, channels);
    for (std::size_t i = 0; i < out.data().size(); ++i) out.data()[i] = first + static_cast<float>(i % 7) / 8;
    return out;
}

/// Every technique; numbers that half floats hold.
BumpMaps everything() {
    HeightMap map{filled(1, -3), Wrap::Mirror};
    map.heights.at(4, 1, 0) = std::nanf("");
    BumpMaps maps;
    maps.width = kWidth;
    maps.height = kHeight;
    maps.wrap = map.wrap;
    maps.normals = makeNormals(map, {.roughness = true});
    maps.horizons = HorizonMap{};
    for (int k = 0; k < 6; ++k) maps.horizons->elevation.push_back(filled(1, static_cast<float>(k) / 16));
    maps.ellipses = EllipseMap{filled(3, -1), filled(3, 0)};
    maps.scatter = ScatterMap{{Vec3(0, 0, 1), Vec3(0.6, 0, 0.8), Vec3(0, -0.6, -0.8)}, {1, 2, 3.5}, {}};
    for (int k = 0; k < 3; ++k) maps.scatter->distance.push_back(filled(1, 1));
    maps.scatter->distance[1].at(2, 2, 0) = -1;
    maps.heights = map.heights;
    return maps;
}

TEST(BumpAsset, WhatGoesInComesBackFromTheFile) {
    const Scratch scratch;
    const BumpMaps maps = everything();
    writeAsset(toAsset(maps), scratch / "a.exr");
    const Asset asset = readAsset(scratch / "a.exr");
    EXPECT_EQ(asset.kind, "bump");
    for (const AssetTexture& t : asset.textures) EXPECT_EQ(t.mapping, "uv");
    EXPECT_EQ(asset.texture("horizon1").image.channels(), 2) << "azimuths 4 and 5";
    EXPECT_EQ(asset.texture("height0").format, TexelFormat::Float);
    const BumpMaps back = bumpFromAsset(asset, "a.exr");
    EXPECT_EQ(back.wrap, Wrap::Mirror);
    ASSERT_EQ(back.horizons->azimuths(), 6);
    for (std::size_t k = 0; k < 6; ++k)
        EXPECT_EQ(back.horizons->elevation[k].data(), maps.horizons->elevation[k].data());
    EXPECT_EQ(back.ellipses->shape.data(), maps.ellipses->shape.data());
    EXPECT_EQ(back.ellipses->offset.data(), maps.ellipses->offset.data());
    EXPECT_EQ(back.scatter->directions, maps.scatter->directions);
    EXPECT_EQ(back.scatter->weights, maps.scatter->weights);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(back.scatter->distance[k].data(), maps.scatter->distance[k].data());
    ASSERT_EQ(back.normals->levels.size(), maps.normals->levels.size());
    EXPECT_NEAR(back.normals->levels[1].at(1, 0, 3), maps.normals->levels[1].at(1, 0, 3), 1e-3);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            EXPECT_TRUE(x == 4 && y == 1 ? std::isnan(back.heights->at(x, y, 0))
                                         : back.heights->at(x, y, 0) == maps.heights->at(x, y, 0));
}

TEST(BumpAsset, EveryFormatAndEveryTechniqueAlone) {
    for (const TexelFormat format : {TexelFormat::Half, TexelFormat::Float, TexelFormat::Unorm8}) {
        BumpMaps maps = everything();
        if (format == TexelFormat::Unorm8) {
            EXPECT_THROW(toAsset(maps, format), std::invalid_argument) << "misses would blur";
            maps.scatter.reset();
        }
        const BumpMaps back = bumpFromAsset(toAsset(maps, format), "a");
        EXPECT_NEAR(back.horizons->elevation[5].at(3, 2, 0), maps.horizons->elevation[5].at(3, 2, 0), 1 / 255.0);
        EXPECT_NEAR(back.ellipses->shape.at(1, 1, 2), maps.ellipses->shape.at(1, 1, 2), 1 / 255.0);
    }
    BumpMaps none;
    none.width = none.height = 3;
    EXPECT_THROW(toAsset(none), std::invalid_argument);
    BumpMaps one = none;
    one.normals = makeNormals({Image(3, 3, 1)});
    EXPECT_FALSE(bumpFromAsset(toAsset(one), "a").ellipses);
    one.horizons = HorizonMap{{Image(3, 4, 1)}};
    EXPECT_THROW(toAsset(one), std::invalid_argument) << "another size";
}

TEST(BumpAsset, WhatAReaderWouldRefuseIsNotWritten) {
    BumpMaps maps = everything();
    maps.horizons->elevation.resize(700, filled(1, 0));
    EXPECT_THAT(messageOf<StorageError>([&] { toAsset(maps); }), HasSubstr("160 textures"));
    maps = everything();
    maps.ellipses->shape.at(5, 0, 1) = 1e6f;
    EXPECT_THAT(messageOf<StorageError>([&] { toAsset(maps); }), AllOf(HasSubstr("ellipse0"), HasSubstr("(5, 0)")));
}

/// The message about an asset that `change` has broken.
template <typename Change>
std::string refused(Change&& change) {
    Asset asset = toAsset(everything());
    change(asset);
    return messageOf<Error>([&] { bumpFromAsset(asset, "a.exr"); });
}

AssetTexture& part(Asset& asset, const std::string& name) {
    for (AssetTexture& t : asset.textures)
        if (t.name == name) return t;
    throw std::logic_error(name);
}

TEST(BumpAsset, BrokenAssetsAreNamedWithPartExpectedAndFound) {
    EXPECT_THAT(refused([](Asset& a) { a.kind = "brdf"; }), HasSubstr("a.exr: expected an asset of kind bump"));
    EXPECT_THAT(refused([](Asset& a) { a.meta.erase("wrap"); }), HasSubstr("'wrap'"));
    EXPECT_THAT(refused([](Asset& a) { a.meta["wrap"] = "tile"; }), AllOf(HasSubstr("tile"), HasSubstr("mirror")));
    EXPECT_THAT(refused([](Asset& a) { a.meta["surface"] = "triangles"; }), HasSubstr("bilinear"));
    EXPECT_THAT(refused([](Asset& a) { a.meta["size"] = {6}; }), HasSubstr("size"));
    EXPECT_THAT(refused([](Asset& a) { a.meta["size"] = {7, 3}; }), AllOf(HasSubstr("normal0"), HasSubstr("7 x 3")));
    EXPECT_THAT(refused([](Asset& a) { a.meta["azimuths"] = 9; }), HasSubstr("horizon1"));
    EXPECT_THAT(refused([](Asset& a) { a.meta["azimuths"] = 1e9; }), HasSubstr("1 to 256"));
    EXPECT_THAT(refused([](Asset& a) { a.meta["normal_levels"] = 9; }), HasSubstr("normal3"));
    EXPECT_THAT(refused([](Asset& a) { a.meta["directions"][1] = {1, 2, 3}; }), HasSubstr("length 1"));
    EXPECT_THAT(refused([](Asset& a) { a.meta["weights"] = {1}; }), HasSubstr("3 and 1"));
    EXPECT_THAT(refused([](Asset& a) { part(a, "ellipse1").name = "x"; }),
                AllOf(HasSubstr("part ellipse1"), HasSubstr("found none")));
    EXPECT_THAT(refused([](Asset& a) { part(a, "ellipse0").mapping = "cube"; }), HasSubstr("mapping uv, found cube"));
    EXPECT_THAT(refused([](Asset& a) { part(a, "scatter0").image.at(0, 0, 0) = -0.5f; }), HasSubstr("-0.5"));
    EXPECT_THAT(refused([](Asset& a) { part(a, "normal0").image.at(1, 0, 0) = 3; }),
                AllOf(HasSubstr("part normal0"), HasSubstr("(1, 0)")));
    EXPECT_THAT(refused([](Asset& a) { part(a, "horizon0").scale = glm::vec4(INFINITY); }), HasSubstr("finite"));
    EXPECT_THAT(refused([](Asset& a) {
                    a.textures.resize(1);
                    a.textures[0].name = "other";
                }),
                HasSubstr("normal0, horizon0"));
}

}  // namespace
}  // namespace nacre
