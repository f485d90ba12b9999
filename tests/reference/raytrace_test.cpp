#include "reference/raytrace.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace nacre;

namespace {

constexpr double kSinglePrecision = 2e-6;  // hits, positions and pictures hold floats; relative
constexpr double kTessellation = 2e-4;     // 256 × 512 facets: sagitta and interpolated normals

BrdfFunction lambert(double albedo) {
    return [albedo](auto&, auto&) { return Rgb(albedo / kPi); };
}

/// The square [-s, s]² at height z, facing +z, tangent x.
Mesh plane(float s, float z = 0, float handedness = 1) {
    Mesh m;
    for (const glm::vec2 c : {glm::vec2(-s, -s), glm::vec2(s, -s), glm::vec2(s, s), glm::vec2(-s, s)}) {
        m.positions.emplace_back(c, z);
        m.normals.emplace_back(0, 0, 1);
        m.tangents.emplace_back(1, 0, 0, handedness);
        m.uvs.emplace_back(0, 0);
    }
    m.triangles = {{0, 1, 2}, {0, 2, 3}};
    return m;
}

void append(Mesh& m, const Mesh& other) {
    const auto first = static_cast<unsigned>(m.positions.size());
    m.positions.insert(m.positions.end(), other.positions.begin(), other.positions.end());
    m.normals.insert(m.normals.end(), other.normals.begin(), other.normals.end());
    m.tangents.insert(m.tangents.end(), other.tangents.begin(), other.tangents.end());
    for (const glm::uvec3& t : other.triangles) m.triangles.push_back(t + first);
}

/// Unit sphere with exact normals; tangents circle the y axis.
Mesh sphere(unsigned rings, unsigned segments) {
    Mesh m;
    for (unsigned i = 0; i <= rings; ++i)
        for (unsigned j = 0; j <= segments; ++j) {
            const double theta = kPi * i / rings, phi = 2 * kPi * j / segments;
            const Vec3 n(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi));
            m.positions.emplace_back(n);
            m.normals.emplace_back(n);
            m.tangents.emplace_back(glm::vec3(std::cos(phi), 0, -std::sin(phi)), 1);
        }
    for (unsigned i = 0; i < rings; ++i)
        for (unsigned j = 0; j < segments; ++j) {
            const unsigned a = i * (segments + 1) + j, b = a + segments + 1;
            m.triangles.emplace_back(a, b, a + 1);
            m.triangles.emplace_back(a + 1, b, b + 1);
        }
    return m;
}

Camera orthographicCamera(double height) {
    Camera c;
    c.orthographic = true;
    c.height = height;
    return c;
}

}  // namespace

TEST(Raytrace, LambertPlaneUnderAPointLightHasItsClosedForm) {
    const Light light{false, {0.3, -0.2, 0.8}, {2, 3, 4}};
    for (const bool orthographic : {true, false}) {
        Camera camera = orthographicCamera(1.5);
        camera.orthographic = orthographic;
        const auto picture = raytrace(plane(10), camera, {light}, lambert(0.5), {.width = 48, .height = 32});
        const double top = orthographic ? 0.75 : 3 * std::tan(0.3);  // half the height seen at distance 3
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 48; ++x) {
                const Vec3 p((2 * (x + 0.5) / 48 - 1) * top * 1.5, (1 - 2 * (y + 0.5) / 32) * top, 0),
                    to = light.position - p;
                const double expected = 0.5 / kPi * 3 * to.z / std::pow(glm::dot(to, to), 1.5);
                EXPECT_NEAR(picture.radiance.at(x, y, 1) / expected, 1, 10 * kSinglePrecision) << x << " " << y;
                EXPECT_EQ(picture.coverage.at(x, y, 0), 1);
            }
    }
}

TEST(Raytrace, PixelsAreWhereTheProjectionMatrixPutsThem) {
    // A triangle's coverage against the sign of the edge functions of its corners as OpenGL projects them.
    Mesh m;
    m.positions = {{-0.7f, -0.4f, 0.3f}, {0.8f, -0.1f, -0.4f}, {0.1f, 0.75f, 0.2f}};
    m.normals.assign(3, {0, 0, 1});
    m.tangents.assign(3, {1, 0, 0, 1});
    m.triangles = {{0, 1, 2}};
    for (const bool orthographic : {true, false}) {
        Camera camera{{1, 0.5, 3}, {0.1, 0, 0}, {0.2, 1, 0}};
        camera.orthographic = orthographic;
        const int width = 90, height = 60;
        std::array<Vec2, 3> corners;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec4 clip = camera.projection(1.5) * camera.view() * Vec4(Vec3(m.positions[i]), 1);
            corners[i] = {(clip.x / clip.w + 1) / 2 * width, (1 - clip.y / clip.w) / 2 * height};
        }
        const auto edge = [](const Vec2& a, const Vec2& b, const Vec2& p) {
            return ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)) / glm::length(b - a);
        };
        const auto picture = raytrace(m, camera, {}, lambert(1), {.width = width, .height = height});
        int covered = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const Vec2 p(x + 0.5, y + 0.5);
                double inner = 1e9;  // distance to the nearest edge [pixels], < 0 outside; y points down, so negated
                for (std::size_t i = 0; i < 3; ++i) inner = std::min(inner, -edge(corners[i], corners[(i + 1) % 3], p));
                if (std::abs(inner) < 1e-3) continue;  // too close to call in single precision
                EXPECT_EQ(picture.coverage.at(x, y, 0), inner > 0 ? 1 : 0) << x << " " << y;
                covered += inner > 0;
            }
        EXPECT_GT(covered, 300);
    }
}

TEST(Raytrace, SphereHasItsAnalyticNormals) {
    const Vec3 l = glm::normalize(Vec3(0.4, 0.7, 0.6));
    // f = 1/cosα · (wi): the picture shows the light in the local frame.
    const BrdfFunction f = [](const Vec3& wi, const Vec3&) { return Rgb(wi) / wi.z; };
    const auto picture =
        raytrace(sphere(256, 512), orthographicCamera(2), {{true, l, Rgb(1)}}, f, {.width = 63, .height = 63});
    for (int y = 0; y < 63; ++y)
        for (int x = 0; x < 63; ++x) {
            const Vec2 p(2 * (x + 0.5) / 63 - 1, 1 - 2 * (y + 0.5) / 63);
            if (glm::dot(p, p) > 0.98) continue;
            const Vec3 n(p, std::sqrt(1 - glm::dot(p, p)));
            if (glm::dot(n, l) < 0.01 || std::abs(n.y) > 0.99) continue;
            const Vec3 t = glm::normalize(glm::cross(Vec3(0, 1, 0), n)), b = glm::cross(n, t);
            const Rgb shown = picture.radiance.rgb(x, y);
            EXPECT_NEAR(shown.r, glm::dot(t, l), 10 * kTessellation) << x << " " << y;
            EXPECT_NEAR(shown.g, glm::dot(b, l), 10 * kTessellation) << x << " " << y;
            EXPECT_NEAR(shown.b, glm::dot(n, l), 10 * kTessellation) << x << " " << y;
        }
}

TEST(Raytrace, BitangentFollowsTheHandedness) {
    const BrdfFunction f = [](const Vec3& wi, const Vec3& wo) { return Rgb(wi.x, wi.y, wo.z); };
    const Vec3 l(0.6, 0.64, 0.48);
    for (const float w : {1.0f, -1.0f}) {
        const auto picture =
            raytrace(plane(2, 0, w), orthographicCamera(2), {{true, l, Rgb(1)}}, f, {.width = 1, .height = 1});
        const Rgb shown = picture.radiance.rgb(0, 0) / 0.48;
        EXPECT_NEAR(shown.r, 0.6, kSinglePrecision);
        EXPECT_NEAR(shown.g, w * 0.64, kSinglePrecision);
        EXPECT_NEAR(shown.b, 1, kSinglePrecision);
    }
}

TEST(Raytrace, ViewerDirectionPointsToTheEye) {
    const BrdfFunction f = [](auto&, const Vec3& wo) { return Rgb(wo) + Rgb(1); };
    const Camera camera{{0, 0, 2}, {0, 0, 0}, {0, 1, 0}};
    const auto picture = raytrace(plane(10), camera, {{true, {0, 0, 1}, Rgb(1)}}, f, {.width = 3, .height = 3});
    const double x = 2 * std::tan(0.3) * 2 / 3;  // the right column's point
    const Vec3 expected = glm::normalize(Vec3(-x, 0, 2)) + Vec3(1);
    EXPECT_NEAR(picture.radiance.at(2, 1, 0), expected.x, kSinglePrecision);
    EXPECT_NEAR(picture.radiance.at(2, 1, 2), expected.z, kSinglePrecision);
}

TEST(Raytrace, LightsBehindAndViewersBehindContributeNothing) {
    const auto shade = [](const Vec3& light, double eyeZ) {
        Camera camera = orthographicCamera(2);
        camera.eye.z = eyeZ;
        return raytrace(plane(2), camera, {{true, light, Rgb(1)}}, lambert(1), {.width = 1, .height = 1})
            .radiance.at(0, 0, 0);
    };
    EXPECT_GT(shade({0, 0, 1}, 3), 0.3);
    EXPECT_EQ(shade({0, 0, -1}, 3), 0);
    EXPECT_EQ(shade({1, 0, 0}, 3), 0);   // in the plane of the surface
    EXPECT_EQ(shade({0, 0, 1}, -3), 0);  // seen from below: the surface is there, black
}

TEST(Raytrace, ShadowsOnlyWhenAsked) {
    Mesh m = plane(2);
    append(m, plane(0.25f, 0.5f));
    const Light sun{true, glm::normalize(Vec3(1, 0, 1)), Rgb(1)}, lamp{false, {0.5, 0, 1}, Rgb(1)};
    for (const Light& light : {sun, lamp}) {
        const auto at = [&](bool shadows, double x) {  // radiance of the ground at (x, 0)
            const auto p = raytrace(m, orthographicCamera(2), {light}, lambert(1),
                                    {.width = 201, .height = 201, .shadows = shadows})
                               .radiance;
            return p.at(static_cast<int>((x + 1) * 100.5), 100, 0);
        };
        EXPECT_GT(at(false, -0.5), 0.01);
        EXPECT_EQ(at(true, -0.5), 0);              // the square's shadow
        EXPECT_EQ(at(true, 0.6), at(false, 0.6));  // beside it
        EXPECT_EQ(at(true, 0.1), at(false, 0.1));  // on the square: no shadow of itself
    }
}

TEST(Raytrace, NearAndFarPlaneCut) {
    Camera camera = orthographicCamera(2);
    const auto covered = [&] {
        return raytrace(plane(2), camera, {}, lambert(1), {.width = 1, .height = 1}).coverage.at(0, 0, 0);
    };
    EXPECT_EQ(covered(), 1);  // at depth 3
    camera.near = 3.1;
    EXPECT_EQ(covered(), 0);
    camera.near = 0.1, camera.far = 2.9;
    EXPECT_EQ(covered(), 0);
}

TEST(Raytrace, SupersamplingGivesCoverageOfEdges) {
    const auto picture = raytrace(plane(0.5), orthographicCamera(4), {{true, {0, 0, 1}, Rgb(1)}}, lambert(1),
                                  {.width = 4, .height = 4, .supersample = 8, .background = Rgb(1, 0, 0)});
    EXPECT_EQ(picture.coverage.at(1, 1, 0), 0.25);  // a quarter of the pixel [-1,0]²
    EXPECT_EQ(picture.coverage.at(0, 0, 0), 0);
    EXPECT_NEAR(picture.radiance.at(1, 1, 0), 0.75 + 0.25 / kPi, kSinglePrecision);
    EXPECT_NEAR(picture.radiance.at(1, 1, 1), 0.25 / kPi, kSinglePrecision);
}

TEST(Raytrace, EmptyAndDegenerateMeshesAreBackground) {
    EXPECT_EQ(
        raytrace({}, Camera{}, {}, lambert(1), {.width = 2, .height = 2, .background = Rgb(3)}).radiance.at(1, 1, 2),
        3);
    Mesh m = plane(1);
    m.triangles = {{0, 0, 2}, {1, 1, 1}};
    EXPECT_EQ(raytrace(m, Camera{}, {}, lambert(1), {.width = 2, .height = 2}).coverage.at(1, 1, 0), 0);
}

TEST(Raytrace, CancelledTangentsStillShade) {
    Mesh m = plane(2);
    for (glm::vec4& t : m.tangents) t = {0, 0, 1, 1};  // along the normal
    const auto picture =
        raytrace(m, orthographicCamera(2), {{true, {0, 0, 1}, Rgb(1)}}, lambert(1), {.width = 2, .height = 2});
    EXPECT_NEAR(picture.radiance.at(0, 0, 0), 1 / kPi, kSinglePrecision);
}

TEST(Raytrace, BrokenInputIsRefused) {
    Mesh m = plane(1);
    EXPECT_THROW(raytrace(m, {}, {}, lambert(1), {.width = 0}), std::invalid_argument);
    EXPECT_THROW(raytrace(m, {}, {}, lambert(1), {.supersample = 0}), std::invalid_argument);
    m.triangles.push_back({0, 1, 4});
    EXPECT_THROW(raytrace(m, {}, {}, lambert(1)), std::invalid_argument);
    m = plane(1);
    m.normals.pop_back();
    EXPECT_THROW(raytrace(m, {}, {}, lambert(1)), std::invalid_argument);
    m = plane(1);
    m.positions[0].x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(raytrace(m, {}, {}, lambert(1)), std::invalid_argument);
}

TEST(Raytrace, SameBitsForAnyThreadCount) {
    const Mesh m = sphere(32, 64);
    const std::vector<Light> lights{{true, glm::normalize(Vec3(1, 1, 1)), Rgb(1)}, {false, {0, 2, 2}, Rgb(2)}};
    RaytraceOptions options{.width = 64, .height = 48, .supersample = 2, .shadows = true, .threads = 1};
    const auto one = raytrace(m, Camera{}, lights, lambert(0.5), options);
    options.threads = 7;
    const auto seven = raytrace(m, Camera{}, lights, lambert(0.5), options);
    EXPECT_EQ(one.radiance.data(), seven.radiance.data());
    EXPECT_EQ(one.coverage.data(), seven.coverage.data());
}
