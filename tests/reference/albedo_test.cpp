#include "reference/albedo.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/directions.hpp"

using namespace nacre;

namespace {
constexpr double kQuadrature = 3e-3;  // 4096 points; measured 1e-3
}

TEST(Albedo, LambertReflectsItsAlbedoAtEveryAngle) {
    const BrdfFunction f = [](auto&, auto&) { return Rgb(0.2, 0.5, 1) / kPi; };
    for (double theta : {0.0, 0.7, 1.4, 1.55}) {
        const Rgb a = directionalAlbedo(f, sphericalDirection(theta, 1));
        EXPECT_NEAR(a.r, 0.2, kQuadrature) << theta;
        EXPECT_NEAR(a.b, 1, kQuadrature) << theta;
    }
}

TEST(Albedo, PhongLobeReflectsAllAtNormalIncidence) {  // ∫ (n+2)/2π cosⁿ·cos dω = 1
    for (double n : {0.0, 10.0, 1e3, 1e6}) {
        const BrdfFunction f = [n](const Vec3& wi, const Vec3& wo) {
            const double s = -wi.x * wo.x - wi.y * wo.y + wi.z * wo.z;
            return Rgb((n + 2) / (2 * kPi) * std::pow(std::max(s, 0.0), n));
        };
        EXPECT_NEAR(directionalAlbedo(f, Vec3(0, 0, 1)).g, 1, kQuadrature) << n;
    }
}

TEST(Albedo, RejectsViewersBelowTheSurface) {
    const BrdfFunction f = [](auto&, auto&) { return Rgb(1); };
    EXPECT_THROW(directionalAlbedo(f, Vec3(1, 0, 0)), std::invalid_argument);
    EXPECT_THROW(directionalAlbedo(f, Vec3(0, 0, 1), 3), std::invalid_argument);
    EXPECT_THROW(albedoMaxAbs(f, f, 0), std::invalid_argument);
}

TEST(Albedo, LargestErrorIsFoundWhereItIs) {
    const BrdfFunction truth = [](auto&, auto&) { return Rgb(0.5 / kPi); };
    const BrdfFunction wrong = [&](const Vec3& wi, const Vec3& wo) {  // error in one channel, for one azimuth in four
        const bool here = wo.y < 0 || std::atan2(wo.y, wo.x) < kPi / 4;
        return truth(wi, wo) - Rgb(0, here ? 0.1 / kPi : 0, 0);
    };
    EXPECT_NEAR(albedoMaxAbs(wrong, truth, 4), 0.1, kQuadrature);
}
