// The errors of horizons, ellipses and scatter maps, on answers whose error is known.
#include "reference/bump_error.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "tests/reference/relief_maps.hpp"

namespace nacre {
namespace {

/// One wall, 2 high, between columns 8 and 9 of 16: half of all horizons are known.
HeightMap stepMap() {
    return makeMap(16, 16, Wrap::Clamp, [](int x, int) { return x >= 9 ? 2 : 0; });
}
/// Of stepMap.
double stepElevation(int x, double azimuth) {
    return x >= 9 ? 0 : std::atan2(2 * std::max(0.0, std::cos(azimuth)), 9 - x);
}

TEST(MeasureHorizons, OfTheRightAnswerIsNothing) {
    const HorizonSamples samples = drawHorizonSamples(stepMap(), 16, 4000);
    const HorizonError e =
        measureHorizons(samples, [](int x, int, int k) { return stepElevation(x, 2 * kPi * k / 16); });
    EXPECT_LT(e.maxRad, 1e-9);
    EXPECT_LT(e.rmseDeg, 1e-7);
    EXPECT_EQ(e.shareWithinMilliRad, 1);
    EXPECT_EQ(e.samples, 4000);
}

TEST(MeasureHorizons, TellsTheAxesFromTheOtherAzimuths) {
    const HorizonSamples samples = drawHorizonSamples(stepMap(), 16, 16000);
    const HorizonError e = measureHorizons(samples, [](int x, int, int k) {
        const double wrong = k == 3 ? 0.02 : k % 4 == 0 ? 0.002 : 0;
        return stepElevation(x, 2 * kPi * k / 16) + wrong;
    });
    constexpr double kDeg = 180 / kPi;
    EXPECT_NEAR(e.maxRad, 0.02, 1e-9);
    EXPECT_NEAR(e.rmseDegAlongAxes, 0.002 * kDeg, 1e-7);
    EXPECT_NEAR(e.rmseDegWorst, 0.02 * kDeg, 1e-7);
    EXPECT_NEAR(e.rmseDeg, std::sqrt((sqr(0.02) + 4 * sqr(0.002)) / 16) * kDeg, 1e-7);
    EXPECT_NEAR(e.shareWithinMilliRad, 11. / 16, 1e-9);
    bool first = true;  // one answer of 16000 that is no number
    const HorizonError bad =
        measureHorizons(samples, [&](int, int, int) { return std::exchange(first, false) ? std::nan("") : 0; });
    for (const double figure : {bad.rmseDeg, bad.rmseDegAlongAxes, bad.rmseDegWorst, bad.maxRad})
        EXPECT_TRUE(std::isnan(figure));
}

TEST(MeasureHorizons, ReadsAStoredMap) {
    HorizonMap stored;
    for (int k = 0; k < 6; ++k) {
        stored.elevation.emplace_back(16, 16, 1);
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x)
                stored.elevation[k].at(x, y, 0) = static_cast<float>(stepElevation(x, 2 * kPi * k / 6) + 0.01);
    }
    EXPECT_NEAR(measureHorizons(drawHorizonSamples(stepMap(), 6, 600), stored).rmseDeg, 0.01 * 180 / kPi, 1e-5);
    EXPECT_THROW(measureHorizons(drawHorizonSamples(stepMap(), 5, 600), stored), std::invalid_argument);
}

TEST(MeasureLit, CountsWhatIsMisjudged) {
    const LitSamples samples = drawLitSamples(stepMap(), 20000);
    const auto truth = [](int x, int, const Vec3& l) {
        return std::atan2(l.z, std::hypot(l.x, l.y)) >= stepElevation(x, std::atan2(l.y, l.x));
    };
    EXPECT_EQ(measureLit(samples, truth).misjudged, 0);
    const LitError all = measureLit(samples, [](int, int, const Vec3&) { return true; });
    // Towards azimuth φ a slope s·cosφ hides (s cosφ)²/(1 + (s cosφ)²) of the cosine-weighted elevations; over the
    // front half of the azimuths that is (1 − 1/√(1 + s²))/2. s = 2/1 … 2/9 at nine of sixteen columns.
    double expected = 0;
    for (int distance = 1; distance <= 9; ++distance) expected += (1 - 1 / std::sqrt(1 + sqr(2. / distance))) / 2 / 16;
    EXPECT_NEAR(all.misjudged, expected, 3 * std::sqrt(expected / 20000));
    EXPECT_EQ(all.misjudged, all.dark);
    EXPECT_EQ(measureLit(samples, [](int, int, const Vec3&) { return false; }).misjudged, 1 - all.dark);
    EXPECT_EQ(all.samples, 20000);
}

TEST(MeasureLit, LightsAreWeightedByTheCosine) {  // mean of z under cosθ/π is 2/3
    double sum = 0;
    const LitSamples samples = drawLitSamples(stepMap(), 20000);
    for (const LitSamples::Sample& s : samples.samples) sum += s.light.z;
    EXPECT_NEAR(sum / 20000, 2. / 3, 0.006);
}

TEST(MeasureSeen, CountsMissesAndPointsApart) {
    const double slope = 0.25;
    const std::vector<Vec3> directions = {glm::normalize(Vec3(1, 0, slope)), glm::normalize(Vec3(-1, 0, slope)),
                                          glm::normalize(Vec3(-1, 0, -slope))};
    const SeenSamples samples = drawSeenSamples(stepMap(), directions, 9000);
    const auto truth = [&](int x, int, int k) {
        if (k == 1) return -1.0;
        if (k == 2) return x == 9 ? 2 / slope : 0.0;  // on the plains at once, from the wall's edge over it
        return x >= 9 || x <= 1 ? -1.0 : 2 * (8.0 - x) / (2 - slope);  // the wall z = 2 (x − 8.5); x = 1 touches
    };
    EXPECT_EQ(measureSeen(samples, truth).hitMismatch, 0);
    EXPECT_EQ(measureSeen(samples, truth).beyondOneTexel, 0);
    const SeenError near = measureSeen(samples, [&](int x, int y, int k) {
        const double d = truth(x, y, k);
        return d < 0 ? d : d + 0.99;
    });
    EXPECT_EQ(near.beyondOneTexel, 0);
    const SeenError apart = measureSeen(samples, [&](int x, int y, int k) {
        const double d = truth(x, y, k);
        return k == 2 ? d + 1.01 : d;
    });
    EXPECT_NEAR(apart.beyondOneTexel, 1. / 3 / apart.hits, 1e-12);
    const SeenError blind = measureSeen(samples, [](int, int, int) { return -1; });
    EXPECT_EQ(blind.hitMismatch, blind.hits);
    EXPECT_EQ(measureSeen(samples, [](int, int, int) { return 0; }).hitMismatch, 1 - blind.hits);
    EXPECT_EQ(measureSeen(samples, [](int, int, int) { return std::nan(""); }).beyondOneTexel, 1);
}

TEST(MeasureSeen, ReadsAStoredMap) {
    ScatterMap stored;
    stored.directions = {{0, 0, -1}, {0, 0, 1}};
    for (const float distance : {0.f, -1.f}) {
        stored.distance.emplace_back(16, 16, 1);
        for (float& v : stored.distance.back().data()) v = distance;
    }
    const SeenSamples samples = drawSeenSamples(stepMap(), stored.directions, 100);
    EXPECT_EQ(measureSeen(samples, stored).hitMismatch, 0);
    std::swap(stored.distance[0], stored.distance[1]);
    EXPECT_EQ(measureSeen(samples, stored).hitMismatch, 1);
    stored.directions.pop_back();
    EXPECT_THROW(measureSeen(samples, stored), std::invalid_argument);
}

TEST(BumpError, SamplesAvoidHolesAndDependOnNoThreadCount) {
    HeightMap map = roughMap(20, 9, Wrap::Repeat, 2);
    for (int y = 0; y < 9; ++y) map.heights.at(y * 2, y, 0) = kHole;
    const LitSamples a = drawLitSamples(map, 500, 3, 1), b = drawLitSamples(map, 500, 3, 5);
    const HorizonSamples c = drawHorizonSamples(map, 7, 500, 3, 1), d = drawHorizonSamples(map, 7, 500, 3, 5);
    const std::vector<Vec3> directions = {{0.6, 0, 0.8}, {0, -0.8, 0.6}};
    const SeenSamples e = drawSeenSamples(map, directions, 500, 3, 1), f = drawSeenSamples(map, directions, 500, 3, 5);
    for (std::size_t i = 0; i < 500; ++i) {
        EXPECT_FALSE(std::isnan(map.at(a.samples[i].x, a.samples[i].y)));
        EXPECT_EQ(a.samples[i].lit, b.samples[i].lit);
        EXPECT_EQ(a.samples[i].light, b.samples[i].light);
        EXPECT_EQ(c.samples[i].elevation, d.samples[i].elevation);
        EXPECT_EQ(e.samples[i].distance, f.samples[i].distance);
    }
    for (float& z : map.heights.data()) z = kHole;
    EXPECT_THROW(drawLitSamples(map), std::invalid_argument);
    EXPECT_THROW(drawLitSamples(stepMap(), 0), std::invalid_argument);
    EXPECT_THROW(drawHorizonSamples(stepMap(), 0), std::invalid_argument);
    EXPECT_THROW(drawSeenSamples(stepMap(), {}), std::invalid_argument);
    EXPECT_THROW(drawSeenSamples(stepMap(), {{1, 1, 0}}), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
