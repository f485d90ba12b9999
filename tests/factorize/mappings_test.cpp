#include "factorize/mappings.hpp"

#include <gtest/gtest.h>

#include "core/directions.hpp"

namespace nacre {
namespace {

constexpr float kSingle = 3e-5f;  // a dozen roundings in single precision
const std::vector<double> kUnit = {0, 1e-3, 0.1, 0.37, 0.5, 0.82, 0.999, 1};

TEST(Mappings, HalfDiffFollowsItsInverse) {
    constexpr float kSlope = 0.15f;
    for (double u : kUnit)
        for (double v : {0.0, 0.2, 0.7, 0.9}) {
            if (u == 1) continue;  // θh = π/2: half vectors there belong to no pair above the horizon
            const double thetaH = std::atan(inverseHalfDiffSlope(u, kSlope));
            const double thetaD = std::acos(inverseHalfDiffCosine(v));
            const DirectionPair p = fromHalfDifference({thetaH, 0.3, thetaD, 1.2});
            const glm::vec2 uv = mapHalfDiff(halfGeometry(glm::vec3(p.wi), glm::vec3(p.wo)), kSlope);
            EXPECT_NEAR(uv.x, u, 1e-3) << "u=" << u;  // √ near 0 magnifies h's rounding
            EXPECT_NEAR(uv.y, v, 1e-3) << "v=" << v;
        }
}

TEST(Mappings, CosSquaredPhiDMatchesTheAngle) {
    for (double phi : {0.0, 0.4, 1.1, kPi / 2, 2.5}) {
        const DirectionPair p = fromHalfDifference({0.5, 0, 0.4, phi});
        const glm::vec3 wi(p.wi), wo(p.wo);
        EXPECT_NEAR(cosSquaredPhiD(halfGeometry(wi, wo), wi, wo), sqr(std::cos(phi)), kSingle) << phi;
    }
}

TEST(Mappings, CosSquaredPhiDIsFiniteWhereTheAngleIsNot) {
    const glm::vec3 n(0, 0, 1), tilted = glm::normalize(glm::vec3(0.3f, 0.1f, 0.9f));
    EXPECT_EQ(cosSquaredPhiD(halfGeometry(n, n), n, n), 0);
    EXPECT_GE(cosSquaredPhiD(halfGeometry(tilted, tilted), tilted, tilted), 0);
}

TEST(Mappings, ElevationsAreReciprocalAndFollowTheirInverse) {
    for (double u : kUnit)
        for (double v : kUnit) {
            const ElevationPair e = inverseElevations(u, v);
            const auto a = static_cast<float>(e.cosMin), b = static_cast<float>(e.cosMax);
            EXPECT_EQ(mapElevations(a, b), mapElevations(b, a));
            EXPECT_NEAR(mapElevations(a, b).x, u, 2e-3);  // 1 − min is rounded at 6e-8, its root at 2.5e-4
            if (u > 0.05) {
                EXPECT_NEAR(mapElevations(a, b).y, v, 2e-3) << u;
            }
        }
}

TEST(Mappings, DisksFollowTheirInverses) {
    for (bool quadrant : {true, false})
        for (double r : {0.05, 0.3, 0.7, 0.95})
            for (double phi : {0.1, 0.8, 1.4}) {
                const glm::dvec2 disk = r * glm::dvec2(std::cos(phi), std::sin(phi));
                const glm::dvec2 uv = quadrant ? disk : disk * 0.5 + 0.5;
                const glm::dvec2 width(0.1, 0.4);
                const glm::vec2 slope =
                    mapScaledSlope(glm::vec3(inverseScaledSlope(uv, width, quadrant)), 1.0 / width, quadrant);
                const glm::vec2 lambert = mapLambertDisk(glm::vec3(inverseLambertDisk(uv, quadrant)), quadrant);
                for (int c = 0; c < 2; ++c) {
                    EXPECT_NEAR(slope[c], uv[c], kSingle);
                    EXPECT_NEAR(lambert[c], uv[c], kSingle);
                }
            }
}

TEST(Mappings, QuadrantMapsIgnoreTheSideAndFullMapsDoNot) {
    const glm::vec3 w = glm::normalize(glm::vec3(0.4f, 0.2f, 0.7f)), mirrored = w * glm::vec3(-1, 1, 1);
    EXPECT_EQ(mapLambertDisk(w, true), mapLambertDisk(mirrored, true));
    EXPECT_NE(mapLambertDisk(w, false), mapLambertDisk(mirrored, false));
}

TEST(Mappings, LobeFollowsItsInverseAtHugeExponents) {
    for (double w0 : {1e-3, 0.1, 2.5})
        for (double u : kUnit)
            EXPECT_NEAR(mapLobe(static_cast<float>(1 - inverseLobe(u, w0)), static_cast<float>(w0)), u, 1e-3);
}

TEST(Mappings, DifferenceVectorIsRusinkiewiczs) {
    for (double phi : {0.3, 2.0, 4.0}) {
        const DirectionPair p = fromHalfDifference({0.6, 1.0, 0.5, phi});
        const glm::vec3 d = differenceVector(glm::vec3(halfVector(p.wi, p.wo)), glm::vec3(p.wi));
        const Vec3 truth = sphericalDirection(0.5, phi);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(d[c], truth[c], kSingle);
    }
}

TEST(Mappings, CarriedDifferenceIsARotationThatTakesHToTheNormal) {
    for (double phi : {0.3, 2.0, 4.0}) {
        const DirectionPair p = fromHalfDifference({0.6, 1.0, 0.5, phi});
        const glm::vec3 h(halfVector(p.wi, p.wo));
        const glm::vec3 i = carriedDifference(h, glm::vec3(p.wi)), o = carriedDifference(h, glm::vec3(p.wo));
        const glm::vec3 turned = carriedDifference(h, h);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(turned[c], c == 2, kSingle);
        EXPECT_NEAR(glm::length(i), 1, kSingle);
        EXPECT_NEAR(glm::dot(i, o), glm::dot(p.wi, p.wo), kSingle);  // angles are kept
        const glm::vec3 pole = carriedDifference({0, 0, 1}, glm::vec3(p.wi));
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(pole[c], p.wi[c], kSingle);
    }
}

TEST(Mappings, EndsFallOnTexelCentres) {
    EXPECT_FLOAT_EQ(toTexelCentres(0, 16), 0.5f / 16);
    EXPECT_FLOAT_EQ(toTexelCentres(1, 16), 15.5f / 16);
}

}  // namespace
}  // namespace nacre
