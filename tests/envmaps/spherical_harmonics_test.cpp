// Real harmonics against the library's Legendre functions, projection against brute force, and irradiance.
#include "envmaps/spherical_harmonics.hpp"

#include <gtest/gtest.h>

#include "core/sampling.hpp"
#include "reference/environment_error.hpp"

namespace nacre {
namespace {

EnvMap bumpy(int size) {
    EnvMap map(EnvLayout::Cube, size);
    for (int y = 0; y < map.image.height(); ++y)
        for (int x = 0; x < size; ++x) {
            const Vec3 d = envTexelDirection(EnvLayout::Cube, size, x, y);
            map.image.setRgb(x, y, Rgb(1 + d.x * d.y, std::exp(2 * d.z), d.y > 0.95 ? 100 : 0.1));
        }
    return map;
}

double definition(int l, int m, const Vec3& d) {
    const double theta = std::atan2(std::hypot(d.x, d.y), d.z), phi = std::atan2(d.y, d.x);
    const double phase = m % 2 ? -1 : 1;  // sph_legendre has it
    if (m == 0) return std::sph_legendre(l, 0, theta);
    const double p = phase * std::sqrt(2.0) * std::sph_legendre(l, std::abs(m), theta);
    return m > 0 ? p * std::cos(m * phi) : p * std::sin(-m * phi);
}

TEST(RealHarmonics, AreTheDefinition) {
    for (const Vec3& d : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), glm::normalize(Vec3(0.3, -0.5, 0.2))}) {
        const std::vector<double> y = realHarmonics(12, d);
        for (int l = 0; l <= 12; ++l)
            for (int m = -l; m <= l; ++m) EXPECT_NEAR(y[l * l + l + m], definition(l, m, d), 1e-12) << l << " " << m;
    }
    const std::vector<double> y =
        realHarmonics(2, glm::normalize(Vec3(1, 2, 3)));  // Ramamoorthi & Hanrahan 2001, eq. 3
    EXPECT_NEAR(y[1], 0.488603 * 2 / std::sqrt(14), 1e-6);
    EXPECT_NEAR(y[2], 0.488603 * 3 / std::sqrt(14), 1e-6);
    EXPECT_NEAR(y[3], 0.488603 * 1 / std::sqrt(14), 1e-6);
    EXPECT_NEAR(y[4], 1.092548 * 2 / 14, 1e-6);
    EXPECT_NEAR(y[6], 0.315392 * (3 * 9.0 / 14 - 1), 1e-6);
    EXPECT_NEAR(y[8], 0.546274 * (1 - 4) / 14, 1e-6);
}

TEST(ProjectEnvironment, IsTheSumOverEveryTexel) {
    const EnvMap map = bumpy(24);
    for (const int order : {2, 20}) {  // summed; by the transform
        const SphericalHarmonics sh = projectEnvironment(map, order);
        double largest = 0;
        for (const Rgb& c : sh.coefficients) largest = std::max(largest, maxComponent(glm::abs(c)));
        for (int l = 0; l <= order; l += order > 2 ? 5 : 1)
            for (int m = -l; m <= l; ++m) {
                Rgb expected(0);
                for (int y = 0; y < map.image.height(); ++y)
                    for (int x = 0; x < 24; ++x)
                        expected += map.image.rgb(x, y) * envSolidAngle(EnvLayout::Cube, 24, x, y) *
                                    definition(l, m, envTexelDirection(EnvLayout::Cube, 24, x, y));
                EXPECT_LT(maxComponent(glm::abs(sh.at(l, m) - expected)), 1e-5 * largest) << order << " " << l << m;
            }
    }
}

TEST(ProjectEnvironment, ConstantIsTheFirstCoefficientAlone) {
    EnvMap map(EnvLayout::Octahedral, 31);
    for (float& v : map.image.data()) v = 3;
    const SphericalHarmonics sh = projectEnvironment(map, 3);
    EXPECT_NEAR(sh.at(0, 0).x, 3 * std::sqrt(4 * kPi), 1e-9);
    for (std::size_t i = 1; i < sh.coefficients.size(); ++i) EXPECT_NEAR(sh.coefficients[i].x, 0, 3e-2);  // quadrature
}

TEST(FilterHarmonics, DiffuseIsIrradianceOverPi) {
    const EnvMap map = bumpy(24);
    const EnvironmentTruth truth(map);
    const SphericalHarmonics sh = filterHarmonics(projectEnvironment(map, 8), {LobeKind::Diffuse});
    for (std::uint64_t i = 1; i < 30; ++i) {
        const Vec3 n = glm::normalize(Vec3(radicalInverse(i, 2), radicalInverse(i, 3), radicalInverse(i, 5)) - 0.5);
        const Rgb expected = truth({LobeKind::Diffuse}, n);
        EXPECT_LT(maxComponent(glm::abs(evaluateHarmonics(sh, n) - expected)), 0.02 * maxComponent(expected));
    }
}

TEST(WindowHarmonics, DampsHighDegreesAndKeepsTheMean) {
    const SphericalHarmonics sh = projectEnvironment(bumpy(8), 4);
    for (const char* name : {"hann", "lanczos"}) {
        const SphericalHarmonics windowed = windowHarmonics(sh, harmonicWindowFromString(name));
        EXPECT_EQ(windowed.at(0, 0), sh.at(0, 0));
        EXPECT_LT(std::abs(windowed.at(4, 0).y), 0.5 * std::abs(sh.at(4, 0).y));
    }
    EXPECT_EQ(windowHarmonics(sh, harmonicWindowFromString("none")).coefficients, sh.coefficients);
    EXPECT_THROW(harmonicWindowFromString("box"), std::invalid_argument);
    EXPECT_THROW(projectEnvironment(bumpy(2), -1), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
