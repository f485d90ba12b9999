// Rusinkiewicz's half-difference angles: round trips, invariants, and the places where an angle is undefined.
#include "core/directions.hpp"

#include <gtest/gtest.h>

#include "core/sampling.hpp"

namespace nacre {
namespace {

constexpr double kRounding = 1e-12;  // a dozen operations in double, all terms of order 1

void expectNear(const Vec3& a, const Vec3& b, double tolerance, const std::string& what) {
    EXPECT_LE(glm::length(a - b), tolerance)
        << what << ": (" << a.x << ", " << a.y << ", " << a.z << ") and (" << b.x << ", " << b.y << ", " << b.z << ")";
}

TEST(Directions, SphericalDirectionIsUnitWithGivenAngles) {
    const Vec3 d = sphericalDirection(0.3, 1.2);
    EXPECT_NEAR(glm::length(d), 1, kRounding);
    EXPECT_NEAR(std::acos(d.z), 0.3, kRounding);
    EXPECT_NEAR(std::atan2(d.y, d.x), 1.2, kRounding);
}

TEST(Directions, AngleBetweenIsExactWhereAcosIsNot) {
    const Vec3 z(0, 0, 1);
    for (const double angle : {1e-12, 1e-9, 1e-6, 0.1, 1.0, kPi / 2, 3.0, kPi - 1e-9})
        EXPECT_NEAR(angleBetween(z, sphericalDirection(angle, 0.7)) / angle, 1, 1e-7) << angle;
    EXPECT_EQ(angleBetween(z, z), 0);
    EXPECT_DOUBLE_EQ(angleBetween(z, -z), kPi);
}

TEST(Directions, HalfVectorBisects) {
    for (std::uint64_t i = 1; i < 200; ++i) {
        const Vec3 p = halton3(i);
        const Vec3 wi = cosineHemisphere({p.x, p.y}), wo = sphericalDirection(kPi / 2 * p.z, 5 * p.x);
        const Vec3 h = halfVector(wi, wo);
        EXPECT_NEAR(glm::length(h), 1, kRounding);
        EXPECT_NEAR(glm::dot(h, wi), glm::dot(h, wo), kRounding);
    }
}

TEST(Directions, HalfVectorOfOppositeDirectionsIsTheNormal) {
    const Vec3 x(1, 0, 0);
    expectNear(halfVector(x, -x), {0, 0, 1}, 0, "opposite");
}

TEST(HalfDifference, RoundTripFromDirections) {
    for (std::uint64_t i = 0; i < 2000; ++i) {
        const Vec3 p = halton3(i), q = halton3(i + 7919);
        const Vec3 wi = cosineHemisphere({p.x, p.y}), wo = cosineHemisphere({q.x, q.z});
        const DirectionPair back = fromHalfDifference(halfDifference(wi, wo));
        expectNear(back.wi, wi, kRounding, "wi of pair " + std::to_string(i));
        expectNear(back.wo, wo, kRounding, "wo of pair " + std::to_string(i));
    }
}

TEST(HalfDifference, RoundTripFromAngles) {
    for (const double thetaH : {0.01, 0.7, 1.5})
        for (const double phiH : {0.0, 1.0, 3.5, 6.28})
            for (const double thetaD : {0.01, 0.8, 1.5})
                for (const double phiD : {0.0, 0.5, 2.0, 4.0, 6.28}) {
                    const DirectionPair pair = fromHalfDifference({thetaH, phiH, thetaD, phiD});
                    const HalfDifference back = halfDifference(pair.wi, pair.wo);
                    constexpr double kAngle = 1e-10;  // rounding divided by the smallest sine, 0.01
                    EXPECT_NEAR(back.thetaH, thetaH, kAngle);
                    EXPECT_NEAR(std::remainder(back.phiH - phiH, 2 * kPi), 0, kAngle);
                    EXPECT_NEAR(back.thetaD, thetaD, kAngle);
                    EXPECT_NEAR(std::remainder(back.phiD - phiD, 2 * kPi), 0, kAngle);
                }
}

TEST(HalfDifference, SwappingDirectionsTurnsPhiDByPi) {  // reciprocity in these angles
    const Vec3 wi = sphericalDirection(0.4, 0.3), wo = sphericalDirection(1.1, 2.0);
    const HalfDifference a = halfDifference(wi, wo), b = halfDifference(wo, wi);
    EXPECT_NEAR(a.thetaH, b.thetaH, kRounding);
    EXPECT_NEAR(a.thetaD, b.thetaD, kRounding);
    EXPECT_NEAR(std::remainder(a.phiD - b.phiD - kPi, 2 * kPi), 0, kRounding);
}

TEST(HalfDifference, TurningBothAboutTheNormalTurnsPhiHOnly) {
    const HalfDifference a = halfDifference(sphericalDirection(0.4, 0.3), sphericalDirection(1.1, 2.0));
    const HalfDifference b = halfDifference(sphericalDirection(0.4, 1.3), sphericalDirection(1.1, 3.0));
    EXPECT_NEAR(std::remainder(b.phiH - a.phiH - 1, 2 * kPi), 0, kRounding);
    EXPECT_NEAR(a.thetaH, b.thetaH, kRounding);
    EXPECT_NEAR(std::remainder(a.phiD - b.phiD, 2 * kPi), 0, kRounding);
}

TEST(HalfDifference, HalfVectorAtThePole) {  // mirror pair: theta_h = 0, phi_h stated as 0
    const Vec3 wi = sphericalDirection(0.6, 1.0), wo(-wi.x, -wi.y, wi.z);
    const HalfDifference a = halfDifference(wi, wo);
    EXPECT_NEAR(a.thetaH, 0, 1e-15);
    EXPECT_EQ(a.phiH, 0);
    EXPECT_NEAR(a.thetaD, 0.6, kRounding);
    EXPECT_NEAR(a.phiD, 1.0, kRounding);
}

TEST(HalfDifference, EqualDirections) {  // theta_d = 0, phi_d stated as 0; the pair still comes back
    const Vec3 w = sphericalDirection(1.2, 4.0);
    const HalfDifference a = halfDifference(w, w);
    EXPECT_NEAR(a.thetaD, 0, 1e-15);
    EXPECT_EQ(a.phiD, 0);
    expectNear(fromHalfDifference(a).wi, w, kRounding, "wi");
}

TEST(HalfDifference, BothAtTheNormal) {
    const HalfDifference a = halfDifference({0, 0, 1}, {0, 0, 1});
    EXPECT_EQ(a.thetaH, 0);
    EXPECT_EQ(a.phiH, 0);
    EXPECT_EQ(a.thetaD, 0);
    EXPECT_EQ(a.phiD, 0);
}

TEST(HalfDifference, GrazingOppositeDirections) {  // theta_d = π/2: wi + wo almost vanishes
    for (const double elevationDeg : {0.1, 1e-3, 1e-6}) {
        const double theta = kPi / 2 - elevationDeg * kPi / 180;
        const Vec3 wi = sphericalDirection(theta, 0.5), wo = sphericalDirection(theta, 0.5 + kPi);
        const HalfDifference a = halfDifference(wi, wo);
        // wi + wo is 2·cosθ long and known to 1e-16, so h is known to 1e-16 / cosθ.
        const double known = 1e-15 / std::cos(theta);
        EXPECT_NEAR(a.thetaH, 0, known) << elevationDeg;
        EXPECT_NEAR(a.thetaD, theta, known) << elevationDeg;
        expectNear(fromHalfDifference(a).wi, wi, 10 * known, "wi");
    }
}

TEST(HalfDifference, BackFacingAnglesDipBelowTheHorizon) {  // the inverse says so with z < 0, it doesn't clamp
    const DirectionPair pair = fromHalfDifference({1.4, 0, 1.4, 0});
    EXPECT_LT(std::min(pair.wi.z, pair.wo.z), 0);
}

}  // namespace
}  // namespace nacre
