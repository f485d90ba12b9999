#include "bump/horizon_ellipses.hpp"

#include <gtest/gtest.h>

#include "bump/ellipse_fit.hpp"
#include "reference/bump_error.hpp"
#include "tests/bump/relief_fixtures.hpp"

namespace nacre {
namespace {

bool litAt(const HorizonEllipse& e, double x, double y) {
    return ellipseValue(e, {x, y, std::sqrt(std::max(0.0, 1 - x * x - y * y))}) >= 0;
}

/// Lit radii of the unit disk's part within an ellipse around the zenith.
std::vector<float> radiiOf(const HorizonEllipse& e, int count) {
    std::vector<float> out;
    for (int k = 0; k < count; ++k) {
        const double c = std::cos(2 * kPi * k / count), s = std::sin(2 * kPi * k / count);
        double low = 0, high = 1;
        if (litAt(e, c, s)) low = 1;
        for (int i = 0; i < 40 && low < 1; ++i)
            (litAt(e, c * (low + high) / 2, s * (low + high) / 2) ? low : high) = (low + high) / 2;
        out.push_back(static_cast<float>(low));
    }
    return out;
}

TEST(HorizonEllipse, FollowsEquations7To9) {
    const Vec2 centre(0.2, -0.1), axis(0.6, 0.8);
    const double r1 = 0.7, r2 = 0.3;
    const HorizonEllipse e = ellipseFromAxes(centre, axis, r1, r2);
    for (const Vec2& l : {Vec2(0.1, 0.2), Vec2(0.6, 0.4), Vec2(-0.3, 0.5), Vec2(0.2, -0.1)}) {
        const double x = glm::dot(axis, l - centre), y = glm::dot(Vec2(-axis.y, axis.x), l - centre);
        EXPECT_NEAR(ellipseValue(e, {l.x, l.y, 0}), 1 - sqr(x / r1) - sqr(y / r2), 1e-12);
    }
    EXPECT_THROW(ellipseFromAxes(centre, axis, 0, 1), std::invalid_argument);
    EXPECT_THROW(ellipseFromAxes(centre, {0, 0}, 1, 1), std::invalid_argument);
}

TEST(EllipseFitter, FindsEllipsesThatAreThere) {
    constexpr double kArea = 0.004;  // of the disk: what the simplex leaves
    for (const HorizonEllipse& truth :
         {ellipseFromAxes({0, 0}, {1, 0}, 0.9, 0.4), ellipseFromAxes({0.3, -0.2}, {1, 2}, 0.6, 0.5),
          ellipseFromAxes({-0.5, 0.1}, {1, -1}, 1.4, 0.8), ellipseFromAxes({0.9, 0}, {0, 1}, 3, 1.2)}) {
        const EllipseFitter fitter(128, EllipseFit::Full);
        const HorizonEllipse found = fitter.fit(radiiOf(truth, 128));
        int wrong = 0, all = 0;
        for (double x = -0.99; x < 1; x += 0.02)
            for (double y = -0.99; y < 1; y += 0.02) {
                if (x * x + y * y > 1) continue;
                ++all;
                wrong += litAt(found, x, y) != litAt(truth, x, y);
            }
        EXPECT_LE(wrong, kArea * all);
    }
}

TEST(EllipseFitter, AllLitAllDarkAndALine) {
    for (const EllipseFit fit : {EllipseFit::Full, EllipseFit::Radii}) {
        const EllipseFitter fitter(64, fit);
        const HorizonEllipse lit = fitter.fit(std::vector<float>(64, 1)), dark = fitter.fit(std::vector<float>(64, 0));
        for (const Vec2& l : {Vec2(0, 0), Vec2(1, 0), Vec2(0, -1), Vec2(-0.7, 0.7)}) {
            EXPECT_TRUE(litAt(lit, l.x, l.y));
            EXPECT_FALSE(litAt(dark, l.x, l.y));
        }
    }
    std::vector<float> line(64, 0.01f);
    line[0] = line[32] = 1;
    const HorizonEllipse e = EllipseFitter(64, EllipseFit::Full).fit(line);
    EXPECT_FALSE(litAt(e, 0, 0.3));
    for (const double v : {e.m11, e.m12, e.m22, e.o1, e.o2}) EXPECT_LT(std::abs(v), 65504) << "fits half floats";
}

TEST(HorizonEllipses, BeatTheRadiiOnlyFitByAQuarter) {
    const HeightMap map = roughMap(96, 96, 6);
    const LitSamples samples = drawLitSamples(map, 20000);
    const auto misjudged = [&](EllipseFit fit) {
        const EllipseMap ellipses = fitEllipses(map, {.fit = fit});
        return measureLit(samples, [&](int x, int y, const Vec3& l) { return ellipseValue(ellipses.at(x, y), l) >= 0; })
            .misjudged;
    };
    const double full = misjudged(EllipseFit::Full), radii = misjudged(EllipseFit::Radii);
    EXPECT_LE(full, 0.04);
    EXPECT_LE(full, 0.75 * radii);
}

TEST(HorizonEllipses, FlatReliefIsAlwaysLitAndSeesTheWholeSky) {
    const EllipseMap ellipses = fitEllipses(flatMap(5, 7));
    EXPECT_TRUE(litAt(ellipses.at(2, 3), 0.999, 0));
    EXPECT_FLOAT_EQ(ellipses.offset.at(2, 3, 2), 1);
}

TEST(HorizonEllipses, PitOfASpikedFieldSeesLittle) {
    HeightMap map = flatMap(9, 9, 100);
    map.heights.at(4, 4, 0) = 0;
    const EllipseMap ellipses = fitEllipses(map);
    EXPECT_LT(ellipses.offset.at(4, 4, 2), 1e-3f);
    EXPECT_FALSE(litAt(ellipses.at(4, 4), 0.5, 0.5));
}

TEST(HorizonEllipses, SameBitsForAnyThreadCount) {
    const HeightMap map = roughMap(30, 20, 4);
    const EllipseMap one = fitEllipses(map, {.directions = 32, .threads = 1}),
                     five = fitEllipses(map, {.directions = 32, .threads = 5});
    EXPECT_EQ(one.shape.data(), five.shape.data());
    EXPECT_EQ(one.offset.data(), five.offset.data());
}

TEST(HorizonEllipses, RejectsBadInput) {
    EXPECT_THROW(fitEllipses(flatMap(2, 2), {.directions = 4}), std::invalid_argument);
    EXPECT_THROW(fitEllipses({}), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
