// Light on reliefs: closed forms of grooves, a radiosity solution of one, and what holds for every relief.
#include "reference/relief_light.hpp"

#include <gtest/gtest.h>

#include "tests/reference/relief_maps.hpp"

namespace nacre {
namespace {

std::vector<glm::ivec2> allTexels(const HeightMap& map) {
    std::vector<glm::ivec2> out;
    for (int y = 0; y < map.height(); ++y)
        for (int x = 0; x < map.width(); ++x) out.emplace_back(x, y);
    return out;
}

void expectWithin(const Rgb& found, const Rgb& expected, const Rgb& tolerance, const char* what, int where) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], tolerance[c]) << what << " at " << where;
}

/// Grooves along y: texel 0 is a crest, texel kHalf the bottom, walls of slope kSlope.
constexpr int kHalf = 8;
constexpr double kSlope = 1.5;
HeightMap grooves() {
    return makeMap(2 * kHalf, 1, Wrap::Repeat, [](int x, int) { return kSlope * std::abs(x - kHalf); });
}
Vec2 wall(double x) { return {x, kSlope * std::abs(x - kHalf)}; }  // the profile, x counted from the crest's centre
Vec3 wallNormal(double x) { return glm::normalize(Vec3(x < kHalf ? kSlope : -kSlope, 0, 1)); }

/// Share of the cosine about n, in the plane of the profile, between the directions from p to a and to b (a strip that
/// is infinite along y): half the difference of the sines of their angles from n.
double stripShare(const Vec2& p, const Vec2& n, const Vec2& a, const Vec2& b) {
    const auto sine = [&](const Vec2& q) {
        const Vec2 d = glm::normalize(q - p);
        return n.x * d.y - n.y * d.x;
    };
    return std::abs(sine(a) - sine(b)) / 2;
}

/// The groove's walls cut into strips of constant radiance: what leaves the profile's points after so many bounces.
class Radiosity {
public:
    Radiosity(double albedo, const Vec3& light, double sky, int bounces) : albedo_(albedo), light_(light), sky_(sky) {
        std::vector<double> strips(kStrips, 0);
        for (int k = 0; k <= bounces; ++k) {
            before_ = strips;
            for (int i = 0; i < kStrips; ++i) strips[i] = leaving((i + 0.5) * kWidth);
        }
    }
    /// On a wall, at the last bounce.
    double leaving(double x) const {
        const Vec3 normal = wallNormal(x);
        const Vec2 p = wall(x), n(normal.x, normal.z);
        const int first = x < kHalf ? kStrips / 2 : 0;  // the other wall
        double seen = sky_ * skyShare(x);
        for (int i = first; i < first + kStrips / 2; ++i)
            seen += before_[i] * stripShare(p, n, wall(i * kWidth), wall((i + 1) * kWidth));
        return albedo_ * (glm::dot(normal, light_) / kPi + seen);
    }
    /// From the crest of the own wall to that of the other.
    static double skyShare(double x) {
        const Vec3 n = wallNormal(x);
        return stripShare(wall(x), {n.x, n.z}, wall(0), wall(2 * kHalf));
    }

private:
    static constexpr int kStrips = 2 * kHalf * 40;
    static constexpr double kWidth = 2.0 * kHalf / kStrips;
    double albedo_;
    Vec3 light_;
    double sky_;
    std::vector<double> before_;
};

constexpr double kSigmas = 4.5;  // 16 texels a test, 3 channels: one false alarm in 3000 runs of other seeds
constexpr double kStripError = 2e-4;

TEST(ReliefLight, OfAFlatFieldIsDirectAndSky) {
    const HeightMap map = makeMap(3, 2, Wrap::Mirror, [](int, int) { return 2; });
    ReliefLightOptions options;
    options.light = glm::normalize(Vec3(1, 1, 1)), options.irradiance = {3, 2, 1}, options.paths = 10;
    options.sky = [](const Vec3&) { return Rgb(5, 0, 1); };
    for (const TexelLight& light : traceReliefLight(map, allTexels(map), options)) {
        expectWithin(light.direct, 0.7 / kPi * Rgb(3, 2, 1) / std::sqrt(3.), Rgb(1e-12), "direct", 0);
        expectWithin(light.sky, 0.7 * Rgb(5, 0, 1), Rgb(1e-12), "sky", 0);
        EXPECT_EQ(light.indirect, Rgb(0));
        expectWithin(light.standardError, Rgb(0), Rgb(1e-12), "noise", 0);
    }
}

TEST(ReliefLight, OfAGrooveAgreesWithRadiosity) {
    const HeightMap map = grooves();
    for (const int bounces : {0, 1, 4}) {
        ReliefLightOptions options;
        options.light = glm::normalize(Vec3(0.2, 0.3, 1));  // steeper than the walls: nothing is shadowed
        options.normal = [](int x, int) { return wallNormal(x); };
        options.sky = [](const Vec3&) { return Rgb(0.4); };
        options.bounces = bounces, options.paths = 20000;
        const Radiosity expected(0.7, options.light, 0.4, bounces);
        const std::vector<TexelLight> found = traceReliefLight(map, allTexels(map), options);
        for (int x = 1; x < 2 * kHalf; ++x) {
            if (x == kHalf) continue;
            const TexelLight& light = found[x];
            expectWithin(light.total(), Rgb(expected.leaving(x)), kSigmas * light.standardError + kStripError, "all",
                         x);
            expectWithin(light.direct, Rgb(0.7 / kPi * glm::dot(wallNormal(x), options.light)), Rgb(1e-12), "direct",
                         x);
            const double share = Radiosity::skyShare(x), noise = std::sqrt(share * (1 - share) / options.paths);
            EXPECT_NEAR(light.sky.r, 0.7 * 0.4 * share, 0.7 * 0.4 * kSigmas * noise) << x;
            EXPECT_LT(light.standardError.r, 0.01 * light.total().r);
        }
    }
}

TEST(ReliefLight, AtTheBottomOfAGrooveTheWallsAreSeenAtOnce) {
    ReliefLightOptions options;
    options.bounces = 1, options.paths = 40000, options.sky = [](const Vec3&) { return Rgb(1); };
    const std::vector<glm::ivec2> bottom = {{kHalf, 0}}, crest = {{0, 0}};
    const TexelLight low = traceReliefLight(grooves(), bottom, options)[0];
    const double skyShare = stripShare(wall(kHalf), {0, 1}, wall(0), wall(2 * kHalf));
    // A wall beside the bottom sees the sky from its own direction to the other wall's.
    const double wallLight = 0.7 * (wallNormal(1).z / kPi + Radiosity::skyShare(kHalf + 1e-6));
    EXPECT_NEAR(low.sky.r, 0.7 * skyShare, kSigmas * low.standardError.r);
    EXPECT_NEAR(low.indirect.r, 0.7 * (1 - skyShare) * wallLight, kSigmas * low.standardError.r);
    const TexelLight high = traceReliefLight(grooves(), crest, options)[0];
    EXPECT_NEAR(high.sky.r, 0.7, 1e-12);
    EXPECT_EQ(high.indirect, Rgb(0));
}

TEST(ReliefLight, WhiteFurnace) {  // all light comes out again, from texels with any normal
    const HeightMap map = roughMap(9, 8, Wrap::Repeat, 2);
    ReliefLightOptions options;
    options.irradiance = Rgb(0), options.albedo = [](const Vec2&) { return Rgb(1); };
    options.sky = [](const Vec3&) { return Rgb(2); };
    options.bounces = 1000, options.paths = 50;
    for (const TexelLight& light : traceReliefLight(map, allTexels(map), options))
        expectWithin(light.total(), Rgb(2), Rgb(1e-9), "furnace", 0);
}

TEST(ReliefLight, ShadowsFallOnTexelsAndOnWhatTheySee) {  // a low light from −x: the wall at 9 shadows what lies behind
    const HeightMap map = makeMap(24, 1, Wrap::Clamp, [](int x, int) { return x == 9 ? 4 : 0; });
    ReliefLightOptions options;
    options.light = glm::normalize(Vec3(-2, 0, 1));
    options.bounces = 1, options.paths = 2000;
    const std::vector<TexelLight> found = traceReliefLight(map, allTexels(map), options);
    for (int x = 0; x < 24; ++x) EXPECT_EQ(found[x].direct.r > 0, x <= 9 || x >= 17) << x;
    EXPECT_GT(found[6].indirect.r, 0.005) << "faces the wall's lit side";
    EXPECT_EQ(found[13].indirect.r, 0) << "faces the dark one";
}

TEST(ReliefLight, WhatIsSeenMayBeInShadow) {  // from the edge of a cliff, 4 high: its foot is dark for 8 texels
    const HeightMap map = makeMap(24, 1, Wrap::Clamp, [](int x, int) { return x <= 9 ? 4 : 0; });
    ReliefLightOptions options;
    options.light = glm::normalize(Vec3(-2, 0, 1));
    options.normal = [](int, int) { return glm::normalize(Vec3(1, 0, 1)); };
    options.bounces = 1, options.paths = 40000;
    const std::vector<glm::ivec2> edge = {{9, 0}};
    const TexelLight found = traceReliefLight(map, edge, options)[0];
    const double share = stripShare({0, 4}, {std::sqrt(0.5), std::sqrt(0.5)}, {8, 0}, {reachOf(map), 0});
    const double expected = 0.7 * share * 0.7 / kPi * options.light.z;
    constexpr double kReach = 0.005;  // of the share: the reach ends a circle, not a strip
    EXPECT_NEAR(found.indirect.r, expected, kSigmas * found.standardError.r + kReach * expected);
}

TEST(ReliefLight, EachReflectionTakesTheAlbedoOnce) {
    const HeightMap map = roughMap(9, 8, Wrap::Repeat, 2);
    ReliefLightOptions options;
    options.bounces = 1, options.paths = 20, options.light = glm::normalize(Vec3(0.3, 0.1, 1));
    options.albedo = [](const Vec2&) { return Rgb(0.9, 0.3, 0); };
    double sum = 0;
    for (const TexelLight& light : traceReliefLight(map, allTexels(map), options)) {
        EXPECT_NEAR(light.direct.g, light.direct.r / 3, 1e-12);
        EXPECT_NEAR(light.indirect.g, light.indirect.r / 9, 1e-12);
        EXPECT_EQ(light.total().b, 0);
        sum += light.indirect.r;
    }
    EXPECT_GT(sum, 0);
}

TEST(ReliefLight, StandardErrorIsTheSpreadOfSeeds) {
    const HeightMap map = grooves();
    const std::vector<glm::ivec2> texel = {{kHalf - 2, 0}};
    ReliefLightOptions options;
    options.sky = [](const Vec3& d) { return Rgb(d.x > 0 ? 1 : 0, 1, 1); };
    options.paths = 400;
    double sum = 0, squares = 0, claimed = 0;
    constexpr int kSeeds = 400;
    for (int seed = 0; seed < kSeeds; ++seed) {
        options.seed = seed;
        const TexelLight light = traceReliefLight(map, texel, options)[0];
        sum += light.total().r, squares += sqr(light.total().r), claimed += light.standardError.r;
    }
    const double spread = std::sqrt((squares - sqr(sum) / kSeeds) / (kSeeds - 1));
    EXPECT_NEAR(claimed / kSeeds / spread, 1, 0.15);  // the spread of 400 is known to 1/√800
}

TEST(ReliefLight, SameBitsForAnyThreadCountAndSelection) {
    const HeightMap map = roughMap(9, 8, Wrap::Mirror, 2);
    ReliefLightOptions options;
    options.paths = 20, options.sky = [](const Vec3& d) { return Rgb(d.x, 1, d.z); };
    options.threads = 1;
    const std::vector<glm::ivec2> all = allTexels(map), some = {{3, 2}};
    const std::vector<TexelLight> one = traceReliefLight(map, all, options);
    options.threads = 5;
    const std::vector<TexelLight> many = traceReliefLight(map, all, options);
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(one[i].total(), many[i].total());
        EXPECT_EQ(one[i].standardError, many[i].standardError);
    }
    EXPECT_EQ(traceReliefLight(map, some, options)[0].total(), one[2 * 9 + 3].total());
    EXPECT_NE(one[0].total(), one[1].total());
}

TEST(TexelNormal, IsTheMeanOfThePatches) {
    HeightMap map = makeMap(5, 5, Wrap::Clamp, [](int x, int y) { return x * x + 2 * y; });
    const auto slopes = [&](int x, int y) {
        const Vec3 n = texelNormal(map, x, y);
        return Vec2(-n.x / n.z, -n.y / n.z);
    };
    EXPECT_NEAR(glm::length(slopes(2, 2) - Vec2(4, 2)), 0, kExact);
    map.heights.at(3, 2, 0) = kHole;
    EXPECT_NEAR(glm::length(slopes(2, 2) - Vec2(3, 2)), 0, kExact);
    map.heights.at(1, 1, 0) = kHole;
    EXPECT_NEAR(glm::length(slopes(2, 2) - Vec2(3, 2)), 0, kExact) << "one patch is left";
    map.heights.at(1, 2, 0) = kHole;
    EXPECT_NEAR(glm::length(slopes(2, 2)), 0, kExact);
    const std::vector<glm::ivec2> hole = {{3, 2}};
    EXPECT_EQ(traceReliefLight(map, hole, {})[0].total(), Rgb(0));
}

TEST(BilinearAlbedo, GoesOnAsTheRelief) {
    Image image(2, 1, 3);
    image.setRgb(0, 0, {1, 0, 0});
    image.setRgb(1, 0, {0, 1, 0});
    const Vec2 edge(2, 0.5);
    EXPECT_EQ(bilinearAlbedo(image, Wrap::Repeat)({0.5, 0.5}), Rgb(1, 0, 0));
    EXPECT_EQ(bilinearAlbedo(image, Wrap::Repeat)({0.75, 7.1}), Rgb(0.75, 0.25, 0));
    EXPECT_EQ(bilinearAlbedo(image, Wrap::Repeat)(edge), Rgb(0.5, 0.5, 0));
    EXPECT_EQ(bilinearAlbedo(image, Wrap::Clamp)(edge), Rgb(0, 1, 0));
    EXPECT_EQ(bilinearAlbedo(image, Wrap::Mirror)(edge + Vec2(1.5, 0)), Rgb(1, 0, 0));
    EXPECT_THROW(bilinearAlbedo({}, Wrap::Clamp), std::invalid_argument);
}

TEST(ReliefLight, RejectsBadOptions) {
    const HeightMap map = grooves();
    const std::vector<glm::ivec2> inside = {{0, 0}}, outside = {{0, 1}};
    EXPECT_THROW(traceReliefLight(map, outside, {}), std::invalid_argument);
    ReliefLightOptions options;
    options.light = {1, 1, 0};
    EXPECT_THROW(traceReliefLight(map, inside, options), std::invalid_argument);
    options = {}, options.paths = 0;
    EXPECT_THROW(traceReliefLight(map, inside, options), std::invalid_argument);
    options = {}, options.bounces = -1;
    EXPECT_THROW(traceReliefLight(map, inside, options), std::invalid_argument);
    options = {}, options.albedo = nullptr;
    EXPECT_THROW(traceReliefLight(map, inside, options), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
