// Environment layouts: directions, exact solid angles, OpenEXR's orientation, lookups without seams.
#include "core/environment.hpp"

#include <OpenEXR/ImfEnvmap.h>
#include <gtest/gtest.h>

#include "core/sampling.hpp"

namespace nacre {
namespace {

constexpr EnvLayout kAll[] = {EnvLayout::LatLong, EnvLayout::Cube, EnvLayout::DualParaboloid, EnvLayout::Octahedral};

Vec3 spherePoint(std::uint64_t i) {
    const double z = 1 - 2 * radicalInverse(i, 2), phi = 2 * kPi * radicalInverse(i, 3), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

EnvMap mapOf(EnvLayout layout, int size, Rgb (*radiance)(const Vec3&)) {
    EnvMap map(layout, size);
    for (int y = 0; y < map.image.height(); ++y)
        for (int x = 0; x < map.image.width(); ++x)
            map.image.setRgb(x, y, radiance(envTexelDirection(layout, size, x, y)));
    return map;
}

TEST(Environment, SolidAnglesOfEverySizeAreTheSphere) {
    for (const EnvLayout layout : kAll)
        for (const int size : {1, 2, 3, 4, 7, 16, 33}) {
            double sum = 0;
            for (const double omega : envSolidAngles(layout, size)) sum += omega;
            EXPECT_NEAR(sum, 4 * kPi, layout == EnvLayout::DualParaboloid ? 1e-6 : 1e-10)
                << toString(layout) << " " << size;
        }
}

TEST(Environment, SolidAngleIsTheShareOfDirectionsThatLandInTheTexel) {
    constexpr int kSize = 5, kPoints = 400000;
    for (const EnvLayout layout : kAll) {
        const glm::ivec2 extent = envExtent(layout, kSize);
        std::vector<double> share(extent.x * extent.y);
        for (int i = 0; i < kPoints; ++i) {
            const glm::dvec2 p = envPosition(layout, kSize, spherePoint(i));
            const int x = std::clamp(static_cast<int>(std::floor(p.x)), 0, extent.x - 1);
            const int y = std::clamp(static_cast<int>(std::floor(p.y)), 0, extent.y - 1);
            share[y * extent.x + x] += 4 * kPi / kPoints;
        }
        const std::vector<double> exact = envSolidAngles(layout, kSize);
        for (std::size_t i = 0; i < share.size(); ++i)
            EXPECT_NEAR(share[i], exact[i], 1e-3) << toString(layout) << " texel " << i;
    }
}

TEST(Environment, PositionInvertsDirection) {
    for (const EnvLayout layout : kAll)
        for (const int size : {2, 5, 64})
            for (std::uint64_t i = 1; i < 2000; ++i) {
                const Vec3 d = spherePoint(i);
                const glm::dvec2 p = envPosition(layout, size, d);
                EXPECT_LT(glm::length(envDirection(layout, size, p.x, p.y) - d), 1e-9) << toString(layout) << size;
            }
}

TEST(Environment, EdgesAndCornersOfTheCubeBelongToTheirFace) {
    for (const int size : {1, 2, 5, 1024})
        for (const double x : {-1.0, 0.3, 1.0})
            for (const double y : {-1.0, 1.0})
                for (const Vec3& d : {Vec3(x, y, 1), Vec3(x, 1, y), Vec3(1, x, y), Vec3(x, y, -1), Vec3(x, -1, y)}) {
                    const glm::dvec2 p = envPosition(EnvLayout::Cube, size, d);
                    const Vec3 back =
                        envTexelDirection(EnvLayout::Cube, size, static_cast<int>(p.x), static_cast<int>(p.y));
                    EXPECT_GT(glm::dot(back, glm::normalize(d)), std::cos(1.2 / size)) << size << d.x << d.y << d.z;
                }
}

TEST(Environment, OrientationIsOpenExrs) {  // its registration differs: texel centres on the edges
    constexpr int kSize = 9;
    const Imath::Box2i cube(Imath::V2i(0, 0), Imath::V2i(kSize - 1, 6 * kSize - 1));
    const Imath::Box2i latLong(Imath::V2i(0, 0), Imath::V2i(2 * kSize - 1, kSize - 1));
    for (std::uint64_t i = 1; i < 500; ++i) {
        const Vec3 d = spherePoint(i);
        const Imath::V3f direction(static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z));
        Imf::CubeMapFace face{};
        Imath::V2f inFace;
        Imf::CubeMap::faceAndPixelPosition(direction, cube, face, inFace);
        const Imath::V2f pixel = Imf::CubeMap::pixelPosition(face, cube, inFace);
        const glm::dvec2 p = envPosition(EnvLayout::Cube, kSize, d);
        EXPECT_EQ(static_cast<int>(p.y / kSize), static_cast<int>(face));
        EXPECT_NEAR(p.x / kSize, pixel.x / (kSize - 1), 1e-5);
        EXPECT_NEAR((p.y - face * kSize) / kSize, (pixel.y - static_cast<float>(face * kSize)) / (kSize - 1), 1e-5);
        const Imath::V2f ll = Imf::LatLongMap::pixelPosition(latLong, direction);
        const glm::dvec2 q = envPosition(EnvLayout::LatLong, kSize, d);
        EXPECT_NEAR(q.x / (2 * kSize), ll.x / (2 * kSize - 1), 1e-5);
        EXPECT_NEAR(q.y / kSize, ll.y / (kSize - 1), 1e-5);
    }
}

TEST(Environment, LookupsHaveNoSeams) {
    // Steps of 1e-4 around the sphere in three planes: a lookup may not jump by more than the step allows.
    const auto radiance = [](const Vec3& d) { return Rgb(d.x, d.y * d.z, 1 + d.z); };
    constexpr double kStep = 1e-4, kSteepest = 4;  // slope of the radiance 1; of texel differences a few times that
    // The paraboloids' outer texels mirror each other in z: they agree at the rim but for the radiance's curvature.
    const auto seam = [](EnvLayout layout, int size) {
        return layout == EnvLayout::DualParaboloid ? 4.0 / sqr(size) : 0;
    };
    for (const EnvLayout layout : {EnvLayout::Cube, EnvLayout::DualParaboloid, EnvLayout::Octahedral})
        for (const int size : {2, 3, 8}) {
            const EnvMap map = mapOf(layout, size, radiance);
            const double bound = kSteepest * kStep + seam(layout, size);
            for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0.48, 0.6, 0.64)}) {
                const Vec3 a = glm::normalize(glm::cross(axis, Vec3(0.3, 0.2, 1))), b = glm::cross(axis, a);
                Rgb last = sampleEnv(map, a);
                for (double t = kStep; t < 2 * kPi; t += kStep) {
                    const Rgb now = sampleEnv(map, std::cos(t) * a + std::sin(t) * b);
                    EXPECT_LT(maxComponent(glm::abs(now - last)), bound) << toString(layout) << size << " t " << t;
                    last = now;
                }
            }
        }
}

TEST(Environment, LookupAtTexelCentresReturnsTexels) {
    for (const EnvLayout layout : kAll) {
        const EnvMap map = mapOf(layout, 6, [](const Vec3& d) { return Rgb(d.x, d.y, d.z); });
        for (int y = 0; y < map.image.height(); ++y)
            for (int x = 0; x < map.image.width(); ++x) {
                if (envSolidAngle(layout, 6, x, y) == 0) continue;
                const Vec3 d = envTexelDirection(layout, 6, x, y);
                if (layout == EnvLayout::DualParaboloid && (d.z < 0) != (y >= 6)) continue;  // beyond the seam
                EXPECT_LT(glm::length(sampleEnv(map, d) - map.image.rgb(x, y)), 1e-6) << toString(layout);
            }
    }
}

TEST(Environment, RejectsWrongProportionsAndNames) {
    EXPECT_THROW(EnvMap(EnvLayout::Cube, 0), std::invalid_argument);
    EXPECT_THROW(EnvMap(EnvLayout::LatLong, Image(4, 4, 3)), std::invalid_argument);
    EXPECT_THROW(EnvMap(EnvLayout::Octahedral, Image(4, 4, 1)), std::invalid_argument);
    EXPECT_THROW(envLayoutFromString("cubemap"), std::invalid_argument);
    for (const EnvLayout layout : kAll) EXPECT_EQ(envLayoutFromString(toString(layout)), layout);
}

}  // namespace
}  // namespace nacre
