// Conversion by area: energy, constants, closed forms, seams, suns, small and odd sizes, thread counts.
#include "envmaps/convert.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <numeric>

#include "core/image_file.hpp"
#include "core/sampling.hpp"

namespace nacre {
namespace {

constexpr EnvLayout kAll[] = {EnvLayout::LatLong, EnvLayout::Cube, EnvLayout::DualParaboloid, EnvLayout::Octahedral};
constexpr double kEnergy = 2e-5;   // curved edges as short parabolas and chords
constexpr double kBleeding = 0.2;  // 5e-5 of values up to 4e3: short arcs stand for parallels, slivers cross a row

template <typename F>
EnvMap mapOf(EnvLayout layout, int size, F&& radiance) {
    EnvMap map(layout, size);
    for (int y = 0; y < map.image.height(); ++y)
        for (int x = 0; x < map.image.width(); ++x)
            map.image.setRgb(x, y, radiance(envTexelDirection(layout, size, x, y)));
    return map;
}

double energyError(const EnvMap& a, const EnvMap& b) {
    return maxComponent(glm::abs(envEnergy(a) - envEnergy(b)) / maxComponent(envEnergy(a)));
}

/// Noise of many decades: nothing smooth hides an error.
EnvMap noise(EnvLayout layout, int size) {
    EnvMap map(layout, size);
    std::uint32_t state = 1;
    for (float& v : map.image.data()) {
        state = state * 1664525u + 1013904223u;
        v = std::exp(static_cast<float>(state >> 8) * 5e-7f);
    }
    return map;
}

TEST(ConvertEnv, EnergyStaysForAnyPairOfLayoutsAndSizes) {
    for (const auto& [size, other] : {std::pair{1, 5}, {2, 2}, {7, 48}, {33, 1}})
        for (const EnvLayout from : kAll) {
            const EnvMap map = noise(from, size);
            for (const EnvLayout to : kAll) {
                const EnvMap out = convertEnv(map, to, other);
                EXPECT_LT(energyError(map, out), kEnergy) << toString(from) << size << " to " << toString(to) << other;
                EXPECT_LT(energyError(map, convertEnv(out, from, size)), 2 * kEnergy) << "and back";
            }
        }
}

TEST(ConvertEnv, OneTexelOf1e5TimesTheMeanKeepsItsEnergy) {
    for (const EnvLayout from : kAll)
        for (const Vec3 sun : {Vec3(0, 1, 0), Vec3(1, 1, 1), Vec3(1, 0, 0), Vec3(0, 0, -1), Vec3(0.3, 0.5, -0.8)}) {
            EnvMap map = mapOf(from, 32, [](const Vec3&) { return Rgb(1, 0.5, 0.1); });
            const glm::dvec2 p = envPosition(from, 32, glm::normalize(sun));
            const int x = std::clamp(static_cast<int>(p.x), 0, map.image.width() - 1),
                      y = std::clamp(static_cast<int>(p.y), 0, map.image.height() - 1);
            map.image.setRgb(x, y, Rgb(1e5));
            for (const EnvLayout to : kAll)
                for (const int size : {24}) {
                    const EnvMap out = convertEnv(map, to, size);
                    EXPECT_LT(energyError(map, out), kEnergy) << toString(from) << " to " << toString(to) << size;
                    EXPECT_LT(energyError(map, convertEnv(out, from, 32)), 2 * kEnergy) << "and back";
                }
        }
}

TEST(ConvertEnv, ConstantStaysConstantBitByBit) {
    for (const EnvLayout from : kAll)
        for (const EnvLayout to : kAll)
            for (const auto& [size, other] : {std::pair{1, 1}, {1, 9}, {2, 3}, {9, 1}, {31, 40}, {40, 31}}) {
                const EnvMap out =
                    convertEnv(mapOf(from, size, [](const Vec3&) { return Rgb(0.1f, 3e4f, 7e-5f); }), to, other);
                for (int y = 0; y < out.image.height(); ++y)
                    for (int x = 0; x < out.image.width(); ++x)
                        ASSERT_EQ(out.image.rgb(x, y), Rgb(0.1f, 3e4f, 7e-5f))
                            << toString(from) << size << " to " << toString(to) << other << " at " << x << ' ' << y;
            }
}

TEST(ConvertEnv, BlackStaysBlack) {
    for (const EnvLayout to : kAll) {
        const EnvMap out = convertEnv(EnvMap(EnvLayout::LatLong, 8), to, 5);
        for (const float v : out.image.data()) EXPECT_EQ(v, 0);
    }
}

TEST(ConvertEnv, LinearRadianceArrivesAtEveryTexel) {
    // L = 1 + d·a at the texel centres; both maps' texels are 2/64 wide at most, over which the average differs by
    // curvature alone, and a border texel's footprint is centred on its texel.
    constexpr double kTexel = 0.02;
    const auto linear = [](const Vec3& d) { return Rgb(1 + d.x, 1 + d.y, 1 + d.z); };
    for (const EnvLayout from : kAll)
        for (const EnvLayout to : kAll) {
            const EnvMap map = mapOf(from, 128, linear), out = convertEnv(map, to, 64), truth = mapOf(to, 64, linear);
            double worst = 0;
            for (int y = 0; y < out.image.height(); ++y)
                for (int x = 0; x < out.image.width(); ++x)
                    worst = std::max(worst, maxComponent(glm::abs(out.image.rgb(x, y) - truth.image.rgb(x, y))));
            EXPECT_LT(worst, to == EnvLayout::DualParaboloid ? 2 * kTexel : kTexel)
                << toString(from) << " to " << toString(to);
        }
}

TEST(ConvertEnv, FinerByAWholeFactorRepeatsTexelsAndComesBack) {
    for (const EnvLayout layout : {EnvLayout::LatLong, EnvLayout::Cube}) {
        const EnvMap map = noise(layout, 6), fine = convertEnv(map, layout, 18);
        for (int y = 0; y < fine.image.height(); ++y)
            for (int x = 0; x < fine.image.width(); ++x)
                ASSERT_LT(glm::length(fine.image.rgb(x, y) - map.image.rgb(x / 3, y / 3)), kBleeding) << x << ' ' << y;
        const EnvMap back = convertEnv(fine, layout, 6);
        for (std::size_t i = 0; i < back.image.data().size(); ++i)
            ASSERT_NEAR(back.image.data()[i], map.image.data()[i], kBleeding);
    }
}

TEST(ConvertEnv, TexelsOnASeamMeetAndTexelsBeyondTheRimAreFilled) {
    const EnvMap map = noise(EnvLayout::Cube, 16);
    const Image oct = convertEnv(map, EnvLayout::Octahedral, 9).image;
    for (int i = 0; i < 9; ++i) {
        EXPECT_EQ(oct.rgb(i, 0), oct.rgb(8 - i, 0));
        EXPECT_EQ(oct.rgb(8, i), oct.rgb(8, 8 - i));
    }
    EXPECT_EQ(oct.rgb(0, 0), oct.rgb(8, 8));
    const EnvMap pair = convertEnv(map, EnvLayout::DualParaboloid, 16);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 16; ++x) EXPECT_GE(pair.image.rgb(x, y).r, 1) << x << ' ' << y;  // noise is e^0 or more
}

TEST(ConvertEnv, SameBitsForAnyThreadCount) {
    const EnvMap map = noise(EnvLayout::LatLong, 20);
    for (const EnvLayout to : kAll)
        EXPECT_EQ(convertEnv(map, to, 31, 1).image.data(), convertEnv(map, to, 31, 7).image.data());
}

TEST(ConvertEnv, RealMapsKeepTheirEnergyThereAndBack) {
    const char* chosen = std::getenv("NACRE_WORLD");
    const std::filesystem::path folder = chosen ? chosen : "/usr/share/blender/datafiles/studiolights/world";
    if (!std::filesystem::exists(folder / "city.exr")) GTEST_SKIP() << folder << " has no maps (NACRE_WORLD)";
    for (const char* name : {"city.exr", "studio.exr"}) {
        const ImageFile file = readImageFile(folder / name);
        Image rgb(file.image.width(), file.image.height(), 3);
        for (int y = 0; y < rgb.height(); ++y)
            for (int x = 0; x < rgb.width(); ++x) rgb.setRgb(x, y, file.image.rgb(x, y));
        const EnvMap map(EnvLayout::LatLong, rgb);
        for (const EnvLayout to : kAll) {
            const EnvMap out = convertEnv(map, to, 128);
            EXPECT_LT(energyError(map, out), kEnergy) << name << ' ' << toString(to);
            EXPECT_LT(energyError(map, convertEnv(out, EnvLayout::LatLong, rgb.height())), 2 * kEnergy) << name;
        }
    }
}

TEST(ConvertEnv, RejectsBadArguments) {
    EXPECT_THROW(convertEnv(EnvMap(), EnvLayout::Cube, 4), std::invalid_argument);
    EXPECT_THROW(convertEnv(EnvMap(EnvLayout::Cube, 2), EnvLayout::Cube, 0), std::invalid_argument);
    EXPECT_THROW(rotateEnv(EnvMap(EnvLayout::Cube, 2), NAN), std::invalid_argument);
}

TEST(RotateEnv, TurnsZTowardsXAndWholeTexelsShift) {
    const EnvMap map = noise(EnvLayout::LatLong, 8);  // 16 columns
    const EnvMap out = rotateEnv(map, kPi / 2);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x)  // +z is in the middle, +x a quarter left of it
            ASSERT_LT(glm::length(out.image.rgb(x, y) - map.image.rgb((x + 4) % 16, y)), kBleeding);
    const EnvMap cube = mapOf(EnvLayout::Cube, 16, [](const Vec3& d) { return Rgb(1 + d.z); });
    for (const double yaw : {0.3, kPi / 2, 2.0, -1.0}) {
        const EnvMap turned = rotateEnv(cube, yaw);
        EXPECT_LT(energyError(cube, turned), kEnergy);
        EXPECT_GT(sampleEnv(turned, {std::sin(yaw), 0, std::cos(yaw)}).r, 1.99);
    }
}

TEST(MirrorEnv, MovesTexelsToTheMirroredDirection) {
    for (const EnvLayout layout : kAll)
        for (const int size : {1, 2, 5, 8}) {
            const auto coded = [](const Vec3& d) { return Rgb(d.x + 2, d.y + 2, d.z + 2); };
            const EnvMap map = mapOf(layout, size, coded), x = mirrorEnvX(map), y = mirrorEnvY(map);
            const EnvMap wantX = mapOf(layout, size, [&](const Vec3& d) { return coded({-d.x, d.y, d.z}); });
            const EnvMap wantY = mapOf(layout, size, [&](const Vec3& d) { return coded({d.x, -d.y, d.z}); });
            for (std::size_t i = 0; i < map.image.data().size(); ++i) {
                ASSERT_NEAR(x.image.data()[i], wantX.image.data()[i], 1e-6) << toString(layout) << size;
                ASSERT_NEAR(y.image.data()[i], wantY.image.data()[i], 1e-6) << toString(layout) << size;
            }
        }
}

TEST(MatchingSize, KeepsTheTexelsWidth) {
    EXPECT_EQ(matchingSize(EnvMap(EnvLayout::LatLong, 512), EnvLayout::Cube), 256);
    EXPECT_EQ(matchingSize(EnvMap(EnvLayout::Cube, 256), EnvLayout::Octahedral), 512);
    EXPECT_EQ(matchingSize(EnvMap(EnvLayout::LatLong, 1), EnvLayout::Cube), 1);
    EXPECT_EQ(matchingSize(EnvMap(EnvLayout::DualParaboloid, 7), EnvLayout::DualParaboloid), 7);
}

TEST(EnvEnergy, OfConstantIsFourPi) {
    for (const EnvLayout layout : kAll)
        EXPECT_NEAR(envEnergy(mapOf(layout, 9, [](const Vec3&) { return Rgb(1); })).g, 4 * kPi, 1e-5);
}

}  // namespace
}  // namespace nacre
