#include "transfer/proxy_shadow.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "envmaps/spherical_harmonics.hpp"

namespace nacre {
namespace {

constexpr double kMask = 0.02;  // of the light: 64 x 64 bits, each looked at in one place

/// Squares by their corners, counter-clockwise seen from where they face.
ShadowProxy proxyOf(const std::vector<std::array<glm::vec3, 4>>& squares) {
    AnimatedMesh mesh;
    mesh.frames.emplace_back();
    for (const auto& square : squares) {
        const auto i = static_cast<unsigned>(mesh.frames[0].size());
        for (const glm::vec3& p : square) mesh.frames[0].push_back(p);
        mesh.triangles.push_back({i, i + 1, i + 2});
        mesh.triangles.push_back({i, i + 2, i + 3});
    }
    const WeldedMesh welded = weldMesh(mesh, "squares");
    const std::vector<glm::vec3> positions = weldedPositions(welded, mesh.frames[0]);
    ShadowProxy proxy(welded, positions, 0);
    proxy.move(positions);
    return proxy;
}

/// A square about a point of an axis, across it.
std::array<glm::vec3, 4> across(const glm::vec3& at, float half) {
    const glm::vec3 n = glm::normalize(at), t = std::abs(n.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0),
                    u = half * glm::normalize(glm::cross(t, n)), v = glm::cross(n, u);
    return {at - u - v, at + u - v, at + u + v, at - u + v};
}

LightCoefficients leaning() {  // a constant, and more from above, red from +x
    LightCoefficients light(25, Rgb(0));
    light[0] = Rgb(3), light[1] = Rgb(0.5), light[3] = Rgb(1, 0, 0), light[7] = Rgb(0.2);
    return light;
}

double worst(const LightCoefficients& a, const LightCoefficients& b) {
    double out = 0;
    for (std::size_t i = 0; i < a.size(); ++i) out = std::max(out, maxComponent(glm::abs(a[i] - b[i])));
    return out;
}

TEST(ProxyShadow, ABoxAroundThePointHidesAllAndNothingHidesNothing) {
    std::vector<std::array<glm::vec3, 4>> box;
    for (const glm::vec3& axis : {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1)})
        for (const float side : {-1.0f, 1.0f}) box.push_back(across(side * axis, 1));
    const ShadowProxy proxy = proxyOf(box);
    const ShadowProxy* const one[] = {&proxy};
    const LightProjector projector(4, 64);
    EXPECT_LT(worst(projector.shadowed(leaning(), Vec3(0.1, -0.2, 0.05), one), LightCoefficients(25, Rgb(0))),
              3 * kMask);
    EXPECT_EQ(worst(projector.shadowed(leaning(), Vec3(0), {}), leaning()), 0);
}

TEST(ProxyShadow, ASquareHidesItsSolidAngle) {  // ∫ over it of y_i L, by a fine sum
    const ShadowProxy proxy = proxyOf({across({0.6f, 1.2f, -2}, 1)});
    const ShadowProxy* const one[] = {&proxy};
    const auto corners = across({0.6f, 1.2f, -2}, 1);
    const Vec3 at(0.3, 0, 0.2);
    SphericalHarmonics light{4, leaning()};
    LightCoefficients expected = leaning();
    constexpr int kSteps = 200;
    const Vec3 u = (Vec3(corners[1]) - Vec3(corners[0])) / double(kSteps),
               v = (Vec3(corners[3]) - Vec3(corners[0])) / double(kSteps);
    for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j) {
            const Vec3 d = Vec3(corners[0]) + (i + 0.5) * u + (j + 0.5) * v - at, s = glm::normalize(d);
            const double solid = std::abs(glm::dot(glm::cross(u, v), s)) / glm::dot(d, d);
            const std::vector<double> y = realHarmonics(4, s);
            for (std::size_t c = 0; c < 25; ++c) expected[c] -= solid * y[c] * evaluateHarmonics(light, s);
        }
    const LightCoefficients found = LightProjector(4, 64).shadowed(leaning(), at, one);
    EXPECT_LT(worst(found, expected), kMask);
    EXPECT_GT(worst(found, leaning()), 5 * kMask);
    // What two hide together counts once.
    const ShadowProxy behind = proxyOf({across({0.9f, 1.8f, -3}, 1)});
    const ShadowProxy* const both[] = {&proxy, &behind};
    EXPECT_LT(worst(LightProjector(4, 64).shadowed(leaning(), Vec3(0), both),
                    LightProjector(4, 64).shadowed(leaning(), Vec3(0), one)),
              kMask);
}

TEST(ProxyShadow, AGridIsLinearBetweenItsMiddles) {
    LightGrid grid{{0, 0, 0}, {4, 1, 1}, {2, 1, 1}, {{Rgb(1)}, {Rgb(3)}}};
    EXPECT_DOUBLE_EQ(grid.at({1, 0, 5})[0].x, 1);
    EXPECT_DOUBLE_EQ(grid.at({2, 0, 0})[0].x, 2);
    EXPECT_DOUBLE_EQ(grid.at({2.5, 9, 0})[0].x, 2.5);
    EXPECT_DOUBLE_EQ(grid.at({-3, 0, 0})[0].x, 1);
    EXPECT_DOUBLE_EQ(grid.at({9, 0, 0})[0].x, 3);
    grid.low.y = grid.high.y = 0.5;  // flat
    EXPECT_DOUBLE_EQ(grid.at({3, 0.5, 0})[0].x, 3);
    const std::vector<float> transfer = {2, 2};
    const std::vector<glm::vec3> positions = {{1, 0.5f, 0}, {2, 0.5f, 0}};
    const std::vector<glm::vec3> out = exitantRadiance(transfer, positions, grid, Rgb(0.5));
    EXPECT_FLOAT_EQ(out[0].x, 1);
    EXPECT_FLOAT_EQ(out[1].x, 2);
}

TEST(ProxyShadow, LightsStandAtTheMiddlesOfTheBox) {
    const ShadowProxy proxy = proxyOf({across({0, 2, 0}, 1)});
    const ShadowProxy* const one[] = {&proxy};
    const LightProjector projector(4);
    const std::vector<glm::vec3> positions = {{-2, 0, -1}, {2, 0, 1}};
    const LightGrid grid = shadowedLights(projector, leaning(), positions, {2, 1, 1}, one);
    ASSERT_EQ(grid.lights.size(), 2u);
    EXPECT_EQ(worst(grid.lights[0], projector.shadowed(leaning(), Vec3(-1, 0, 0), one)), 0);
    EXPECT_EQ(worst(grid.lights[1], projector.shadowed(leaning(), Vec3(1, 0, 0), one)), 0);
    const LightGrid single = shadowedLights(projector, leaning(), positions, glm::ivec3(1), one, 1);
    EXPECT_EQ(worst(single.at({9, 9, 9}), projector.shadowed(leaning(), Vec3(0), one)), 0);
    EXPECT_THROW(shadowedLights(projector, leaning(), positions, {0, 1, 1}, one), std::invalid_argument);
    EXPECT_THROW(shadowedLights(projector, {Rgb(1)}, positions, glm::ivec3(1), one), std::invalid_argument);
    EXPECT_THROW(LightProjector(4, 20), std::invalid_argument);
    EXPECT_THROW(exitantRadiance(std::vector<float>(3), positions, single), std::invalid_argument);
}

TEST(ProxyShadow, FollowsTheMotion) {
    ShadowProxy proxy = proxyOf({across({0, 2, 0}, 1)});
    const ShadowProxy* const one[] = {&proxy};
    const LightProjector projector(4);
    const LightCoefficients before = projector.shadowed(leaning(), Vec3(0), one);
    const auto moved = across({0, 0, 2}, 1);
    proxy.move(std::vector<glm::vec3>(moved.begin(), moved.end()));
    const LightCoefficients after = projector.shadowed(leaning(), Vec3(0), one);
    EXPECT_GT(worst(before, after), 0.05);
    EXPECT_LT(before[1].y, after[1].y) << "more comes from above again";
}

}  // namespace
}  // namespace nacre
