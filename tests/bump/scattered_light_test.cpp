// Scattered light against traced paths, a groove's radiosity, and what holds for every relief.
#include "bump/scattered_light.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "reference/scattered_light_error.hpp"
#include "tests/bump/relief_fixtures.hpp"

namespace nacre {
namespace {

// Relative root mean square errors against traced paths, 3 bounces, 100 paths, albedo 0.7 (see reference/README.md).
constexpr double kBar = 0.05;       // of the total; measured 0.9 % to 2.7 %
constexpr double kIndirect = 0.12;  // of the indirect part alone, the truth's own noise too; measured 3 % to 11 %
constexpr double kEdges = 0.25;  // of stones under a low light; measured 21 %: its edge is always a little below theirs
constexpr double kRounding = 1e-6;  // single precision of the result

const Vec3 kLow = glm::normalize(Vec3(1, 0.4, 0.4)), kHigh = glm::normalize(Vec3(0.3, -0.5, 1));

/// Smooth waves of slope up to about 1.5.
HeightMap waves(int size) {
    HeightMap map{Image(size, size, 1), Wrap::Repeat};
    const double turn = 2 * kPi / size;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            map.heights.at(x, y, 0) = static_cast<float>(
                size / 16.0 *
                (std::sin(3 * turn * x) * std::cos(2 * turn * y) + 0.5 * std::sin(turn * (5 * x + 7 * y))));
    return map;
}

/// Blocks with gaps, as a wall of stones.
HeightMap stones(int size) {
    HeightMap map = roughMap(size, size, 0.6f);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            if (x % 16 < 3 || (y + x / 16 * 5) % 16 < 3) map.heights.at(x, y, 0) -= 5;
    return map;
}

ReliefLightOptions truthOf(const Vec3& light, int paths) {
    ReliefLightOptions out;
    out.light = light, out.paths = paths;
    return out;
}

double largest(const Image& image) {
    double out = 0;
    for (const float v : image.data())
        out = std::isnan(v) ? std::numeric_limits<double>::infinity() : std::max<double>(out, std::abs(v));
    return out;
}

double sumOf(const Image& image) {
    double out = 0;
    for (const float v : image.data()) out += v;
    return out;
}

TEST(ScatteredLight, HundredPathsOfThreeBouncesAgreeWithTracedOnes) {
    for (const int relief : {0, 1, 2}) {
        const HeightMap map = relief == 0 ? waves(96) : relief == 1 ? stones(96) : roughMap(96, 96, 9);
        const ScatterMap scatter = makeScatterMap(map, {.directions = 256});
        for (const Vec3& light : {kLow, kHigh}) {
            const ScatteredLightError error = measureScatteredLight(drawReliefLightSamples(map, truthOf(light, 3000)),
                                                                    scatterLight(map, scatter, {.light = light}));
            EXPECT_LT(error.total, kBar);
            EXPECT_LT(error.indirect, relief == 1 && light == kLow ? kEdges : kIndirect);
            EXPECT_GT(error.share, 0.02) << "a relief without indirect light proves nothing";
        }
    }
}

TEST(ScatteredLight, ErrorFallsWithThePaths) {
    const HeightMap map = waves(96);
    const ScatterMap scatter = makeScatterMap(map, {.directions = 800});
    const ReliefLightSamples samples = drawReliefLightSamples(map, truthOf(kHigh, 12000), 150);
    double before = 1;
    for (const int paths : {5, 20, 80}) {
        const double error =
            measureScatteredLight(samples, scatterLight(map, scatter, {.light = kHigh, .paths = paths})).indirect;
        EXPECT_LT(error, 0.75 * before) << paths;  // √4 would be 0.5, evenly spread points do better
        before = error;
    }
    EXPECT_LT(before, 0.03) << "of the indirect part alone";
}

TEST(ScatteredLight, PathsAloneAgreeToo) {  // equation 10 as it stands: noisier
    const HeightMap map = waves(48);
    const ScatterMap scatter = makeScatterMap(map, {.directions = 256});
    const ReliefLightSamples samples = drawReliefLightSamples(map, truthOf(kHigh, 3000));
    ScatteredLightOptions options{.light = kHigh, .paths = 1024};
    options.pathsMeet = false;
    const ScatteredLightError alone = measureScatteredLight(samples, scatterLight(map, scatter, options));
    options.brdf = [](const Vec3&, const Vec3& wo) { return Rgb(wo.z > 0 ? 1 / kPi : 0); };  // none from below
    const ScatteredLightError general = measureScatteredLight(samples, scatterLight(map, scatter, options));
    for (const ScatteredLightError& error : {alone, general}) {
        EXPECT_LT(error.total, kBar);
        EXPECT_LT(std::abs(error.bias), kBar);
    }
}

TEST(ScatteredLight, CornerHasTheLightOfItsClosedForm) {
    // Two slopes of 45 degrees meet at right angles in a valley that is long both ways; one is lit head-on, the other
    // not at all. In the dark one, at a distance, half of (1 - cos 90 degrees) of its cosine is the lit one's.
    constexpr int kSize = 65;
    HeightMap map{Image(kSize, kSize, 1), Wrap::Clamp};
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) map.heights.at(x, y, 0) = static_cast<float>(std::abs(x - kSize / 2));
    const Vec3 light = glm::normalize(Vec3(1, 0, 1 + 1e-6));  // the left slope's normal
    const ScatteredLight lit =
        scatterLight(map, makeScatterMap(map, {.directions = 1024}), {.light = light, .bounces = 1, .paths = 1024});
    const double radiance = 0.7 / kPi;
    EXPECT_NEAR(lit.direct.at(kSize / 4, kSize / 2, 0), radiance, 1e-5);
    EXPECT_NEAR(lit.direct.at(kSize * 3 / 4, kSize / 2, 0), 0, 1e-5);
    // The lit slope ends at the map's border, kSize/2 texels up: it is seen from 0 to atan(32/d) of the dark one.
    for (const int d : {4, 8, 16}) {
        const double angle = std::atan2(kSize / 2, d), share = (1 - std::cos(angle)) / 2;
        EXPECT_NEAR(lit.indirect.at(kSize / 2 + d, kSize / 2, 0), 0.7 * share * radiance, 0.03 * radiance) << d;
        EXPECT_NEAR(lit.indirect.at(kSize / 2 - d, kSize / 2, 0), 0, 1e-4) << "sees the dark slope alone";
    }
}

/// Down towards +x: mirrored at the border, a valley of 90 degrees whose other slope is the relief turned over.
HeightMap mirroredSlope(int size, Wrap wrap) {
    HeightMap map{Image(size, size, 1), wrap};
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) map.heights.at(x, y, 0) = static_cast<float>(size - 1 - x);
    return map;
}

TEST(ScatteredLight, WhatLiesInAMirroredTileHasItsOwnLight) {
    const HeightMap map = mirroredSlope(24, Wrap::Mirror), whole = reliefPeriod(map);
    const ScatterMap scatter = makeScatterMap(map, {.directions = 512}),
                     all = makeScatterMap(whole, {.directions = 512});
    const auto sky = [](const Vec3& d) { return Rgb(0, d.x > 0 ? 1 : 0, d.y > 0.5 ? 1 : 0); };
    for (const double side : {1.0, -1.0}) {  // light on the relief, dark in the tile beside it; and the other way
        ScatteredLightOptions options{.light = glm::normalize(Vec3(side, 0.1, 1.2)), .irradiance = Rgb(1, 0, 0)};
        options.sky = sky, options.paths = 512;
        const ScatteredLight light = scatterLight(map, scatter, options), twin = scatterLight(whole, all, options);
        ReliefLightOptions truth = truthOf(options.light, 2000);
        truth.sky = sky, truth.irradiance = options.irradiance;
        const ScatteredLightError error = measureScatteredLight(drawReliefLightSamples(map, truth, 60), light);
        EXPECT_LT(error.indirect, kBar) << side;
        for (const int x : {8, 16, 23})
            EXPECT_LT(glm::length(light.indirect.rgb(x, 12) - twin.indirect.rgb(x, 12)),
                      kBar * glm::length(twin.indirect.rgb(x, 12)) + 1e-3)
                << side << ' ' << x;
    }
    const Vec3 head = glm::normalize(Vec3(-1, 0, 1 + 1e-6));
    const double lit = scatterLight(map, scatter, {.light = head, .bounces = 1}).indirect.at(16, 12, 0);
    EXPECT_GT(lit, 0.02) << "the mirrored slope is lit head-on, the relief itself not at all";
}

TEST(ScatteredLight, ReliefsOfAnyWrapAgreeWithTracedPaths) {
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror}) {
        const HeightMap map = roughMap(24, 24, 5, wrap);  // small: most of what it sees is beyond a border
        const ScatterMap scatter = makeScatterMap(map, {.directions = 512});
        for (const Vec3& light : {kLow, kHigh}) {
            const ScatteredLightError error = measureScatteredLight(drawReliefLightSamples(map, truthOf(light, 3000)),
                                                                    scatterLight(map, scatter, {.light = light}));
            EXPECT_LT(error.indirect, kIndirect) << toString(wrap);
            EXPECT_LT(error.total, kBar) << toString(wrap);
        }
    }
}

TEST(ScatteredLight, ShallowReliefsToo) {  // what they see is near the plane, where a cosine has few directions
    for (const float amplitude : {0.5f, 2.0f}) {
        const HeightMap map = roughMap(64, 64, amplitude);
        const ScatteredLightError error =
            measureScatteredLight(drawReliefLightSamples(map, truthOf(kHigh, 40000), 100),
                                  scatterLight(map, makeScatterMap(map, {.directions = 256}), {.light = kHigh}));
        EXPECT_LT(error.indirect, kIndirect) << amplitude;
        EXPECT_LT(std::abs(error.bias), kBar) << amplitude;
    }
}

TEST(ScatteredLight, WhiteFurnace) {  // what doesn't come out after B bounces is still inside: it falls to nothing
    const HeightMap map = roughMap(24, 24, 4);
    for (const int directions : {32, 64}) {
        const ScatterMap scatter = makeScatterMap(map, {.directions = directions});
        ScatteredLightOptions options{
            .irradiance = Rgb(0), .sky = [](const Vec3&) { return Rgb(2); }, .albedo = Rgb(1)};
        options.bounces = 300, options.paths = 8;
        const Image total = scatterLight(map, scatter, options).total();
        for (const float v : total.data()) EXPECT_NEAR(v, 2, 1e-5);
    }
}

TEST(ScatteredLight, SkyOfOneSideLightsWhatFacesIt) {  // a furnace alone proves little
    const HeightMap map = waves(64);
    ReliefLightOptions truth = truthOf(kHigh, 3000);
    ScatteredLightOptions options{.light = kHigh};
    truth.sky = options.sky = [](const Vec3& d) { return d.x > 0 ? Rgb(1, 0.5, d.z) : Rgb(0); };
    truth.irradiance = options.irradiance = Rgb(0.5, 1, 2);
    const ScatteredLightError error = measureScatteredLight(
        drawReliefLightSamples(map, truth), scatterLight(map, makeScatterMap(map, {.directions = 256}), options));
    EXPECT_LT(error.total, kBar);
    EXPECT_LT(error.indirect, kBar) << "with the sky, which all 256 directions sum";
}

TEST(ScatteredLight, FlatReliefHasDirectLightAlone) {
    const HeightMap map = flatMap(7, 5, 3);
    const ScatterMap scatter = makeScatterMap(map);
    for (const bool meet : {true, false}) {
        ScatteredLightOptions options{.light = kHigh, .irradiance = {1, 2, 3}};
        options.pathsMeet = meet;
        const ScatteredLight light = scatterLight(map, scatter, options);
        EXPECT_EQ(largest(light.indirect), 0);
        EXPECT_EQ(largest(light.sky), 0);
        EXPECT_NEAR(light.direct.at(6, 4, 2), 3 * 0.7 / kPi * kHigh.z, kRounding);
    }
}

TEST(ScatteredLight, EachBounceAddsLess) {
    const HeightMap map = roughMap(48, 48, 9);
    const ScatterMap scatter = makeScatterMap(map, {.directions = 64});
    double before = 0, step = std::numeric_limits<double>::infinity();
    for (int bounces = 0; bounces <= 4; ++bounces) {
        const double sum =
            sumOf(scatterLight(map, scatter, {.light = kHigh, .bounces = bounces, .paths = 256}).indirect);
        if (bounces == 0) {
            EXPECT_EQ(sum, 0);
        } else {
            EXPECT_GT(sum, before) << bounces;
            EXPECT_LT(sum - before, 0.7 * step) << bounces;
            step = sum - before;
        }
        before = sum;
    }
}

TEST(ScatteredLight, AlbedoBleeds) {  // a white floor beside a red wall
    HeightMap map = flatMap(32, 4);
    map.wrap = Wrap::Clamp;
    ScatteredLightOptions options{
        .light = glm::normalize(Vec3(-1, 0, 1)), .albedo = Rgb(1), .albedoMap = Image(32, 4, 3)};
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 32; ++x) {
            map.heights.at(x, y, 0) = x >= 20 ? 8 : 0;
            options.albedoMap.setRgb(x, y, x >= 19 ? Rgb(0.8, 0.1, 0) : Rgb(0.8));
        }
    options.bounces = 1;
    for (const bool meet : {true, false}) {
        options.pathsMeet = meet;
        const Rgb floor = scatterLight(map, makeScatterMap(map, {.directions = 128}), options).indirect.rgb(16, 2);
        EXPECT_GT(floor.r, 0.01);
        EXPECT_LT(floor.g, 0.4 * floor.r);
        EXPECT_LT(floor.b, 0.3 * floor.r);
    }
}

TEST(ScatteredLight, ViewerMattersToOtherBrdfs) {  // a lobe that sends light back where it came from
    const HeightMap map = waves(32);
    const ScatterMap scatter = makeScatterMap(map, {.directions = 64});
    ScatteredLightOptions options{.light = kHigh};
    options.albedo = Rgb(1);
    options.brdf = [](const Vec3& wi, const Vec3& wo) { return Rgb(std::pow(std::max(0.0, glm::dot(wi, wo)), 20)); };
    options.viewer = kHigh;
    const double back = sumOf(scatterLight(map, scatter, options).direct);
    options.viewer = Vec3(-kHigh.x, -kHigh.y, kHigh.z);
    EXPECT_LT(sumOf(scatterLight(map, scatter, options).direct), 0.5 * back);
}

TEST(ScatteredLight, SameBitsForAnyThreadCount) {
    const HeightMap map = roughMap(33, 21, 4, Wrap::Mirror);
    const ScatterMap scatter = makeScatterMap(map, {.directions = 40});
    for (const bool meet : {true, false}) {
        ScatteredLightOptions options{
            .light = kLow, .sky = [](const Vec3& d) { return Rgb(d.x, 1, d.y); }, .paths = 17};
        options.pathsMeet = meet, options.threads = 1;
        const Image one = scatterLight(map, scatter, options).total();
        options.threads = 5;
        EXPECT_EQ(one.data(), scatterLight(map, scatter, options).total().data());
    }
}

TEST(ScatteredLight, HardReliefs) {
    HeightMap holes = roughMap(12, 9, 4), spike = flatMap(9, 9), nothing = flatMap(4, 4);
    for (int i = 0; i < 40; ++i) holes.heights.data()[static_cast<std::size_t>(i * 7 % 108)] = std::nanf("");
    spike.heights.at(4, 4, 0) = 100;
    for (float& z : nothing.heights.data()) z = std::nanf("");
    for (HeightMap map : {flatMap(1, 1), roughMap(1, 40, 3), roughMap(40, 1, 3), holes, spike, nothing,
                          roughMap(8, 8, 1e6f), roughMap(8, 8, 1e-6f)})
        for (const Wrap wrap : {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror})
            for (const bool meet : {true, false}) {
                map.wrap = wrap;
                ScatteredLightOptions options{.light = kLow, .sky = [](const Vec3&) { return Rgb(1); }, .paths = 9};
                options.pathsMeet = meet;
                const ScatteredLight light = scatterLight(map, makeScatterMap(map, {.directions = 16}), options);
                EXPECT_LT(largest(light.total()), 3) << map.width() << ' ' << map.height();  // no NaN, no infinity
                for (std::size_t i = 0; i < map.heights.data().size(); ++i)
                    EXPECT_TRUE(!std::isnan(map.heights.data()[i]) || light.total().data()[3 * i] == 0);
            }
}

TEST(ScatteredLight, HolesDontDarkenWhatIsBesideThem) {  // a valley with a hole behind its lit slope's crest
    HeightMap map{Image(17, 5, 1), Wrap::Clamp};
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 17; ++x) map.heights.at(x, y, 0) = static_cast<float>(std::abs(x - 8));
    ScatteredLightOptions options{.light = glm::normalize(Vec3(1, 0, 1.01)), .paths = 512};
    const ScatterMap whole = makeScatterMap(map, {.directions = 512});
    const double before = scatterLight(map, whole, options).indirect.at(12, 2, 0);
    for (int y = 0; y < 5; ++y) map.heights.at(16, y, 0) = map.heights.at(0, y, 0) = std::nanf("");
    const double after = scatterLight(map, makeScatterMap(map, {.directions = 512}), options).indirect.at(12, 2, 0);
    EXPECT_GT(before, 0.01);
    EXPECT_NEAR(after, before, 0.2 * before) << "one texel of eight is gone";
}

TEST(ScatteredLight, LightsThatShineOnNothing) {
    const HeightMap map = roughMap(24, 24, 6);
    const ScatterMap scatter = makeScatterMap(map, {.directions = 32});
    for (const Vec3& light : {Vec3(0, 0, -1), glm::normalize(Vec3(1, 0, -0.01))})
        EXPECT_EQ(largest(scatterLight(map, scatter, {.light = light}).total()), 0);
    const double horizon = largest(scatterLight(map, scatter, {.light = Vec3(1, 0, 0)}).total());
    EXPECT_GT(horizon, 0) << "crests see the horizon";
    EXPECT_LT(horizon, 1);
    EXPECT_EQ(largest(scatterLight(flatMap(4, 4), makeScatterMap(flatMap(4, 4)), {.light = Vec3(0, 1, 0)}).total()), 0);
}

TEST(ScatteredLight, RejectsBadOptions) {
    const HeightMap map = flatMap(4, 4);
    const ScatterMap scatter = makeScatterMap(map, {.directions = 4});
    const auto rejects = [&](const ScatteredLightOptions& options) {
        EXPECT_THROW(scatterLight(map, scatter, options), std::invalid_argument);
    };
    rejects({.light = {1, 1, 1}});
    rejects({.irradiance = Rgb(std::numeric_limits<double>::infinity())});
    rejects({.albedoMap = Image(3, 4, 3)});
    rejects({.normals = Image(4, 4, 1)});
    rejects({.viewer = Vec3(0)});
    rejects({.bounces = -1});
    rejects({.paths = 0});
    rejects({.detail = 2});
    EXPECT_THROW(scatterLight(flatMap(4, 5), scatter), std::invalid_argument);
    EXPECT_THROW(scatterLight(map, {}), std::invalid_argument);
    EXPECT_THROW(refinedRelief(map, 2), std::invalid_argument);
    EXPECT_THROW(scatterPaths(0, 1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
