// The split reflectance against a plain integral over light directions, its limits, and the white furnace.
#include "envmaps/scale_bias.hpp"

#include <gtest/gtest.h>

#include "core/fresnel.hpp"
#include "core/sampling.hpp"
#include "reference/microfacet_terms.hpp"

namespace nacre {
namespace {

/// ∫ D G2 F/(4 n·l n·v) n·l dω with F = 1 (scale + bias) and (1 − v·h)⁵ (bias), midpoint rule over light directions.
ScaleBias bruteForce(double cosV, double alpha) {
    const int steps = 900;
    const Vec3 v(std::sqrt(1 - cosV * cosV), 0, cosV);
    const double lambdaV = terms::ggxLambda(std::acos(cosV), 0, alpha, alpha);
    ScaleBias out{0, 0};
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            const double theta = kPi / 2 * (i + 0.5) / steps, phi = 2 * kPi * (j + 0.5) / steps;
            const Vec3 l(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
            const Vec3 h = glm::normalize(l + v);
            const double d = terms::ggx(std::acos(std::min(1.0, h.z)), 0, alpha, alpha);
            const double g = 1 / (1 + lambdaV + terms::ggxLambda(theta, 0, alpha, alpha));
            const double weight = d * g / (4 * cosV) * std::sin(theta) * (kPi / 2 / steps) * (2 * kPi / steps);
            const double fresnel = schlickWeight(glm::dot(v, h));
            out.scale += weight * (1 - fresnel);
            out.bias += weight * fresnel;
        }
    return out;
}

TEST(ScaleBias, IsTheIntegralOverLight) {
    for (const double alpha : {0.1, 0.4, 1.0})
        for (const double cosV : {0.1, 0.5, 1.0}) {
            const ScaleBias found = integrateScaleBias(cosV, alpha), expected = bruteForce(cosV, alpha);
            EXPECT_NEAR(found.scale, expected.scale, 1e-3) << alpha << " " << cosV;
            EXPECT_NEAR(found.bias, expected.bias, 1e-3) << alpha << " " << cosV;
        }
}

TEST(ScaleBias, SmoothSurfaceIsSchlicksFresnel) {
    for (const double cosV : {1e-3, 0.2, 0.9}) {
        const ScaleBias s = integrateScaleBias(cosV, 1e-4);
        EXPECT_NEAR(s.bias, schlickWeight(cosV), 1e-2);
        EXPECT_NEAR(s.scale + s.bias, 1, 0.05);  // a little is lost at grazing, however smooth
    }
}

TEST(ScaleBias, TableHoldsTheIntegralBetweenItsTexels) {
    const AssetTexture table = bakeScaleBias(64);
    for (const double p : {0.1, 0.33, 0.7, 1.0})
        for (const double cosV : {0.01, 0.13, 0.5, 0.97}) {
            const ScaleBias found = lookupScaleBias(table, cosV, p), expected = integrateScaleBias(cosV, p * p, 128);
            EXPECT_NEAR(found.scale, expected.scale, 3e-3) << p << " " << cosV;
            EXPECT_NEAR(found.bias, expected.bias, 3e-3) << p << " " << cosV;
        }
    EXPECT_EQ(bakeScaleBias(16, TexelFormat::Half, 1).image.data(),
              bakeScaleBias(16, TexelFormat::Half, 0).image.data());
}

TEST(ScaleBias, WhiteFurnaceWithMultipleScattering) {
    for (const double p : {0.0, 0.3, 1.0})
        for (const double cosV : {0.05, 0.5, 1.0}) {
            const ScaleBias s = integrateScaleBias(cosV, std::max(1e-4, p * p));
            EXPECT_NEAR(multipleScattering(Rgb(1), s).x, 1, 1e-12);
            const Rgb grey = multipleScattering(Rgb(0.04), s);
            EXPECT_GE(grey.x, 0.04 * s.scale + s.bias);
            EXPECT_LE(grey.x, 1);
        }
}

TEST(ScaleBias, RejectsBadArguments) {
    EXPECT_THROW(integrateScaleBias(0, 0.5), std::invalid_argument);
    EXPECT_THROW(integrateScaleBias(0.5, 0), std::invalid_argument);
    EXPECT_THROW(integrateScaleBias(0.5, 1.1), std::invalid_argument);
    EXPECT_THROW(bakeScaleBias(1), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
