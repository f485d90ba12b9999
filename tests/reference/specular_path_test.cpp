// Mirrors and panes along a ray, against the laws.
#include "reference/specular_path.hpp"

#include <gtest/gtest.h>

namespace nacre {
namespace {

Vec3 direction(double angle) { return {std::sin(angle), 0, -std::cos(angle)}; }

SceneSpecular pane(double ior) {
    SceneSpecular out;
    out.ior = ior;
    return out;
}

TEST(SpecularPath, MirrorLaw) {
    SceneSpecular mirror;
    mirror.reflection = {0.5, 0.25, 1};
    mirror.surface = 0.5;
    for (const double side : {1.0, -1.0}) {
        const auto rays = specularRays(mirror, direction(0.4), {0, 0, side});
        ASSERT_EQ(rays.size(), 1u);
        EXPECT_LT(glm::length(rays[0].direction - Vec3(std::sin(0.4), 0, std::cos(0.4))), 1e-12);
        EXPECT_EQ(rays[0].share, Rgb(0.25, 0.125, 0.5));
    }
}

TEST(SpecularPath, SnellAndEnergy) {
    for (const double ior : {1.0, 1.33, 1.5, 2.4, 0.6})
        for (const double angle : {0.0, 0.3, 0.55}) {
            for (const Vec3 normal : {Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
                const double eta = normal.z > 0 ? ior : 1 / ior, sine = std::sin(angle) / eta;
                if (sine >= 1) continue;
                const auto rays = specularRays(pane(ior), direction(angle), normal);
                ASSERT_FALSE(rays.empty());
                EXPECT_NEAR(rays[0].direction.x, sine, 1e-12);
                EXPECT_LT(rays[0].direction.z, 0);
                Rgb sum(0);
                for (const SpecularRay& ray : rays) sum += ray.share;
                EXPECT_NEAR(sum.r, 1, 1e-12);
            }
        }
    const auto straight = specularRays(pane(1.5), direction(0), {0, 0, 1});
    EXPECT_NEAR(straight[1].share.r, 0.04, 1e-12);
}

TEST(SpecularPath, BeyondTheCriticalAngleAllIsReflected) {
    const double critical = std::asin(1 / 1.5);
    for (const bool partial : {true, false}) {
        SceneSpecular glass = pane(1.5);
        glass.partial = partial;
        const auto rays = specularRays(glass, direction(critical + 1e-6), {0, 0, -1});
        ASSERT_EQ(rays.size(), 1u);
        EXPECT_EQ(rays[0].share, Rgb(1));
        EXPECT_GT(rays[0].direction.z, 0);
        EXPECT_LT(specularRays(glass, direction(critical - 1e-3), {0, 0, -1})[0].direction.z, 0);
    }
}

TEST(SpecularPath, IndexOneLetsAllPass) {
    const auto rays = specularRays(pane(1), direction(1.2), {0, 0, 1});
    ASSERT_EQ(rays.size(), 1u);
    EXPECT_EQ(rays[0].share, Rgb(1));
    EXPECT_LT(glm::length(rays[0].direction - direction(1.2)), 1e-12);
}

}  // namespace
}  // namespace nacre
