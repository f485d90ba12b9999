// Surfaces in a surrounding: directions by Snell, furnaces, and the samples against raytrace.
#include "reference/environment_shading.hpp"

#include <gtest/gtest.h>

#include "core/fresnel.hpp"

namespace nacre {
namespace {

const Vec3 kNormal = glm::normalize(Vec3(0.3, 0.5, 1));

std::vector<Vec3> views() {
    std::vector<Vec3> out;
    for (const double theta : {0.0, 0.4, 1.0, 1.5, 1.5707})
        for (const double phi : {0.0, 2.0, 5.0}) {
            const Vec3 x = glm::normalize(glm::cross(Vec3(0, 1, 0), kNormal)), y = glm::cross(kNormal, x);
            out.push_back(std::cos(theta) * kNormal + std::sin(theta) * (std::cos(phi) * x + std::sin(phi) * y));
        }
    return out;
}

TEST(EnvironmentShading, DirectionsAreSnells) {
    for (const Vec3& v : views()) {
        const Vec3 r = mirrored(v, kNormal);
        EXPECT_NEAR(glm::dot(r, kNormal), glm::dot(v, kNormal), 1e-12);
        EXPECT_NEAR(glm::length(r + v), 2 * glm::dot(v, kNormal), 1e-12);  // in one plane, on the other side
        const double sine = glm::length(v - glm::dot(v, kNormal) * kNormal);
        for (const double ior : {1.0, 1.5, 200.0, 0.5}) {
            const Vec3 t = refracted(v, kNormal, ior);
            if (sine / ior > 1) {
                EXPECT_EQ(t, Vec3(0));
                continue;
            }
            EXPECT_NEAR(glm::length(t), 1, 1e-12);
            EXPECT_LT(glm::dot(t, kNormal), 1e-12);
            EXPECT_NEAR(glm::length(t - glm::dot(t, kNormal) * kNormal), sine / ior, 1e-9);
            EXPECT_NEAR(glm::dot(t, glm::cross(v, kNormal)), 0, 1e-12);
        }
        EXPECT_LT(glm::length(refracted(v, kNormal, 1) + v), 1e-7);
    }
}

// A white surrounding: a coat that lets through what it doesn't reflect stays white, whatever its index.
TEST(EnvironmentShading, WhiteFurnace) {
    const auto white = [](const Vec3&) { return Rgb(1); };
    for (const double eta : {1.0, 1.5, 5.0, 200.0})
        for (const Vec3& v : views()) {
            const double f = fresnelDielectric(glm::dot(v, kNormal), eta);
            SurroundedSurface s;
            s.reflection = s.diffuse = white;
            s.weight = [eta](double c) { return Rgb(fresnelDielectric(c, eta)); };
            EXPECT_NEAR(surroundedRadiance(s, v, kNormal).r, 1 + f, 1e-12);
            s.blend = true;
            EXPECT_NEAR(surroundedRadiance(s, v, kNormal).r, 1, 1e-12);
            s.diffuse = {};
            s.transmission = white;
            s.ior = eta;
            EXPECT_NEAR(surroundedRadiance(s, v, kNormal).g, 1, 1e-12);
            EXPECT_EQ(surroundedRadiance(s, -v, kNormal), Rgb(0));  // from behind
        }
}

/// Two triangles with normals that lean outwards, one corner turned away from the eye.
Mesh bentQuad() {
    Mesh mesh;
    for (int i = 0; i < 4; ++i) {
        const glm::vec3 p(i % 2 == 0 ? -1 : 1, i < 2 ? -1 : 1, 0);
        mesh.positions.push_back(p);
        mesh.normals.push_back(glm::normalize(p + glm::vec3(0, 0, i == 3 ? -0.5f : 1.0f)));
        mesh.tangents.emplace_back(1, 0, 0, 1);
        mesh.uvs.emplace_back(0, 0);
    }
    mesh.triangles = {{0, 1, 3}, {0, 3, 2}};
    return mesh;
}

TEST(EnvironmentShading, SamplesAreThoseOfTheRayTracer) {
    const Mesh mesh = bentQuad();
    Camera camera;
    camera.eye = {0.5, 2, 2.5};
    const std::vector<Light> lights{{true, glm::normalize(Vec3(1, 2, 1)), Rgb(1)}};
    RaytraceOptions options{.width = 40, .height = 30, .supersample = 2};
    options.background = Rgb(0.25);
    const RaytracedPicture expected = raytrace(
        mesh, camera, lights, [](const Vec3&, const Vec3&) { return Rgb(1, 0.5, 0.1); }, options);
    const TracedSurface traced = traceSurface(mesh, camera, options);
    std::vector<Rgb> radiance(traced.points.size());
    for (std::size_t i = 0; i < radiance.size(); ++i) {
        const SurfacePoint& p = traced.points[i];
        radiance[i] = options.background;
        if (!TracedSurface::hit(p)) continue;
        const bool lit = glm::dot(p.normal, p.toEye) > 0;
        radiance[i] = Rgb(1, 0.5, 0.1) * (lit ? std::max(0.0, glm::dot(p.normal, lights[0].position)) : 0.0);
        EXPECT_LT(std::abs(glm::dot(p.tangent, p.normal)), 1e-6);
    }
    const RaytracedPicture found = assemblePicture(traced, radiance);
    for (std::size_t i = 0; i < found.radiance.data().size(); ++i)
        EXPECT_NEAR(found.radiance.data()[i], expected.radiance.data()[i], 1e-6);
    EXPECT_EQ(found.coverage.data(), expected.coverage.data());
    const auto sky = [](const Vec3& d) { return d + Rgb(2); };
    const auto shaded = shadeSurrounded(traced, {}, sky, 1), again = shadeSurrounded(traced, {}, sky, 5);
    EXPECT_EQ(shaded, again);
    EXPECT_EQ(shaded[0], traced.directions[0] + Rgb(2));
    radiance.pop_back();
    EXPECT_THROW(assemblePicture(traced, radiance), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
