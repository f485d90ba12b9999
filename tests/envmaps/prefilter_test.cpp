// Prefiltering against sums over every texel, closed forms, and the hard cases.
#include "envmaps/prefilter.hpp"

#include <gtest/gtest.h>

#include "core/sampling.hpp"
#include "reference/environment_error.hpp"

namespace nacre {
namespace {

constexpr double kHarmonicsCut = 3e-3;  // largest error anywhere, relative to the mean; root mean square is 6e-4

/// Bumps of all sizes and a lamp.
EnvMap roughMap(EnvLayout layout, int size) {
    EnvMap map(layout, size);
    for (int y = 0; y < map.image.height(); ++y)
        for (int x = 0; x < map.image.width(); ++x) {
            const Vec3 d = envTexelDirection(layout, size, x, y);
            const double noise = radicalInverse(static_cast<std::uint64_t>(y * map.image.width() + x) + 1, 2);
            const double lamp = glm::dot(d, glm::normalize(Vec3(0.5, 0.6, 0.3))) > 0.97 ? 40 : 0;
            map.image.setRgb(x, y, Rgb(1 + d.y + lamp, noise, 0.5 + 0.5 * std::sin(9 * d.x)));
        }
    return map;
}

EnvMap oneTexel(EnvLayout layout, int size, const Vec3& direction, double radiance, double rest) {
    EnvMap map(layout, size);
    for (float& v : map.image.data()) v = static_cast<float>(rest);
    const glm::dvec2 p = envPosition(layout, size, direction);
    map.image.setRgb(std::clamp(static_cast<int>(p.x), 0, map.image.width() - 1),
                     std::clamp(static_cast<int>(p.y), 0, map.image.height() - 1), Rgb(radiance));
    return map;
}

EnvMap filterOne(const EnvMap& source, const Lobe& lobe, int size, EnvLayout layout = EnvLayout::Cube,
                 unsigned threads = 0) {
    PrefilterOptions options;
    options.layout = layout;
    options.threads = threads;
    const PrefilterLevel level{lobe, size};
    return prefilter(source, {&level, 1}, options).levels[0];
}

std::vector<float> texelsOf(const EnvMap& source, const Lobe& lobe, int size, EnvLayout layout = EnvLayout::Cube,
                            unsigned threads = 0) {
    return filterOne(source, lobe, size, layout, threads).image.data();
}

const Lobe kLobes[] = {{LobeKind::Diffuse},
                       {LobeKind::Phong, 5},
                       {LobeKind::Phong, 300},
                       {LobeKind::Ggx, 0, 0.018},
                       {LobeKind::Ggx, 0, 0.25},
                       {LobeKind::Ggx, 0, 1},
                       {LobeKind::Beckmann, 0, 0.1},
                       {LobeKind::GgxRefraction, 0, 0.3, 1.5},
                       {LobeKind::GgxRefraction, 0, 0.3, 1 / 1.5},
                       {LobeKind::BeckmannRefraction, 0, 0.5, 200}};

std::string nameOf(const Lobe& lobe) {
    return toString(lobe.kind) + " exponent " + std::to_string(lobe.exponent) + " alpha " + std::to_string(lobe.alpha) +
           " ior " + std::to_string(lobe.ior);
}

TEST(Prefilter, IsTheSumOverEveryTexel) {
    for (const EnvLayout layout :
         {EnvLayout::Cube, EnvLayout::LatLong, EnvLayout::Octahedral, EnvLayout::DualParaboloid}) {
        const EnvMap source = roughMap(layout, 32);
        const EnvironmentTruth truth(source);
        for (const Lobe& lobe : kLobes) {
            const EnvironmentError e = measureEnvironment(filterOne(source, lobe, 20), truth, lobe, 60);
            EXPECT_LT(e.rmse, 1e-3) << toString(layout) << " " << nameOf(lobe);
            EXPECT_LT(e.max, kHarmonicsCut) << toString(layout) << " " << nameOf(lobe);
        }
    }
}

TEST(Prefilter, NarrowLobesAreSplitAndStillTheSum) {  // tails of GGX by harmonics, its middle texel by texel
    const EnvMap source = roughMap(EnvLayout::Cube, 64);
    const EnvironmentTruth truth(source);
    for (const Lobe& lobe : {Lobe{LobeKind::Ggx, 0, 0.001},
                             {LobeKind::Ggx, 0, 0.008},
                             {LobeKind::Phong, 1e5},
                             {LobeKind::Beckmann, 0, 0.004}}) {
        PrefilterLevel level{lobe, 24};
        const Prefiltered out = prefilter(source, {&level, 1}, {});
        EXPECT_GT(out.steps[0].directRadius, 0) << nameOf(lobe);
        const EnvironmentError e = measureEnvironment(out.levels[0], truth, lobe, 60);
        EXPECT_LT(e.max, kHarmonicsCut) << nameOf(lobe);
    }
}

TEST(Prefilter, BothWaysAgreeWhereBothWork) {
    // The same lobe by harmonics alone (loose tolerance asks for fewer) and, narrower by a hair, with a direct middle.
    const EnvMap source = roughMap(EnvLayout::Cube, 32);
    const EnvMap harmonic = filterOne(source, {LobeKind::Ggx, 0, 0.0125}, 12);
    PrefilterOptions strict;
    strict.tolerance = 1e-9;
    const PrefilterLevel level{{LobeKind::Ggx, 0, 0.0125}, 12};
    const Prefiltered direct = prefilter(source, {&level, 1}, strict);
    EXPECT_GT(direct.steps[0].directRadius, 0);
    for (std::size_t i = 0; i < harmonic.image.data().size(); ++i)
        EXPECT_NEAR(harmonic.image.data()[i], direct.levels[0].image.data()[i], 1e-2) << i;
}

TEST(Prefilter, LinearEnvironmentHasClosedForm) {  // L = 1 + l·z: L' = 1 + k_1 r·z
    EnvMap source(EnvLayout::Cube, 64);
    for (int y = 0; y < source.image.height(); ++y)
        for (int x = 0; x < 64; ++x)
            source.image.setRgb(x, y, Rgb(1 + envTexelDirection(EnvLayout::Cube, 64, x, y).z, 0, 0));
    for (const double n : {0.0, 1.0, 10.0, 100.0}) {
        const EnvMap out = filterOne(source, {LobeKind::Phong, n}, 4);
        for (int y = 0; y < out.image.height(); ++y)
            for (int x = 0; x < 4; ++x)
                EXPECT_NEAR(out.image.at(x, y, 0),
                            1 + (n + 1) / (n + 2) * envTexelDirection(EnvLayout::Cube, 4, x, y).z, 5e-4);
    }
}

TEST(Prefilter, WhiteSurroundingGivesOneInEveryLayoutAndSize) {
    const EnvMap white = oneTexel(EnvLayout::Cube, 5, {1, 0, 0}, 1, 1);
    for (const EnvLayout layout :
         {EnvLayout::Cube, EnvLayout::LatLong, EnvLayout::Octahedral, EnvLayout::DualParaboloid})
        for (const int size : {1, 2, 5})
            for (const Lobe& lobe : {Lobe{LobeKind::Diffuse}, {LobeKind::Phong, 200}, {LobeKind::Ggx, 0, 0.25}})
                for (const float v : texelsOf(white, lobe, size, layout)) EXPECT_NEAR(v, 1, 1e-6) << nameOf(lobe);
}

TEST(Prefilter, BlackStaysBlack) {
    for (const Lobe& lobe : kLobes)
        for (const float v : texelsOf(EnvMap(EnvLayout::Cube, 8), lobe, 4)) EXPECT_EQ(v, 0.0f);
}

TEST(Prefilter, SunAtCornerSeamAndPoleIsAsBrightAsElsewhere) {
    // One texel at 1e5 times the rest; the answer is known from the sum, and nowhere negative or above the sun.
    for (const EnvLayout layout : {EnvLayout::Cube, EnvLayout::DualParaboloid, EnvLayout::LatLong})
        for (const Vec3& sun : {Vec3(1, 1, 1), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, -1), Vec3(1, 0.3, 1e-6)}) {
            const EnvMap source = oneTexel(layout, 33, glm::normalize(sun), 1e5, 1);
            const EnvironmentTruth truth(source);
            double mean = 0;  // of the map: few of the samples see the sun
            const std::vector<double> omega = envSolidAngles(layout, 33);
            for (std::size_t i = 0; i < omega.size(); ++i) mean += source.image.data()[3 * i] * omega[i] / (4 * kPi);
            for (const Lobe& lobe : {Lobe{LobeKind::Diffuse}, {LobeKind::Phong, 300}, {LobeKind::Ggx, 0, 0.1}}) {
                const EnvMap out = filterOne(source, lobe, 16);
                const EnvironmentError e = measureEnvironment(out, truth, lobe, 40);
                EXPECT_LT(e.rmse * e.mean, 1e-3 * mean) << toString(layout) << nameOf(lobe);
                for (const float v : out.image.data()) {
                    EXPECT_GE(v, 0);
                    EXPECT_LT(v, 1e5);
                }
            }
        }
}

TEST(Prefilter, AnisotropicLobesAreTheSumToo) {
    const EnvMap source = roughMap(EnvLayout::Cube, 64);
    const EnvironmentTruth truth(source);
    for (const Vec3& axis : {Vec3(0, 1, 0), Vec3(3, 1, -2)}) {
        const Lobe lobe{LobeKind::GgxAnisotropic, 0, 0.1, 1, 0.5, axis};
        EXPECT_LT(measureEnvironment(filterOne(source, lobe, 7), truth, lobe, 60).rmse, 1e-5);
    }
    const Lobe equal{LobeKind::GgxAnisotropic, 0, 0.3, 1, 0.3};
    const std::vector<float> round = texelsOf(source, {LobeKind::Ggx, 0, 0.3}, 5), same = texelsOf(source, equal, 5);
    for (std::size_t i = 0; i < same.size(); ++i) EXPECT_NEAR(same[i], round[i], 1e-2f) << i;
    for (const float v : texelsOf(oneTexel(EnvLayout::Cube, 5, {1, 0, 0}, 1, 1), equal, 3)) EXPECT_NEAR(v, 1, 1e-6);
    EXPECT_EQ(texelsOf(source, equal, 5, EnvLayout::Cube, 1), same);
}

TEST(Prefilter, LampsInMergedTexelsKeepTheirPlace) {
    // Diffuse light merges 4 × 4 texels of a map of this size; a lamp of one texel is not to move to their middle.
    const EnvMap source = oneTexel(EnvLayout::Cube, 256, {0.2, 1, 0.1}, 3e4, 0.01);
    const EnvironmentTruth truth(source);
    EXPECT_LT(measureEnvironment(filterOne(source, {LobeKind::Diffuse}, 32), truth, {LobeKind::Diffuse}, 30).rmse,
              1e-3);
}

TEST(Prefilter, ExponentOfAMillionIsTheNearestTexel) {
    const EnvMap source = roughMap(EnvLayout::Cube, 16);
    const EnvMap out = filterOne(source, {LobeKind::Phong, 1e6}, 16),
                 coarse = filterOne(source, {LobeKind::Phong, 1e6}, 5);
    for (std::size_t i = 0; i < out.image.data().size(); ++i)
        EXPECT_NEAR(out.image.data()[i], source.image.data()[i], 1e-4f * (1 + source.image.data()[i]));
    for (const float v : coarse.image.data()) EXPECT_TRUE(std::isfinite(v));
}

// Their tails end, and harmonics' rounding is no weight: the nearest centres decide. 24 from 72: each is a centre.
TEST(Prefilter, BeckmannNarrowerThanATexelIsTheNearestTexel) {
    const EnvMap source = roughMap(EnvLayout::Cube, 72);
    for (const Lobe& lobe : {Lobe{LobeKind::Beckmann, 0, 1e-3},
                             {LobeKind::BeckmannRefraction, 0, 1e-3, 1.5},
                             {LobeKind::BeckmannRefraction, 0, 1, 1.001}}) {
        const EnvironmentError e = measureEnvironment(filterOne(source, lobe, 24), EnvironmentTruth(source), lobe, 300);
        EXPECT_LT(e.max, 1e-6) << nameOf(lobe);
    }
}

TEST(Prefilter, ExponentOfZeroIsTheMeanOfTheHemisphere) {
    // Its edge is a jump: the sum over texels steps as each centre crosses it, which harmonics smooth out.
    const EnvMap source = roughMap(EnvLayout::Cube, 32);
    const EnvironmentTruth truth(source);
    const Lobe lobe{LobeKind::Phong, 0};
    const EnvironmentError e = measureEnvironment(filterOne(source, lobe, 8), truth, lobe, 60);
    EXPECT_LT(e.rmse, 0.01);
    EXPECT_LT(e.max, 0.05);
}

TEST(Prefilter, NoInterfaceIsTheMirror) {  // ior 1 bends nothing
    const EnvMap source = roughMap(EnvLayout::Cube, 8);
    EXPECT_EQ(texelsOf(source, {LobeKind::GgxRefraction, 0, 0.5, 1}, 8), source.image.data());
    EXPECT_EQ(texelsOf(source, {LobeKind::Mirror}, 8), source.image.data());
}

TEST(Prefilter, TinyAndOddSources) {
    for (const int size : {1, 2, 3}) {
        const EnvMap source = roughMap(EnvLayout::Cube, size);
        const EnvironmentTruth truth(source);
        for (const Lobe& lobe : {Lobe{LobeKind::Diffuse}, {LobeKind::Phong, 10}, {LobeKind::Ggx, 0, 0.3}})
            EXPECT_LT(measureEnvironment(filterOne(source, lobe, 3), truth, lobe, 30).rmse, 2e-3)
                << size << nameOf(lobe);
    }
}

TEST(Prefilter, SameBitsForAnyThreadCount) {
    const EnvMap source = roughMap(EnvLayout::Cube, 32);
    for (const Lobe& lobe : {Lobe{LobeKind::Diffuse}, {LobeKind::Phong, 700}, {LobeKind::Ggx, 0, 0.004}})
        EXPECT_EQ(texelsOf(source, lobe, 9, EnvLayout::Cube, 1), texelsOf(source, lobe, 9, EnvLayout::Cube, 7));
}

TEST(Prefilter, RejectsBadInput) {
    EnvMap source(EnvLayout::Cube, 4);
    EXPECT_THROW(filterOne(source, {LobeKind::Diffuse}, 0), std::invalid_argument);
    EXPECT_THROW(filterOne(source, {LobeKind::Phong, -2}, 4), std::invalid_argument);
    source.image.at(1, 1, 1) = NAN;
    EXPECT_THROW(filterOne(source, {LobeKind::Diffuse}, 4), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
