// Light sources: what arrives of a spot.
#include <gtest/gtest.h>

#include <cmath>

#include "core/scene.hpp"

namespace nacre {
namespace {

TEST(SpotCone, IsOneInsideNoneOutsideAndAQuarterHalfwayInCosine) {
    const SpotCone cone{{0, -1, 0}, 0.2, 0.6};
    const auto at = [&](double angle) { return coneShare(cone, {std::sin(angle), std::cos(angle), 0}); };
    EXPECT_EQ(at(0), 1);
    EXPECT_NEAR(at(0.2), 1, 1e-12);
    EXPECT_NEAR(at(std::acos((std::cos(0.2) + std::cos(0.6)) / 2)), 0.25, 1e-12);
    EXPECT_NEAR(at(0.6), 0, 1e-12);
    for (const double outside : {0.7, kPi / 2, 3.0, kPi}) EXPECT_EQ(at(outside), 0) << outside;
}

TEST(SpotCone, FalloffIsItsShareOverTheSquaredDistance) {
    const Light lamp{false, {1, 3, 0}, Rgb(1)}, sun{true, {0, 1, 0}, Rgb(1)};
    Light spot = lamp;
    spot.cone = SpotCone{{0, -1, 0}, 0.2, 0.6};
    EXPECT_NEAR(lightFalloff(spot, {1, 1, 0}), 0.25, 1e-12);
    const glm::dvec3 aside(1 + 2 * std::tan(0.4), 1, 0);
    EXPECT_NEAR(lightFalloff(spot, aside),
                lightFalloff(lamp, aside) * coneShare(*spot.cone, {-std::sin(0.4), std::cos(0.4), 0}), 1e-12);
    EXPECT_NEAR(lightFalloff(lamp, aside), std::pow(std::cos(0.4) / 2, 2), 1e-12);
    EXPECT_EQ(lightFalloff(sun, aside), 1);
}

TEST(SpotCone, BrokenOnesAreRefused) {
    const auto with = [](bool directional, const SpotCone& cone) { checkCone({directional, {0, 0, 1}, Rgb(1), cone}); };
    EXPECT_NO_THROW(with(false, {}));
    EXPECT_NO_THROW(with(false, {{0, 0, 1}, 0, kPi / 2}));
    EXPECT_THROW(with(true, {}), std::invalid_argument);
    EXPECT_THROW(with(false, {{0, 0, 2}}), std::invalid_argument);
    EXPECT_THROW(with(false, {{0, 0, 1}, 0.5, 0.5}), std::invalid_argument);
    EXPECT_THROW(with(false, {{0, 0, 1}, -0.1, 0.5}), std::invalid_argument);
    EXPECT_THROW(with(false, {{0, 0, 1}, 0.1, 1.7}), std::invalid_argument);
    EXPECT_THROW(with(false, {{0, 0, 1}, std::nan(""), 0.5}), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
