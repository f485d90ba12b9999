#include "reference/sphere_psnr.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "reference/tone.hpp"

using namespace nacre;

TEST(SpherePsnr, IdenticalSpheresReachTheCeiling) {
    const BrdfFunction f = [](auto& wi, auto&) { return Rgb(wi.z); };
    EXPECT_EQ(spherePsnr(f, f), 200);
}

TEST(SpherePsnr, WhiteSphereAgainstNothingHasTheErrorOfAPicture) {
    // f·cosθi = 1 at every lit pixel: white is 1.5, the value sRGB(2/3), the difference to black that value.
    const BrdfFunction flat = [](const Vec3& wi, const Vec3&) { return Rgb(1 / wi.z); };
    const BrdfFunction black = [](auto&, auto&) { return Rgb(0); };
    EXPECT_NEAR(spherePsnr(black, flat), -20 * std::log10(srgbEncode(1 / 1.5)), 1e-9);
}

TEST(SpherePsnr, DarkMaterialsAreNotStretchedToWhite) {  // f·cosθi = 1e-3: white stays 0.05
    const BrdfFunction flat = [](const Vec3& wi, const Vec3&) { return Rgb(1e-3 / wi.z); };
    const BrdfFunction black = [](auto&, auto&) { return Rgb(0); };
    EXPECT_NEAR(spherePsnr(black, flat), -20 * std::log10(srgbEncode(1e-3 / 0.05)), 1e-9);
}

TEST(SpherePsnr, TangentCirclesTheVerticalAxis) {
    // t ∥ y × n = (n.z, 0, -n.x), so t·y = 0; b = n × t has b·y > 0. For the view z: wo = (t.z, b.z, n.z), and with
    // n = (sin a cos e, sin e, cos a cos e): t = (cos a, 0, -sin a), b = (-sin a sin e, cos e, -cos a sin e).
    const BrdfFunction probe = [&](const Vec3& wi, const Vec3& wo) {
        const double a = -std::asin(wo.x), cosE = wo.z / std::cos(a), sinE = -wo.y / std::cos(a);
        EXPECT_NEAR(cosE * cosE + sinE * sinE, 1, 1e-9);
        const Vec3 t(std::cos(a), 0, -std::sin(a)), b(-std::sin(a) * sinE, cosE, -std::cos(a) * sinE);
        const Vec3 n(std::sin(a) * cosE, sinE, std::cos(a) * cosE);
        EXPECT_NEAR((wi.x * t + wi.y * b + wi.z * n).y, std::sin(20 * kPi / 180), 1e-9);  // every light's elevation
        return Rgb(1);
    };
    spherePsnr(probe, probe, 1);
}

TEST(Tone, SrgbHasItsPublishedPoints) {
    EXPECT_EQ(srgbEncode(-1), 0);
    EXPECT_NEAR(srgbEncode(0.0031308), 0.04045, 1e-5);
    EXPECT_NEAR(srgbEncode(0.2140411), 0.5, 1e-6);
    EXPECT_NEAR(srgbEncode(2), 1, 1e-15);
    EXPECT_NEAR(psnrOfMeanSquare(1e-4), 40, 1e-9);
}
