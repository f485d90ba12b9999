#include "core/fresnel.hpp"

#include <gtest/gtest.h>

#include <complex>

using namespace nacre;

constexpr double kRounding = 1e-12;  // direct complex arithmetic against the stable forms, away from cancellation

namespace {
/// Fresnel's equations in complex numbers, straight from Snell's law.
double complexFresnel(double c, std::complex<double> n) {
    const std::complex<double> ct = std::sqrt(1.0 - (1.0 - c * c) / (n * n));
    return 0.5 * (std::norm((c - n * ct) / (c + n * ct)) + std::norm((ct - n * c) / (ct + n * c)));
}
}  // namespace

TEST(Fresnel, AgreesWithComplexSnell) {
    for (double eta : {0.05, 0.6, 1.01, 1.5, 3.0, 200.0})
        for (double k : {0.0, 0.01, 1.0, 4.0, 200.0})
            for (double c : {1e-6, 0.01, 0.2, 0.5, 0.9, 1.0}) {
                const double expected = complexFresnel(c, {eta, k});
                EXPECT_NEAR(fresnelConductor(c, eta, k), expected, kRounding) << eta << " " << k << " " << c;
                if (k > 0) continue;
                EXPECT_NEAR(fresnelDielectric(c, eta), expected, kRounding) << eta << " " << c;
            }
}

TEST(Fresnel, NoInterfaceReflectsNothingEvenGrazing) {
    for (double c : {0.0, 1e-300, 1e-12, 0.5, 1.0}) {
        EXPECT_EQ(fresnelDielectric(c, 1.0), 0.0);
        EXPECT_EQ(fresnelConductor(c, 1.0, 0.0), 0.0);
    }
}

TEST(Fresnel, GrazingIsOneAndNormalIncidenceIsClosedForm) {
    for (double eta : {1.0001, 1.5, 200.0}) {
        EXPECT_NEAR(fresnelDielectric(0, eta), 1, kRounding);
        EXPECT_NEAR(fresnelDielectric(1, eta), normalReflectance(eta), kRounding);
        EXPECT_NEAR(fresnelConductor(0, eta, 2), 1, kRounding);
        EXPECT_NEAR(fresnelConductor(1, eta, 2), normalReflectance(eta, 2), kRounding);
    }
    EXPECT_NEAR(normalReflectance(1.5), 0.04, kRounding);
    EXPECT_EQ(fresnelSchlick(1, 0.04), 0.04);
    EXPECT_EQ(fresnelSchlick(0, 0.04), 1.0);
    EXPECT_EQ(fresnelSchlick(0.5, Rgb(0.2, 0.5, 1)).g, 0.5 + 0.5 * schlickWeight(0.5));
}

// To first order in κ = η² − 1: g − c = κ/(2c), so F = ½ (κ/(4c²))² (1 + (2c² − 1)²). Subtracting c from g would leave
// three digits of it.
TEST(Fresnel, NearlyNoInterfaceKeepsItsDigits) {
    const double eta = 1 + 1e-12, kappa = (eta - 1) * (eta + 1);
    for (double c : {0.3, 0.7, 1.0}) {
        const double expected = 0.5 * sqr(kappa / (4 * c * c)) * (1 + sqr(2 * c * c - 1));
        EXPECT_NEAR(fresnelDielectric(c, eta) / expected, 1, 1e-9) << c;
        EXPECT_NEAR(fresnelConductor(c, eta, 0) / expected, 1, 1e-9) << c;
    }
}

TEST(Fresnel, TotalInternalReflection) {  // η = 1/1.5: critical angle asin(1/1.5), cos = 0.745
    for (double c : {0.0, 0.3, 0.74}) {
        EXPECT_EQ(fresnelDielectric(c, 1 / 1.5), 1.0);
        EXPECT_NEAR(fresnelConductor(c, 1 / 1.5, 0), 1.0, kRounding);
    }
    EXPECT_LT(fresnelDielectric(0.76, 1 / 1.5), 0.9);
}

TEST(Fresnel, BrewsterAngleHasHalfTheSPolarisation) {  // tanθ = η: Rp = 0, so F = Rs/2 = ½((η² − 1)/(η² + 1))²
    const double eta = 1.5, c = 1 / std::sqrt(1 + eta * eta);
    EXPECT_NEAR(fresnelDielectric(c, eta), 0.5 * sqr((eta * eta - 1) / (eta * eta + 1)), kRounding);
}

TEST(Fresnel, WithinZeroAndOneEverywhere) {
    for (double eta : {0.01, 0.999999, 1.0, 1.000001, 200.0})
        for (double k : {0.0, 1e-9, 1.0, 200.0})
            for (int i = 0; i <= 1000; ++i)
                for (double f : {fresnelConductor(i / 1000.0, eta, k), fresnelDielectric(i / 1000.0, eta)})
                    ASSERT_TRUE(f >= 0 && f <= 1) << eta << " " << k << " " << i;
}
