// Every layout of a file gives the same surrounding; what is no map is refused with what was expected and found.
#include "envmaps/source.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "core/file.hpp"
#include "envmaps/convert.hpp"
#include "envmaps/env_asset.hpp"
#include "envmaps/probe.hpp"
#include "tests/core/exr_files.hpp"
#include "tests/core/scratch.hpp"

namespace nacre {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using tests::messageOf;
using tests::Scratch;
using tests::writeExr;

/// The surrounding of these tests: smooth, different in every direction.
Rgb sky(const Vec3& direction) {
    const Vec3 d = glm::normalize(direction);
    return Rgb(1.5 + d.x, 1.5 + d.y, 1.5 + d.z);
}

/// An image whose texel (x, y) holds the sky in direction(x, y).
template <typename F>
Image pictureOf(int width, int height, F&& direction) {
    Image image(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image.setRgb(x, y, sky(direction(x, y)));
    return image;
}

Image pictureOf(EnvLayout layout, int size) {
    const glm::ivec2 extent = envExtent(layout, size);
    return pictureOf(extent.x, extent.y, [&](int x, int y) { return envTexelDirection(layout, size, x, y); });
}

ImageFile fileOf(Image image) {
    ImageFile file;
    file.image = std::move(image);
    return file;
}

SourceOptions named(SourceLayout layout, const std::string& faces = "auto") {
    SourceOptions options;
    options.layout = layout;
    options.faces = faces;
    return options;
}

/// Mean difference to the sky at the map's texel centres.
double differenceToSky(const EnvMap& map, const Mat3& toSky = Mat3(1)) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < map.image.height(); ++y)
        for (int x = 0; x < map.image.width(); ++x, ++count)
            sum += glm::length(map.image.rgb(x, y) - sky(toSky * envTexelDirection(map.layout, map.size(), x, y)));
    return sum / count;
}

std::string refused(Image image, SourceLayout layout = SourceLayout::Auto) {
    return messageOf<Error>([&] { environmentFromImage(fileOf(std::move(image)), "a.exr", named(layout)); });
}

/// Faces of `size` in the cells of a cross, by the direction each cell's texel shows: right, down, ahead of a viewer at
/// the middle cell who looks along `ahead`. Written without cube_layouts.hpp's tables.
Image crossOf(int size, bool vertical, const Vec3& ahead, const Vec3& right) {
    const int columns = vertical ? 3 : 4, rows = vertical ? 4 : 3;
    const Vec3 up(0, 1, 0);
    return pictureOf(columns * size, rows * size, [&](int x, int y) {
        const int column = x / size, row = y / size;
        const double s = (2 * (x % size) + 1.0) / size - 1, t = (2 * (y % size) + 1.0) / size - 1;
        if (row == 0) return up + right * s + ahead * t;   // folds up from the middle
        if (row == 2) return -up + right * s - ahead * t;  // folds down
        if (row == 3) return -ahead + right * s + up * t;  // behind, reached below: upside down
        if (column == 0) return -right + ahead * s - up * t;
        if (column == 2) return right - ahead * s - up * t;
        if (column == 3) return -ahead - right * s - up * t;
        return ahead + right * s - up * t;
    });
}

constexpr double kExact = 1e-6;

TEST(Source, OwnLayoutsComeInAsTheyAre) {
    const std::pair<EnvLayout, SourceLayout> pairs[] = {{EnvLayout::LatLong, SourceLayout::LatLong},
                                                        {EnvLayout::Cube, SourceLayout::CubeStrip},
                                                        {EnvLayout::DualParaboloid, SourceLayout::DualParaboloid},
                                                        {EnvLayout::Octahedral, SourceLayout::Octahedral}};
    for (const auto& [layout, source] : pairs) {
        const Environment in = environmentFromImage(fileOf(pictureOf(layout, 8)), "a.exr", named(source));
        EXPECT_EQ(in.map.layout, layout);
        EXPECT_LT(differenceToSky(in.map), kExact) << toString(layout);
        EXPECT_EQ(in.report.texels.negative + in.report.texels.nonFinite, 0u);
    }
}

TEST(Source, CrossesAreSeenFromInside) {
    for (const int size : {1, 4, 5})
        for (const bool vertical : {false, true}) {
            const SourceLayout layout = vertical ? SourceLayout::CubeVerticalCross : SourceLayout::CubeHorizontalCross;
            // OpenEXR's hand: ahead is −z when right is +x.
            const Environment in =
                environmentFromImage(fileOf(crossOf(size, vertical, {0, 0, -1}, {1, 0, 0})), "a.exr");
            EXPECT_EQ(in.report.layout, layout);
            EXPECT_LT(differenceToSky(in.map), kExact) << size << vertical;
            // OpenGL's: ahead is +z.
            const Environment gl = environmentFromImage(fileOf(crossOf(size, vertical, {0, 0, 1}, {1, 0, 0})), "a.exr",
                                                        named(SourceLayout::Auto, "gl"));
            EXPECT_LT(differenceToSky(gl.map), kExact) << size << vertical;
        }
}

/// A strip in OpenGL's orientation, by its table 8.19.
Image glStrip(int size) {
    return pictureOf(size, 6 * size, [&](int x, int y) {
        const double s = (2 * x + 1.0) / size - 1, t = (2 * (y % size) + 1.0) / size - 1;
        const Vec3 table[] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t}, {s, -1, -t}, {s, -t, 1}, {-s, -t, -1}};
        return table[y / size];
    });
}

TEST(Source, OrientationOfFacesIsFoundByTheirSeams) {
    const Environment gl = environmentFromImage(fileOf(glStrip(8)), "a.exr");
    EXPECT_EQ(gl.report.faces, "gl");
    EXPECT_LT(gl.report.seamsGl, gl.report.seamsOpenExr);
    EXPECT_LT(differenceToSky(gl.map), kExact);
    const Environment exr = environmentFromImage(fileOf(pictureOf(EnvLayout::Cube, 8)), "a.exr");
    EXPECT_EQ(exr.report.faces, "openexr");
    Image constant(4, 24, 3);
    for (float& v : constant.data()) v = 1;
    EXPECT_EQ(environmentFromImage(fileOf(constant), "a.exr").report.faces, "openexr");
    ImageFile stated = fileOf(glStrip(8));
    stated.envmap = "cube";
    EXPECT_EQ(environmentFromImage(stated, "a.exr").report.faces, "openexr") << "the attribute says so";
}

TEST(Source, RowOfFaces) {
    const Image strip = pictureOf(EnvLayout::Cube, 5);
    Image row(30, 5, 3);
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 30; ++x) row.setRgb(x, y, strip.rgb(x % 5, x / 5 * 5 + y));
    const Environment in = environmentFromImage(fileOf(row), "a.exr");
    EXPECT_EQ(in.report.layout, SourceLayout::CubeRow);
    EXPECT_LT(differenceToSky(in.map), kExact);
}

TEST(Source, ProbesHaveTheirFormulas) {
    for (const ProbeKind kind : {ProbeKind::Angular, ProbeKind::MirrorBall}) {
        const int size = 128;
        const Image probe = pictureOf(size, size, [&](int x, int y) {
            const double u = (2 * x + 1.0) / size - 1, v = 1 - (2 * y + 1.0) / size;
            return std::hypot(u, v) < 1.1 ? probeDirection(kind, u, v) : Vec3(0, 0, 1);
        });
        const SourceLayout layout = kind == ProbeKind::Angular ? SourceLayout::Angular : SourceLayout::MirrorBall;
        const Environment in = environmentFromImage(fileOf(probe), "a.hdr", named(layout));
        EXPECT_EQ(in.map.layout, EnvLayout::Cube);
        EXPECT_EQ(in.map.size(), 64);
        EXPECT_LT(differenceToSky(in.map), 0.03) << toString(layout);
        double sum = 0;
        for (const double s : probeSolidAngles(kind, size)) sum += s;
        EXPECT_NEAR(sum, 4 * kPi, 0.03) << toString(layout);
        for (const Vec3 d : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, -1, 0), glm::normalize(Vec3(1, 2, -5))}) {
            const glm::dvec2 p = probePoint(kind, d);
            EXPECT_LT(glm::length(probeDirection(kind, p.x, p.y) - d), 1e-12);
        }
    }
    EXPECT_NEAR(probePoint(ProbeKind::Angular, {1, 0, 0}).x, 0.5, 1e-12);
    EXPECT_NEAR(probePoint(ProbeKind::MirrorBall, {0, 1, 0}).y, std::sqrt(0.5), 1e-12);
    EXPECT_EQ(probePoint(ProbeKind::Angular, {0, 0, -1}), glm::dvec2(1, 0));
}

TEST(Source, ParaboloidsSideBySide) {
    const Image stacked = pictureOf(EnvLayout::DualParaboloid, 6);
    Image beside(12, 6, 3);
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 12; ++x) beside.setRgb(x, y, stacked.rgb(x % 6, y + x / 6 * 6));
    EXPECT_EQ(environmentFromImage(fileOf(beside), "a", named(SourceLayout::DualParaboloid)).map.image.data(),
              stacked.data());
}

TEST(Source, SixFilesByPatternAndFolder) {
    const Scratch scratch;
    const Image strip = pictureOf(EnvLayout::Cube, 4);
    const char* names[] = {"px", "nx", "py", "ny", "pz", "nz"};
    const auto write = [&](int face, int size) {
        Image image(size, size, 3);
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) image.setRgb(x, y, strip.rgb(x % 4, face * 4 + y % 4));
        writeExr(image, scratch / (std::string(names[face]) + ".exr"));
    };
    for (int face = 0; face < 6; ++face) write(face, 4);
    for (const std::string& source : {scratch.folder().string(), (scratch / "%s.exr").string()}) {
        const Environment in = readEnvironment(source);
        EXPECT_EQ(in.report.layout, SourceLayout::CubeFaces);
        EXPECT_LT(differenceToSky(in.map), kExact);
    }
    write(4, 5);
    EXPECT_THAT(messageOf<Error>([&] { readEnvironment(scratch.folder().string()); }),
                AllOf(HasSubstr("pz.exr"), HasSubstr("4 x 4"), HasSubstr("found 5 x 5")));
    std::filesystem::remove(scratch / "pz.exr");
    EXPECT_THAT(messageOf<Error>([&] { readEnvironment((scratch / "%s.exr").string()); }),
                AllOf(HasSubstr("expected six faces"), HasSubstr("found none for pz")));
    EXPECT_THAT(messageOf<Error>([&] { readEnvironment(scratch.folder().string()); }), HasSubstr("none for pz"));
}

TEST(Source, EnvmapAttributeDecides) {
    const Scratch scratch;
    writeExr(pictureOf(EnvLayout::Cube, 2), scratch / "cube.exr", {.envmap = Imf::ENVMAP_CUBE});
    EXPECT_EQ(readEnvironment((scratch / "cube.exr").string()).report.layout, SourceLayout::CubeStrip);
    writeExr(pictureOf(EnvLayout::LatLong, 2), scratch / "latlong.exr", {.envmap = Imf::ENVMAP_LATLONG});
    EXPECT_EQ(readEnvironment((scratch / "latlong.exr").string()).report.layout, SourceLayout::LatLong);
    writeExr(Image(6, 2, 3), scratch / "wrong.exr", {.envmap = Imf::ENVMAP_LATLONG});
    EXPECT_THAT(messageOf<Error>([&] { readEnvironment((scratch / "wrong.exr").string()); }),
                AllOf(HasSubstr("2:1"), HasSubstr("envmap attribute"), HasSubstr("6 x 2")));
}

TEST(Source, RefusesProportionsThatAreNone) {
    EXPECT_THAT(refused(Image(100, 51, 3)), AllOf(HasSubstr("2:1"), HasSubstr("100 x 51")));
    EXPECT_THAT(refused(Image(100, 51, 3), SourceLayout::LatLong),
                AllOf(HasSubstr("2:1 for latlong"), HasSubstr("100 x 51")));
    EXPECT_THAT(refused(Image(8, 8, 3)), AllOf(HasSubstr("angular"), HasSubstr("octahedral"), HasSubstr("8 x 8")));
    EXPECT_THAT(refused(Image(4, 8, 3)), HasSubstr("dual_paraboloid"));
    EXPECT_THAT(refused(Image(8, 4, 3), SourceLayout::CubeFaces), HasSubstr("%s"));
    EXPECT_THROW(sourceLayoutFromString("cubemap"), std::invalid_argument);
    for (const std::string& name : sourceLayoutNames()) EXPECT_EQ(toString(sourceLayoutFromString(name)), name);
    SourceOptions options;
    options.flip = "z";
    EXPECT_THROW(environmentFromImage(fileOf(Image(4, 2, 3)), "a", options), std::invalid_argument);
    EXPECT_THROW(environmentFromImage(fileOf(Image(2, 12, 3)), "a", named(SourceLayout::Auto, "directx")),
                 std::invalid_argument);
}

TEST(Source, FlipAndYawAreExplicit) {
    SourceOptions options;
    options.flip = "x";
    const ImageFile file = fileOf(pictureOf(EnvLayout::LatLong, 16));
    EXPECT_LT(differenceToSky(environmentFromImage(file, "a", options).map, Mat3(-1, 0, 0, 0, 1, 0, 0, 0, 1)), kExact);
    options.flip = "y";
    EXPECT_LT(differenceToSky(environmentFromImage(file, "a", options).map, Mat3(1, 0, 0, 0, -1, 0, 0, 0, 1)), kExact);
    options.flip = "none";
    options.yaw = kPi / 2;  // what was at +z is at +x
    const Environment turned = environmentFromImage(file, "a", options);
    EXPECT_LT(glm::length(sampleEnv(turned.map, {1, 0, 0}) - sky({0, 0, 1})), 0.02);
    EXPECT_NEAR(toJson(turned.report)["yaw_deg"].get<double>(), 90, 1e-9);
}

TEST(Source, SizesOneTwoAndOddAndOneChannel) {
    for (const int size : {1, 2, 3, 7}) {
        Image gray(2 * size, size, 1);
        for (float& v : gray.data()) v = 2;
        const EnvMap map = environmentFromImage(fileOf(gray), "a").map;
        EXPECT_EQ(map.size(), size);
        EXPECT_EQ(map.image.rgb(0, 0), Rgb(2));
    }
}

TEST(TexelCheck, NegativeTexelsFollowTheRule) {
    Image image(4, 2, 3);
    for (float& v : image.data()) v = 1;
    image.setRgb(1, 0, {-1, 2, 3});
    SourceOptions options;
    const Environment clamped = environmentFromImage(fileOf(image), "a", options);
    EXPECT_EQ(clamped.report.texels.negative, 1u);
    EXPECT_EQ(clamped.map.image.rgb(1, 0), Rgb(0, 2, 3));
    EXPECT_NEAR(clamped.report.texels.energyRemovedPercent, 100.0 / (7 * 3 + 6), 1e-6);  // all texels are alike
    options.negative = NegativePolicy::Keep;
    EXPECT_EQ(environmentFromImage(fileOf(image), "a", options).map.image.rgb(1, 0), Rgb(-1, 2, 3));
    options.negative = NegativePolicy::Error;
    EXPECT_THAT(messageOf<Error>([&] { environmentFromImage(fileOf(image), "a.exr", options); }),
                AllOf(HasSubstr("a.exr"), HasSubstr("1 negative"), HasSubstr("(1, 0)")));
    for (const NegativePolicy policy : {NegativePolicy::Keep, NegativePolicy::Clamp, NegativePolicy::Error})
        EXPECT_EQ(negativePolicyFromString(toString(policy)), policy);
    EXPECT_THROW(negativePolicyFromString("ignore"), std::invalid_argument);
}

TEST(TexelCheck, OnePercentNanIsCountedAndFilledFromNeighbours) {
    Image image = pictureOf(EnvLayout::LatLong, 64);
    for (std::size_t i = 0; i < image.texelCount(); i += 100) image.data()[3 * i + 1] = NAN;
    const Environment in = environmentFromImage(fileOf(image), "a");
    EXPECT_EQ(in.report.texels.nonFinite, (image.texelCount() + 99) / 100);
    EXPECT_EQ(toJson(in.report)["non_finite"], in.report.texels.nonFinite);
    EXPECT_LT(differenceToSky(in.map), 1e-3);
    for (const float v : in.map.image.data()) ASSERT_TRUE(std::isfinite(v));
    SourceOptions strict;
    strict.negative = NegativePolicy::Error;
    EXPECT_THAT(messageOf<Error>([&] { environmentFromImage(fileOf(image), "a", strict); }),
                HasSubstr("82 non-finite"));
}

TEST(TexelCheck, AllNanIsRefused) {
    Image image(4, 2, 3);
    for (float& v : image.data()) v = NAN;
    EXPECT_THAT(messageOf<Error>([&] { environmentFromImage(fileOf(image), "a"); }), HasSubstr("found none among 8"));
}

TEST(TexelCheck, NeighboursWrapAroundAndStayOnTheirFace) {
    Image latlong(4, 2, 3);
    latlong.setRgb(3, 0, Rgb(9));
    latlong.setRgb(3, 1, Rgb(9));
    latlong.setRgb(0, 0, Rgb(NAN));
    EXPECT_EQ(environmentFromImage(fileOf(latlong), "a").map.image.rgb(0, 0).r,
              static_cast<float>(18.0 / 5));  // 3 columns, 2 rows
    Image strip(1, 6, 3);
    for (float& v : strip.data()) v = 5;
    strip.setRgb(0, 2, Rgb(INFINITY));
    const Environment cube = environmentFromImage(fileOf(strip), "a");
    EXPECT_EQ(cube.map.image.rgb(0, 2), Rgb(0)) << "no neighbour on a face of one texel";
    EXPECT_EQ(cube.report.texels.overflowed, 1u);
}

TEST(TexelCheck, HalfOverflowIsCountedNotChanged) {
    Image image(2, 1, 3);
    image.data() = {65504, 0, 0, 1e6f, 0, 0};
    const Environment in = environmentFromImage(fileOf(image), "a");
    EXPECT_EQ(in.report.texels.overflowed, 2u);
    EXPECT_EQ(in.map.image.rgb(1, 0).r, 1e6);
}

TEST(EnvAsset, ChainComesBackWithItsMapping) {
    const Scratch scratch;
    EnvChain chain;
    for (const int size : {8, 4, 2}) chain.levels.emplace_back(EnvLayout::Cube, pictureOf(EnvLayout::Cube, size));
    chain.mapping = LevelMapping{"sqrt", "alpha", {0, 0.25, 1}};
    writeAsset(toAsset(chain, {TexelFormat::Float, 1}), scratch / "a.exr");
    const Asset asset = readAsset(scratch / "a.exr");
    EXPECT_EQ(asset.kind, "environment");
    EXPECT_EQ(asset.meta["layout"], "cube");
    EXPECT_EQ(asset.meta["orientation"], "openexr, y up");
    EXPECT_EQ(asset.textures[2].name, "level2");
    EXPECT_EQ(asset.textures[2].mapping, "cube");
    const EnvChain back = envFromAsset(asset, "a.exr");
    ASSERT_EQ(back.levels.size(), 3u);
    EXPECT_EQ(back.levels[1].image.data(), chain.levels[1].image.data());
    EXPECT_EQ(back.mapping->values, chain.mapping->values);
    // A source may be such an asset: its layout and orientation are its own word.
    const Environment in = readEnvironment((scratch / "a.exr").string());
    EXPECT_EQ(in.map.image.data(), chain.levels[0].image.data());
}

TEST(EnvAsset, SunAboveHalfNeedsAStatedScale) {
    EnvMap map(EnvLayout::LatLong, 4);
    map.image.setRgb(1, 1, Rgb(1e6, 3, 0));
    const EnvChain chain(map);
    EXPECT_THAT(messageOf<StorageError>([&] { toAsset(chain); }), AllOf(HasSubstr("65504"), HasSubstr("scale of 16")));
    EXPECT_EQ(scaleForHalf(chain), 16);
    const EnvChain back = envFromAsset(toAsset(chain, {TexelFormat::Half, 16}), "a");
    EXPECT_NEAR(back.levels[0].image.rgb(1, 1).r, 1e6, 1e6 / 2048);
    EXPECT_NO_THROW(toAsset(chain, {TexelFormat::Float, 1}));
    EXPECT_EQ(scaleForHalf(EnvChain(EnvMap(EnvLayout::Cube, 2))), 1);
}

TEST(EnvAsset, RefusesOtherAssetsAndBrokenMappings) {
    Asset asset = toAsset(EnvChain(EnvMap(EnvLayout::Cube, 2)));
    asset.meta["level_mapping"] = {{"name", "linear"}, {"parameter", "alpha"}, {"values", {0, 1}}};
    EXPECT_THAT(messageOf<Error>([&] { envFromAsset(asset, "a.exr"); }), HasSubstr("2 values for 1 levels"));
    asset.meta["level_mapping"] = 3;
    EXPECT_THROW(envFromAsset(asset, "a.exr"), Error);
    asset.kind = "brdf";
    EXPECT_THAT(messageOf<Error>([&] { envFromAsset(asset, "a.exr"); }), HasSubstr("kind 'brdf'"));
    EXPECT_THROW(toAsset(EnvChain()), std::invalid_argument);
}

TEST(EnvAsset, ChainIsSampledTrilinearly) {
    EnvChain chain;
    for (const double v : {1.0, 3.0, 7.0}) {
        EnvMap level(EnvLayout::Cube, 2);
        for (float& texel : level.image.data()) texel = static_cast<float>(v);
        chain.levels.push_back(level);
    }
    const double lods[] = {-1, 0, 0.25, 1, 1.5, 2, 9}, want[] = {1, 1, 1.5, 3, 5, 7, 7};
    for (std::size_t i = 0; i < 7; ++i) EXPECT_DOUBLE_EQ(sampleChain(chain, {0, 3, 0}, lods[i]).r, want[i]) << lods[i];
}

TEST(LevelMapping, IsAPairOfInverses) {
    for (const LevelMapping& mapping :
         {LevelMapping{"linear", "alpha", {0, 0.1, 0.5, 1}}, LevelMapping{"sqrt", "alpha", {0, 0.0625, 0.25, 1}},
          LevelMapping{"log2", "exponent", {2048, 128, 16, 1}}}) {
        EXPECT_NO_THROW(requireValid(mapping));
        for (double lod = 0; lod <= 3; lod += 0.125)
            EXPECT_NEAR(lodOf(mapping, valueOf(mapping, lod)), lod, 1e-12) << mapping.name;
        for (std::size_t i = 0; i < 4; ++i) EXPECT_DOUBLE_EQ(lodOf(mapping, mapping.values[i]), static_cast<double>(i));
    }
    const LevelMapping exponents{"log2", "exponent", {2048, 128, 16, 1}};
    EXPECT_EQ(lodOf(exponents, 1e9), 0);
    EXPECT_EQ(lodOf(exponents, 0), 3);
    EXPECT_EQ(lodOf({"sqrt", "alpha", {0.5}}, 0.9), 0);
    EXPECT_EQ(lodOf({"sqrt", "alpha", {0, 0.25, 1}}, 0.0625), 0.5);
    EXPECT_THROW(requireValid({"cubic", "alpha", {0, 1}}), std::invalid_argument);
    EXPECT_THROW(requireValid({"log2", "exponent", {1, 0}}), std::invalid_argument);
    EXPECT_THROW(requireValid({"linear", "alpha", {0, 1, 1}}), std::invalid_argument);
    EXPECT_THROW(requireValid({"linear", "alpha", {}}), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
