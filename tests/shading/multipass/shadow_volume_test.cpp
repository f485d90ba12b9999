// Shadow volumes as bodies, without a GPU: how often they contain a point against how many triangles are in its way.
#include "shading/multipass/shadow_volume.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "core/scene_description.hpp"
#include "shading/primitives.hpp"
#include "shadow_meshes.hpp"

namespace nacre {
namespace {

double solidAngle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    return 2 * std::atan2(glm::dot(a, glm::cross(b, c)),
                          la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
}

/// The body with infinity drawn near enough for numbers: its winding about a point is the point's count.
class Body {
public:
    Body(const ShadowMesh& mesh, const ShadowVolume& volume, const glm::dmat4& toWorld, const Vec4& light)
        : mesh_(mesh), volume_(volume), toWorld_(toWorld), light_(light) {}

    double countAt(const Vec3& p) const {
        double sum = 0;
        for (const ShadowVolume::Sides& s : volume_.sides)
            for (std::uint32_t i = s.first; i < s.first + s.count; i += 3) sum += s.times * sideAngle(p, i);
        for (const int turn : {1, -1})
            for (const ShadowVolume::Run& run : turn > 0 ? volume_.caps.facing : volume_.caps.turned)
                for (std::uint32_t t = run.first; t < run.first + run.count; ++t)
                    sum += turn * (capAngle(p, t, 0) - (volume_.farCap ? capAngle(p, t, 1) : 0));
        return sum / (4 * kPi);
    }

private:
    Vec3 point(std::uint32_t number) const {
        const Vec3 p(toWorld_ * Vec4(Vec3(mesh_.positions[number / 2]), 1));
        if (number % 2 == 0) return p;
        return light_.w == 0 ? -1e5 * Vec3(light_) : p + 1e3 * (p - Vec3(light_));
    }
    double sideAngle(const Vec3& p, std::uint32_t i) const {
        const auto& v = volume_.indices;
        return solidAngle(point(v[i]) - p, point(v[i + 1]) - p, point(v[i + 2]) - p);
    }
    double capAngle(const Vec3& p, std::uint32_t triangle, std::uint32_t far) const {
        const glm::uvec3 v = 2u * mesh_.triangles[triangle] + far;
        return solidAngle(point(v.x) - p, point(v.y) - p, point(v.z) - p);
    }
    const ShadowMesh& mesh_;
    const ShadowVolume& volume_;
    glm::dmat4 toWorld_;
    Vec4 light_;
};

/// Triangles between a point and the light (Moeller & Trumbore 1997). \param before  planes: what is behind one doesn't
/// count
int blockers(const ShadowMesh& mesh, const glm::dmat4& toWorld, const Vec3& p, const Vec4& light,
             const std::vector<Vec4>& before = {}) {
    const Vec3 d = Vec3(light) - light.w * p;
    const auto corner = [&](std::uint32_t i) { return Vec3(toWorld * Vec4(Vec3(mesh.positions[i]), 1)); };
    int out = 0;
    for (const glm::uvec3& t : mesh.triangles) {
        const Vec3 a = corner(t.x), e1 = corner(t.y) - a, e2 = corner(t.z) - a, q = glm::cross(d, e2);
        const double det = glm::dot(e1, q);
        if (det == 0) continue;
        const Vec3 s = p - a, r = glm::cross(s, e1);
        const double u = glm::dot(s, q) / det, v = glm::dot(d, r) / det, at = glm::dot(e2, r) / det;
        const bool inFront = std::all_of(before.begin(), before.end(),
                                         [&](const Vec4& plane) { return glm::dot(plane, Vec4(p + at * d, 1)) > 0; });
        out += inFront && u >= 0 && v >= 0 && u + v <= 1 && at > 0 && (light.w == 0 || at < 1);
    }
    return out;
}

const Vec4 kLights[] = {{1.5, 3, 1, 1},  {0.05, 0.1, 0.02, 1}, {0, 0.85, 0.1, 1},
                        {-2, 0.4, 0, 1}, {0.6, 0.8, 0, 0},     {0, 0, 1, 0}};

void expectCounts(const std::string& name, const ShadowMesh& mesh, const glm::dmat4& toWorld) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> cube(-2, 2);
    int dark = 0;
    for (const Vec4& light : kLights) {
        const ShadowVolume volume = makeShadowVolume(mesh, toWorld, light);
        const Body body(mesh, volume, toWorld, light);
        for (int i = 0; i < 400; ++i) {
            const Vec3 p(cube(random), cube(random), cube(random));
            const int blocked = blockers(mesh, toWorld, p, light);
            const double count = body.countAt(p);
            if (std::abs(count - std::round(count)) > 0.05) continue;  // at the border, or by the nearness of infinity
            dark += blocked > 0;
            ASSERT_EQ(std::round(count) > 0, blocked > 0)
                << name << ", light " << light.x << " " << light.y << " " << light.w << ", point " << i;
            ASSERT_GE(std::round(count), 0) << name;
            ASSERT_LE(count, static_cast<double>(volume.mostLayers()) + 0.1) << name;
            if (!mesh.solid) {
                ASSERT_EQ(std::round(count), blocked) << name;
            }
        }
    }
    EXPECT_GT(dark, 30) << name << ": hardly a point was in shadow";
}

TEST(ShadowVolume, ContainsPointsAsTrianglesBlockThem) {
    for (const test::NamedMesh& m : test::hardMeshes()) expectCounts(m.name, makeShadowMesh(m.mesh), glm::dmat4(1));
}

TEST(ShadowVolume, OfWhatLiesInFrontOfPlanes) {
    const std::vector<Vec4> planes{{0.3, 1, 0.1, 0.05}, {-1, 0.2, 0, 0.2}};
    std::mt19937 random(3);
    std::uniform_real_distribution<double> cube(-2, 2);
    int dark = 0, freed = 0;
    for (const test::NamedMesh& m : test::hardMeshes()) {
        const ShadowMesh mesh = makeShadowMesh(m.mesh);
        const CutShadowMesh cut = cutShadowMesh(mesh, planes);
        EXPECT_FALSE(cut.pieces.solid);
        EXPECT_EQ(cut.from.size(), cut.pieces.triangles.size());
        for (const Vec4& light : kLights) {
            const ShadowVolume volume = makeShadowVolume(cut.pieces, glm::dmat4(1), light);
            const Body body(cut.pieces, volume, glm::dmat4(1), light);
            for (int i = 0; i < 100; ++i) {
                const Vec3 p(cube(random), cube(random), cube(random));
                const double count = body.countAt(p);
                if (std::abs(count - std::round(count)) > 0.05) continue;
                const int blocked = blockers(mesh, glm::dmat4(1), p, light, planes);
                ASSERT_EQ(std::round(count), blocked) << m.name << ", light " << light.x << ", point " << i;
                dark += blocked > 0;
                freed += blockers(mesh, glm::dmat4(1), p, light) > blocked;
            }
            const ShadowVolume drawn = makeShadowVolume(mesh, cut, glm::dmat4(1), light);
            EXPECT_TRUE(drawn.cut);
            if (drawn.farCap) {
                // Slivers without an area keep their triangle's turn.
                EXPECT_GE(drawn.farCaps.triangles(), volume.caps.triangles()) << m.name;
            }
            EXPECT_LE(drawn.caps.triangles(), mesh.triangles.size());
        }
    }
    EXPECT_GT(dark, 100);
    EXPECT_GT(freed, 100) << "hardly anything was cut off";
}

TEST(ShadowVolume, MovedStretchedAndMirroredObjects) {
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1), 0.7, glm::normalize(Vec3(1, 2, 3)));
    for (const test::NamedMesh& m : test::hardMeshes())
        for (const Vec3& scale : {Vec3(1.3, 0.6, 1), Vec3(-1, 1, 1), Vec3(1, 1, 0)})
            expectCounts(m.name, makeShadowMesh(m.mesh), turned * glm::scale(glm::dmat4(1), scale));
}

TEST(ShadowVolume, BodiesAreFoundSolidAndNothingElse) {
    for (const test::NamedMesh& m : test::hardMeshes()) EXPECT_EQ(makeShadowMesh(m.mesh).solid, m.solid) << m.name;
    EXPECT_FALSE(makeShadowMesh({}).solid);
}

TEST(ShadowVolume, SilhouetteOfABallIsOneLoop) {
    const ShadowMesh ball = makeShadowMesh(makeSphere(1, 64, 32));
    const ShadowVolume volume = makeShadowVolume(ball, glm::dmat4(1), {0, 40, 0, 1});
    ASSERT_EQ(volume.sides.size(), 1u);
    EXPECT_EQ(volume.sides[0].times, 1);
    EXPECT_EQ(volume.sides[0].count, 64u * 6);
    EXPECT_GE(bytesOfVolumeAPolygon(ball, {0, 40, 0, 1}), 8 * volume.bytes());
}

TEST(ShadowVolume, LightInThePlaneOfAFaceSeesNothingOfIt) {
    const ShadowVolume volume = makeShadowVolume(makeShadowMesh(makeQuad(2, 2)), glm::dmat4(1), {3, 1, 0, 1});
    EXPECT_TRUE(volume.empty());
}

// A lamp flush with a ceiling: rounding of the matrix puts it on one side of one triangle, and half of space in shadow.
TEST(ShadowVolume, LightFlushWithAMovedFaceSeesNothingOfIt) {
    const ShadowMesh face = makeShadowMesh(makeQuad(2, 2));
    for (const double angle : {90.0, 33.0, -71.0}) {
        glm::dmat4 toWorld = glm::translate(glm::dmat4(1), Vec3(0.1, 1, -3));
        toWorld = glm::rotate(toWorld, glm::radians(angle), glm::normalize(Vec3(1, 0.2, 0)));
        for (const Vec3& at : {Vec3(0.3, -0.4, 0), Vec3(5, 0.7, 0), Vec3(0.999, 0.1, 0)})
            EXPECT_TRUE(makeShadowVolume(face, toWorld, toWorld * Vec4(at, 1)).empty()) << angle;
        const Vec4 above = toWorld * Vec4(0.3, -0.4, 1e-4, 1);
        EXPECT_FALSE(makeShadowVolume(face, toWorld, above).empty()) << angle;
    }
}

TEST(ShadowVolume, EmptyMeshCastsNothing) {
    EXPECT_TRUE(makeShadowVolume(makeShadowMesh({}), glm::dmat4(1), {0, 1, 0, 0}).empty());
}

TEST(ShadowVolume, RejectsBrokenInput) {
    Mesh bad = makeQuad(1, 1);
    bad.triangles[0].x = 99;
    EXPECT_THROW(makeShadowMesh(bad), std::invalid_argument);
    bad = makeQuad(1, 1);
    bad.positions[0].x = NAN;
    EXPECT_THROW(makeShadowMesh(bad), std::invalid_argument);
    const ShadowMesh good = makeShadowMesh(makeQuad(1, 1));
    EXPECT_THROW(makeShadowVolume(good, glm::dmat4(NAN), {0, 1, 0, 0}), std::invalid_argument);
    EXPECT_THROW(makeShadowVolume(good, glm::dmat4(1), {0, INFINITY, 0, 1}), std::invalid_argument);
}

/// Windows called lit have no point in the shadow of any point of the box; the others are mostly right too.
TEST(ShadowVolume, LitWindowsAreLit) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> in(-2, 2);
    const auto point = [&] { return Vec3(in(random), in(random), in(random)); };
    int lit = 0, missed = 0;
    for (int i = 0; i < 3000; ++i) {
        Bounds box;
        box.add(point());
        box.add(box.low + 0.4 * glm::abs(point()));
        const Vec3 corner = point(), x = 0.3 * point(), y = 0.3 * point();
        const std::vector<Vec3> window{corner, corner + x, corner + x + y, corner + y};
        const Vec4 light = i % 2 ? Vec4(point() * 2.0, 1) : Vec4(glm::normalize(point()), 0);
        bool dark = false;
        for (int k = 0; k < 64; ++k) {
            const Vec3 p = corner + (k % 8 / 7.0) * x + (k / 8 / 7.0) * y, d = Vec3(light) - light.w * p;
            double from = 0, to = light.w == 0 ? 1e9 : 1;
            for (int a = 0; a < 3; ++a) {
                const double s = (box.low[a] - p[a]) / d[a], t = (box.high[a] - p[a]) / d[a];
                from = std::max(from, std::min(s, t)), to = std::min(to, std::max(s, t));
            }
            dark = dark || from < to;
        }
        const bool said = windowIsLit(window, box, light);
        ASSERT_FALSE(said && dark) << i;
        lit += said;
        missed += !said && !dark;
    }
    EXPECT_GT(lit, 1500);
    EXPECT_LT(missed, lit / 10);
}

TEST(ShadowVolume, NearWindowIsWhereTheCameraSaysItIs) {
    Camera camera;
    camera.eye = {1, 2, 3};
    camera.target = {0, 1, -2};
    camera.near = 0.25;
    const std::vector<Vec3> window = nearWindow(glm::inverse(camera.projection(1.5) * camera.view()));
    ASSERT_EQ(window.size(), 4u);
    for (const Vec3& p : window) EXPECT_NEAR(Vec3(camera.view() * Vec4(p, 1)).z, -0.25, 1e-9);
    EXPECT_NEAR(glm::length(window[1] - window[0]), 2 * 0.25 * std::tan(0.3) * 1.5, 1e-9);
}

}  // namespace
}  // namespace nacre
