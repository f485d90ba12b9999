// Light that mirrors and panes send on: closed forms, and photons that are followed forwards.
#include "reference/light_path.hpp"

#include <gtest/gtest.h>

#include "core/sampling.hpp"
#include "reference/specular_path.hpp"

namespace nacre {
namespace {

/// Squares of edge 2 in z = 0, facing +z, and where they are put.
class Faces {
public:
    Faces() {
        Mesh m;
        m.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
        m.normals.assign(4, {0, 0, 1});
        m.tangents.assign(4, {1, 0, 0, 1});
        m.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        m.triangles = {{0, 1, 2}, {0, 2, 3}};
        scene.meshes = {{"square", m}};
        scene.materials.resize(1);
    }
    std::size_t add(const Vec3& at, double angle, const Vec3& axis, double scale,
                    const std::optional<SceneSpecular>& specular) {
        SceneNode node;
        node.mesh = 0;
        node.translation = at;
        node.rotation = glm::angleAxis(angle, axis);
        node.scale = Vec3(scale);
        if (specular) {
            scene.materials.emplace_back().specular = specular;
            node.material = static_cast<int>(scene.materials.size()) - 1;
        } else {
            node.material = 0;
        }
        scene.nodes.push_back(node);
        return scene.nodes.size() - 1;
    }
    std::vector<LightArrival> arrivals(const Light& light, const Vec3& point, int depth = 2) const {
        const std::vector<glm::dmat4> nodes = nodeTransforms(scene, 0);
        const SceneRays rays(scene, nodes);
        std::vector<LightArrival> out;
        LightPaths(scene, nodes, rays, depth).follow(light, point, true, [&](const LightArrival& a) {
            out.push_back(a);
        });
        return out;
    }
    SceneDescription scene;
};

SceneSpecular mirror(const Rgb& reflection = Rgb(1)) {
    SceneSpecular s;
    s.reflection = reflection;
    return s;
}
SceneSpecular pane(double ior) {
    SceneSpecular s;
    s.ior = ior;
    return s;
}
Light lampAt(const Vec3& at) { return {false, at, Rgb(3, 2, 1), {}}; }

TEST(LightPath, AMirrorIsALightBehindIt) {
    Faces f;
    f.add({0, 0, 0}, 0, {0, 0, 1}, 1, mirror({0.5, 1, 0.25}));
    const Vec3 point(0.9, 0, 1);
    const auto found = f.arrivals(lampAt({-0.9, 0, 2}), point);
    ASSERT_EQ(found.size(), 1u);
    const Vec3 offset = Vec3(-0.9, 0, -2) - point;
    EXPECT_LT(glm::length(found[0].toLight - glm::normalize(offset)), 1e-12);
    EXPECT_LT(glm::length(found[0].irradiance - Rgb(1.5, 2, 0.25) / glm::dot(offset, offset)), 1e-12);
    EXPECT_TRUE(f.arrivals(lampAt({-0.9, 0, 2}), {4, 0, 1}).empty()) << "past the mirror's edge";
    EXPECT_TRUE(f.arrivals(lampAt({-0.9, 0, 0}), point).empty()) << "a light in the mirror's plane";
    EXPECT_EQ(f.arrivals(lampAt({-0.9, 0, -2}), {0.9, 0, -1}).size(), 1u) << "its back mirrors too";
    EXPECT_TRUE(f.arrivals(lampAt({-0.9, 0, 2}), {0.9, 0, -1}).empty()) << "it isn't a pane";
}

/// Of a slab: a colour of the first face, fog in the glass, a texture's alpha at the second.
TEST(LightPath, FiltersFogAndTexturesTakeTheirShares) {
    auto filter = std::make_shared<Image>(2, 1, 4);
    filter->setRgb(0, 0, {1, 0.5, 0});
    filter->setRgb(1, 0, {0.5, 0, 1});
    auto texture = std::make_shared<Image>(1, 1, 4);
    texture->at(0, 0, 3) = 0.25f;
    SceneSpecular first = pane(1), second = pane(1);
    first.filter = filter;
    first.fogDistance = 2;
    second.texture = texture;
    second.surface = 0.8;
    Faces f;
    f.add({0, 0, 1}, 0, {0, 0, 1}, 1, first);
    f.add({0, 0, 0}, 0, {0, 0, 1}, 1, second);
    // The ray meets the first face at x = 0: halfway between the two texels' centres.
    const auto found = f.arrivals(lampAt({-0.5, 0, 2}), {1, 0, -1});
    ASSERT_EQ(found.size(), 1u);
    const Vec3 offset(-1.5, 0, 3);
    const Rgb want = Rgb(3, 2, 1) * Rgb(0.75, 0.25, 0.5) * 0.5 * 0.8 / glm::dot(offset, offset);
    EXPECT_LT(glm::length(found[0].irradiance - want), 1e-6);
    const auto sun = f.arrivals({true, glm::normalize(offset), Rgb(3, 2, 1), {}}, {1, 0, -1});
    ASSERT_EQ(sun.size(), 1u);
    EXPECT_LT(glm::length(sun[0].irradiance - want * glm::dot(offset, offset)), 1e-6);
    // A mirror's filter is of what it reflects, a pane's isn't.
    SceneSpecular gold = mirror();
    gold.filter = filter;
    Faces g;
    g.add({0, 0, 0}, 0, {0, 0, 1}, 1, gold);
    const auto reflected = g.arrivals(lampAt({-1, 0, 1}), {1, 0, 1});
    ASSERT_EQ(reflected.size(), 1u);
    EXPECT_LT(glm::length(reflected[0].irradiance - Rgb(3, 2, 1) * Rgb(0.75, 0.25, 0.5) / 8.0), 1e-6);
}

TEST(LightPath, WhatStandsBeforeOrAfterAFaceBlocks) {
    for (const Vec3& at : {Vec3(-1 / 3.0, 0, 1), Vec3(2 / 3.0, 0, 0.5), Vec3(0, 0, 1.5)}) {
        Faces f;
        f.add({0, 0, 0}, 0, {0, 0, 1}, 1, mirror());
        f.add(at, 0, {0, 0, 1}, 0.1, {});
        const bool between = at.x == 0;  // on the straight way alone, which isn't asked about
        EXPECT_EQ(f.arrivals(lampAt({-1, 0, 2}), {1, 0, 1}).size(), between ? 1u : 0u) << at.x;
    }
    Faces behind;  // a mirror's back side
    behind.add({0, 0, 0}, 0, {0, 0, 1}, 1, mirror());
    behind.add({0.3, 0, -0.2}, 0, {0, 0, 1}, 1, {});
    EXPECT_EQ(behind.arrivals(lampAt({-1, 0, 2}), {1, 0, 1}).size(), 1u);
    Faces transparent;
    transparent.scene.nodes[transparent.add({0, 0, 0}, 0, {0, 0, 1}, 1, mirror())].castsShadow = false;
    EXPECT_TRUE(transparent.arrivals(lampAt({-1, 0, 2}), {1, 0, 1}).empty()) << "it blocks nothing, it sends nothing";
}

/// Around the normal through the light: sin θ dθ / (ρ dρ cos θ') of the ring at a radius ρ.
TEST(LightPath, RefractedIrradianceHasItsClosedForm) {
    const double h = 1.3, depth = 0.8, eta = 1.5;
    for (const double r : {0.05, 0.4, 0.9}) {
        Faces f;
        f.add({0, 0, 0}, 0, {0, 0, 1}, 4, pane(1 / eta));  // glass before it: light comes from behind the square
        const double sine = r / std::hypot(r, h), cosine = h / std::hypot(r, h);
        const double sine2 = sine / eta, cosine2 = std::sqrt(1 - sine2 * sine2);
        const double rho = r + depth * sine2 / cosine2;
        const double dRho = h / sqr(cosine) + depth / sqr(cosine2) * cosine / (eta * cosine2);
        const double spread = sine / (rho * dRho * cosine2);
        const auto found = f.arrivals(lampAt({0, 0, -h}), {rho, 0, depth}, 1);
        ASSERT_EQ(found.size(), 1u);
        EXPECT_LT(glm::length(found[0].toLight - Vec3(-sine2, 0, -cosine2)), 1e-9);
        const double through = 1 - fresnelReflectance(cosine, cosine2, eta);
        EXPECT_NEAR(found[0].irradiance.r, 3 * through * spread, 1e-9);
    }
}

TEST(LightPath, EveryPointBehindPanesHasItsPath) {
    const Vec4 first(0, 1, 0, -1.5), second(glm::normalize(Vec3(0.1, 1, 0.05)), -0.4);
    for (const double eta : {0.4, 1.0, 1.5, 2.0, 5.0})
        for (int i = 0; i < 1000; ++i) {
            Vec2 u = Vec2(0.7548776662466927, 0.5698402909980532) * double(i);
            u -= glm::floor(u);
            const Vec3 from(-1.5, 4, 0.5), to(8 * u.x - 4, -0.6, 8 * u.y - 4);
            const auto path = fermatPath(from, to, {{first, eta}, {second, 1 / eta}});
            ASSERT_TRUE(path.has_value()) << eta << ' ' << i;
            const Vec3 in = glm::normalize(path->points[0] - from);
            const Vec3 out = glm::normalize(path->points[1] - path->points[0]);
            const double sine = glm::length(glm::cross(in, Vec3(first))),
                         beyond = glm::length(glm::cross(out, Vec3(first)));
            EXPECT_NEAR(sine, eta * beyond, 1e-9) << "Snell";
        }
}

TEST(LightPath, AFarLightIsADirection) {
    Faces f;
    f.add({0, 0, 0}, 0.4, {0, 1, 0}, 3, pane(1.5));
    f.add({0, 0, -2}, 0.1, {0, 1, 0}, 3, mirror());
    const Vec3 direction = glm::normalize(Vec3(0.3, 0.2, 1));
    const double far = 1e5;
    const Vec3 point(0.2, 0.3, -1);
    const Light sun{true, direction, Rgb(1), {}};
    const auto near = f.arrivals(sun, point);
    auto found = f.arrivals({false, direction * far, Rgb(far * far), {}}, point);
    ASSERT_EQ(near.size(), 2u);  // through the pane; and by the mirror
    ASSERT_EQ(found.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_LT(glm::length(found[i].toLight - near[i].toLight), 1e-4);
        EXPECT_NEAR(found[i].irradiance.r, near[i].irradiance.r, 1e-4);
    }
}

TEST(LightPath, ASlabMovesParallelLightAside) {
    Faces f;
    f.add({0, 0, 0}, 0, {0, 0, 1}, 1, pane(1.5));
    f.add({0, 0, -0.5}, kPi, {0, 1, 0}, 1, pane(1.5));
    const double angle = 0.7;
    const Vec3 direction(std::sin(angle), 0, std::cos(angle));
    const double sine = std::sin(angle) / 1.5, cosine = std::sqrt(1 - sine * sine);
    const double aside = 0.5 * sine / cosine, on = 0.1 * std::tan(angle);  // in the slab, and on to the point
    const auto at = [&](double x) { return f.arrivals({true, direction, Rgb(1), {}}, {x, 0, -0.6}); };
    ASSERT_EQ(at(0).size(), 1u);
    EXPECT_LT(glm::length(at(0)[0].toLight - direction), 1e-12);
    EXPECT_NEAR(at(0)[0].irradiance.r, sqr(1 - fresnelReflectance(std::cos(angle), cosine, 1.5)), 1e-9);
    EXPECT_EQ(at(1 - aside - on - 0.01).size(), 1u);
    EXPECT_TRUE(at(1 - aside - on + 0.01).empty()) << "beside what comes in at the edge";
}

/// Leaves a specular face, or none where it ends; Snell's law with its vectors.
struct Photon {
    Vec3 at, along;
    double power;
};

/// Measured 0.0011: of all flux, cells that photons cross at an edge, and the middles of 40² parts of a cell.
constexpr double kPhotons = 0.005;

/// A mirror and a tilted pane before a wall: photons leave the lamp and are counted where they land.
TEST(LightPath, PhotonsLandWhereItSays) {
    Faces f;
    f.add({0, 0, 0}, 0.3, {0, 1, 0}, 1, pane(1.6));
    f.add({1.2, 0, 0.6}, -1.1, {0, 1, 0}, 1, mirror(Rgb(0.8)));
    const std::size_t wall = f.add({0, 0, -1.5}, 0, {0, 0, 1}, 3, {});
    const std::vector<glm::dmat4> nodes = nodeTransforms(f.scene, 0);
    const SceneRays rays(f.scene, nodes);
    const Vec3 lamp(-0.2, 0.1, 1.5);
    static constexpr int kCells = 12, kCount = 4000000;
    static constexpr double kEdge = 6.0 / kCells;
    std::vector<double> landed(kCells * kCells, 0), said(kCells * kCells, 0);
    double total = 0, off = 0;
    for (int i = 0; i < kCount; ++i) {
        Vec2 u = Vec2(0.7548776662466927, 0.5698402909980532) * double(i);
        u -= glm::floor(u);
        const double z = 2 * u.x - 1, ring = std::sqrt(1 - z * z);
        std::vector<Photon> left{{lamp, {ring * std::cos(2 * kPi * u.y), ring * std::sin(2 * kPi * u.y), z}, 1}};
        for (int bounce = 0; bounce <= 2; ++bounce) {
            std::vector<Photon> next;
            for (const Photon& p : left) {
                const auto hit = rays.firstHit({p.at, p.along, bounce ? rays.skip() : 0, 1e30}, -p.along);
                if (!hit) continue;
                if (hit->node == wall) {
                    if (bounce == 0) continue;
                    const int x = int((hit->s.position.x + 3) / kEdge), y = int((hit->s.position.y + 3) / kEdge);
                    landed[std::size_t(std::clamp(y, 0, kCells - 1) * kCells + std::clamp(x, 0, kCells - 1))] +=
                        p.power;
                    continue;
                }
                const SceneSpecular& s =
                    *f.scene.materials[static_cast<std::size_t>(f.scene.nodes[hit->node].material)].specular;
                for (const SpecularRay& ray : specularRays(s, p.along, hit->plane))
                    next.push_back({hit->s.position, ray.direction, p.power * ray.share.r});
            }
            left = next;
        }
    }
    const LightPaths paths(f.scene, nodes, rays, 2);
    static constexpr int kSub = 40;
    for (int k = 0; k < kCells * kCells * kSub * kSub; ++k) {
        const int cell = k / (kSub * kSub), x = cell % kCells, y = cell / kCells, s = k % (kSub * kSub);
        const Vec3 p(-3 + kEdge * (x + (s % kSub + 0.5) / kSub), -3 + kEdge * (y + (s / kSub + 0.5) / kSub), -1.5);
        paths.follow({false, lamp, Rgb(1), {}}, p, true, [&](const LightArrival& a) {
            said[std::size_t(cell)] += a.irradiance.r * std::max(0.0, a.toLight.z) * sqr(kEdge / kSub);
        });
    }
    for (std::size_t i = 0; i < landed.size(); ++i) {
        landed[i] *= 4 * kPi / kCount;
        total += said[i];
        off += std::abs(landed[i] - said[i]);
    }
    std::printf("flux %.4f, photons differ by %.2f %% of it\n", total, 100 * off / total);
    EXPECT_GT(total, 0.1);
    EXPECT_LT(off, kPhotons * total);
}

}  // namespace
}  // namespace nacre
