#include "transfer/exitant_radiance.hpp"

#include <gtest/gtest.h>

#include "envmaps/spherical_harmonics.hpp"
#include "transfer/self_transfer.hpp"

namespace nacre {
namespace {

constexpr double kFloat = 2e-5;  // of sums of 25 or 49 floats of size 1

LightCoefficients constantLight(int order, const Rgb& radiance) {
    LightCoefficients light(static_cast<std::size_t>((order + 1) * (order + 1)), Rgb(0));
    light[0] = std::sqrt(4 * kPi) * radiance;
    return light;
}

/// Coefficients without a pattern, larger in the lower bands.
LightCoefficients someLight(int order) {
    LightCoefficients light;
    for (int i = 0; i < (order + 1) * (order + 1); ++i)
        light.emplace_back(Rgb(std::cos(i), std::sin(3 * i), std::cos(5 * i + 1)) / (1.0 + i));
    return light;
}

Rgb radianceFrom(const LightCoefficients& light, const Vec3& direction) {
    const int order = static_cast<int>(std::sqrt(static_cast<double>(light.size()))) - 1;
    return evaluateHarmonics({order, light}, direction);
}

/// A grid of n × n vertices in the plane y = 0 that faces up.
AnimatedMesh plane(std::uint32_t n) {
    AnimatedMesh a;
    a.frames.resize(1);
    for (std::uint32_t i = 0; i < n * n; ++i) a.frames[0].emplace_back(i % n, 0, i / n);
    for (std::uint32_t y = 0; y + 1 < n; ++y)
        for (std::uint32_t x = 0; x + 1 < n; ++x) {
            const std::uint32_t i = y * n + x;
            a.triangles.push_back({i, i + n, i + 1});
            a.triangles.push_back({i + 1, i + n, i + n + 1});
        }
    return a;
}

/// Rows of latitude between two poles.
AnimatedMesh sphere(std::uint32_t rows, std::uint32_t columns) {
    AnimatedMesh a;
    a.frames.resize(1);
    const auto at = [&](std::uint32_t r, std::uint32_t c) {
        return r == 0 ? 0 : r == rows ? 1 : 2 + (r - 1) * columns + c % columns;
    };
    a.frames[0] = {{0, 0, 1}, {0, 0, -1}};
    for (std::uint32_t r = 1; r < rows; ++r)
        for (std::uint32_t c = 0; c < columns; ++c) {
            const double theta = kPi * r / rows, phi = 2 * kPi * c / columns;
            a.frames[0].emplace_back(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
        }
    for (std::uint32_t r = 0; r < rows; ++r)
        for (std::uint32_t c = 0; c < columns; ++c) {
            if (r + 1 < rows) a.triangles.push_back({at(r, c), at(r + 1, c), at(r + 1, c + 1)});
            if (r > 0) a.triangles.push_back({at(r, c), at(r + 1, c + 1), at(r, c + 1)});
        }
    return a;
}

TransferFrame transferOf(const AnimatedMesh& a, const SelfTransferOptions& options = {}) {
    WeldedMesh mesh = weldMesh(a, "mesh");
    const std::vector<glm::vec3> positions = weldedPositions(mesh, a.frames[0]);
    return SelfTransfer(std::move(mesh), positions, options).compute(positions);
}

TEST(ExitantRadiance, OpenPlaneUnderConstantLightIsItsAlbedo) {
    const Rgb albedo(0.8, 0.5, 0.1), light(1, 2, 3);
    for (const int order : {0, 2, 4, 6}) {
        SelfTransferOptions options;
        options.order = order;
        const TransferFrame frame = transferOf(plane(9), options);
        for (const glm::vec3& radiance : exitantRadiance(frame.coefficients, constantLight(order, light), albedo))
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(radiance[c], albedo[c] * light[c], kFloat * light[c]) << order;
    }
}

TEST(ExitantRadiance, OpenPlaneUnderALinearSkyHasAClosedForm) {  // ∫ (1 + y) cosθ/π ds over y > 0 = 1 + 2/3
    LightCoefficients light = constantLight(4, Rgb(1));
    light[1] = Rgb(std::sqrt(4 * kPi / 3));  // y = √(4π/3) y_1,−1
    for (const glm::vec3& radiance : exitantRadiance(transferOf(plane(5)).coefficients, light))
        EXPECT_NEAR(radiance.x, 1 + 2.0 / 3, kFloat);
}

TEST(ExitantRadiance, ClosedConvexSphereHidesNothing) {
    SelfTransferOptions meshItself;
    meshItself.coarse = 0;
    const TransferFrame frame = transferOf(sphere(20, 40), meshItself);
    ASSERT_EQ(frame.computed, 762u);
    for (const glm::vec3& radiance : exitantRadiance(frame.coefficients, constantLight(4, Rgb(1)), Rgb(0.5)))
        EXPECT_NEAR(radiance.x, 0.5, kFloat);
}

TEST(ExitantRadiance, CoarseLevelsHideTwoBitsOfAConvexSphereAtMost) {  // a coarse triangle may bulge over the horizon
    constexpr double kTwoBits = 2.0 / (32 * 32) + kFloat;              // measured: one, at few vertices
    for (const glm::vec3& radiance : exitantRadiance(transferOf(sphere(20, 40)).coefficients, constantLight(4, Rgb(1))))
        EXPECT_NEAR(radiance.x, 1, kTwoBits);
}

TEST(ExitantRadiance, VertexWithoutANormalIsBlack) {
    AnimatedMesh a = plane(3);
    a.frames[0].emplace_back(9, 9, 9);  // of no triangle
    const std::vector<glm::vec3> radiance = exitantRadiance(transferOf(a).coefficients, constantLight(4, Rgb(1)));
    EXPECT_EQ(radiance.back(), glm::vec3(0));
    EXPECT_GT(radiance.front().x, 0.9f);
}

TEST(ExitantRadiance, SameBitsForAnyThreadCount) {
    std::vector<float> transfer;
    for (int i = 0; i < 5000 * 25; ++i) transfer.push_back(std::sin(static_cast<float>(i)));
    EXPECT_EQ(exitantRadiance(transfer, someLight(4), Rgb(1), 1), exitantRadiance(transfer, someLight(4), Rgb(1), 7));
}

TEST(TurnedLight, QuarterTurnsExchangeTheAxes) {
    const HarmonicRotation rotation(1);
    LightCoefficients alongX(4, Rgb(0));
    alongX[3] = {1, 2, 3};
    const LightCoefficients about[] = {turnedLight(rotation, alongX, {0, 0, 9}, kPi / 2),    // x → y
                                       turnedLight(rotation, alongX, {0, 1, 0}, kPi / 2),    // x → −z
                                       turnedLight(rotation, alongX, {-1, 0, 0}, kPi / 2)};  // x stays
    const int place[] = {1, 2, 3}, sign[] = {1, -1, 1};
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 4; ++i)
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(about[k][static_cast<std::size_t>(i)][c], i == place[k] ? sign[k] * (c + 1) : 0, 1e-5)
                    << k << i;
}

TEST(TurnedLight, ShinesFromTurnedDirections) {  // L'(R s) = L(s), all orders
    const Vec3 axis(0.3, -0.7, 0.5), k = glm::normalize(axis);
    const double angle = 1.3;
    for (int order = 0; order <= kMaxTransferOrder; ++order) {
        const LightCoefficients light = someLight(order),
                                turned = turnedLight(HarmonicRotation(order), light, axis, angle);
        for (const Vec3& d : {Vec3(0, 0, 1), Vec3(0.6, 0, -0.8), Vec3(-2, 3, 6) / 7.0}) {
            const Vec3 moved =
                d * std::cos(angle) + glm::cross(k, d) * std::sin(angle) + k * glm::dot(k, d) * (1 - std::cos(angle));
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(radianceFrom(turned, moved)[c], radianceFrom(light, d)[c], kFloat) << order;
        }
    }
}

TEST(TurnedLight, TurningTheMeshBackIsTheSame) {  // Σ L'_i V_i of the plane = Σ L_i V_i of the plane turned back
    const LightCoefficients light = someLight(4), turned = turnedLight(HarmonicRotation(4), light, {1, 0, 0}, kPi / 2);
    AnimatedMesh back = plane(4);
    for (glm::vec3& p : back.frames[0]) p = {p.x, p.z, -p.y};  // by −π/2 about x: y → −z
    const auto upright = exitantRadiance(transferOf(plane(4)).coefficients, turned),
               lying = exitantRadiance(transferOf(back).coefficients, light);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(upright[5][c], lying[5][c], kFloat);
}

TEST(BlendedLights, IsTheWeightedSum) {
    const std::vector<LightCoefficients> lights = {constantLight(2, Rgb(1)), someLight(2)};
    const std::vector<double> weights = {0.25, 2};
    const LightCoefficients blend = blendedLights(lights, weights);
    for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(blend[i], 0.25 * lights[0][i] + 2.0 * lights[1][i]);
}

TEST(ExitantRadiance, WrongSizesAreRefused) {
    const std::vector<float> transfer(50);
    const HarmonicRotation rotation(4);
    EXPECT_THROW(exitantRadiance(transfer, constantLight(3, Rgb(1))), std::invalid_argument);
    EXPECT_THROW(exitantRadiance(transfer, {}), std::invalid_argument);
    EXPECT_THROW(turnedLight(rotation, constantLight(3, Rgb(1)), {0, 1, 0}, 1), std::invalid_argument);
    EXPECT_THROW(turnedLight(rotation, constantLight(4, Rgb(1)), {0, 0, 0}, 1), std::invalid_argument);
    EXPECT_THROW(turnedLight(rotation, constantLight(4, Rgb(1)), {0, 1, 0}, NAN), std::invalid_argument);
    const std::vector<LightCoefficients> mixed = {constantLight(2, Rgb(1)), constantLight(3, Rgb(1))};
    const std::vector<double> two = {1, 1}, one = {1}, bad = {1, INFINITY};
    EXPECT_THROW(blendedLights(mixed, two), std::invalid_argument);
    EXPECT_THROW(blendedLights({mixed.data(), 1}, two), std::invalid_argument);
    EXPECT_THROW(blendedLights({}, {}), std::invalid_argument);
    EXPECT_THROW(blendedLights(std::vector<LightCoefficients>(2, mixed[0]), bad), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
