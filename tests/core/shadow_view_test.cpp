// How maps are fitted to light and scene, and what they say of single points.
#include "core/shadow_view.hpp"

#include <gtest/gtest.h>

namespace nacre {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

Bounds box() { return {{-2, -1, -3}, {1, 2, 3}}; }
Light spot() { return {false, {4, 5, 1}, Rgb(1), SpotCone{glm::normalize(Vec3(-4, -5, -1)), 0.2, 0.5}}; }
Light sun() { return {true, glm::normalize(Vec3(0.3, 0.8, -0.5)), Rgb(1)}; }
Light bulb() { return {false, {0, 0.5, 0}, Rgb(1)}; }

std::vector<ShadowView> everyKind() {
    SceneShadow paraboloid;
    paraboloid.dualParaboloid = true;
    return {fitShadow({}, spot(), box()), fitShadow({}, sun(), box()), fitShadow({}, bulb(), box()),
            fitShadow(paraboloid, bulb(), box())};
}

/// Points of the box on a grid.
std::vector<Vec3> points() {
    std::vector<Vec3> out;
    for (int i = 0; i < 9; ++i)
        for (int j = 0; j < 9; ++j)
            for (int k = 0; k < 9; ++k) out.push_back(box().low + Vec3(i, j, k) / 8.0 * (box().high - box().low));
    return out;
}

TEST(ShadowView, DepthsOfTheSceneAreBetweenNearAndFar) {
    for (const ShadowView& view : everyKind())
        for (const Vec3& p : points()) {
            const ShadowPlace place = shadowPlace(view, p);
            if (!place.inside) continue;
            const double z = view.kind == ShadowKind::DualParaboloid ? glm::length(place.q) : place.q.z;
            EXPECT_LT(z, view.far);
            EXPECT_TRUE(z > view.near || glm::length(place.q) < 0.1);
        }
}

TEST(ShadowView, SunAndBulbSeeEveryPoint) {
    for (const ShadowView& view : everyKind()) {
        if (view.kind == ShadowKind::Spot) continue;
        for (const Vec3& p : points()) EXPECT_TRUE(shadowPlace(view, p).inside || p == bulb().position);
    }
}

TEST(ShadowView, SpotSeesItsCone) {
    const ShadowView view = fitShadow({}, spot(), box());
    for (const Vec3& p : points()) {
        const Vec3 from = glm::normalize(p - spot().position);
        EXPECT_TRUE(shadowPlace(view, p).inside || glm::dot(from, spot().cone->axis) < std::cos(0.5));
    }
}

TEST(ShadowView, AMapIsNotMirroredAndItsClipSpaceIsItsPlace) {
    for (const ShadowView& view : everyKind())
        for (int layer = 0; layer < view.layers(); ++layer) {
            const Mat3 turn = shadowLayerFrame(view, layer) * Mat3(view.fromWorld);
            EXPECT_NEAR(glm::determinant(turn), -1, 1e-12) << "x, y along the map, z away: left-handed";
            if (view.kind == ShadowKind::DualParaboloid) continue;
            for (const Vec3& p : points()) {
                const ShadowPlace place = shadowPlace(view, p);
                if (place.layer != layer || !place.inside) continue;
                const Vec4 clip = shadowClip(view, layer) * Vec4(place.q, 1);
                EXPECT_NEAR(clip.x / clip.w, place.map.x, 1e-9);
                EXPECT_NEAR(clip.y / clip.w, place.map.y, 1e-9);
            }
        }
}

// The texel's size: two points of one depth, a texel apart in the map.
TEST(ShadowView, TexelIsItsSizeInTheWorld) {
    for (const ShadowView& view : everyKind()) {
        const Vec3 p(0.3, -0.8, 0.2);
        const ShadowPlace a = shadowPlace(view, p);
        const Mat3 back = glm::transpose(shadowLayerFrame(view, a.layer) * Mat3(view.fromWorld));
        const Vec3 away = glm::normalize(a.q);  // the paraboloid keeps distance, the others depth
        const Vec3 aside =
            view.kind == ShadowKind::DualParaboloid ? glm::normalize(Vec3(1, 0, 0) - away * away.x) : Vec3(1, 0, 0);
        const ShadowPlace b = shadowPlace(view, p + back * aside * a.texel);
        EXPECT_NEAR(glm::length(b.map - a.map) * view.size / 2, 1, 0.01);
    }
}

TEST(ShadowView, CascadesAreFinestNearTheCamera) {
    SceneShadow options;
    options.cascades = 4;
    Camera camera;
    camera.eye = {0, 1, 8};
    camera.far = 50;
    const Bounds scene{{-40, -1, -40}, {40, 3, 10}};
    const ShadowView view = fitShadow(options, sun(), scene, &camera, 1.5);
    ASSERT_EQ(view.layers(), 4);
    double texel = 0;
    int layer = 0;
    for (const double depth : {0.5, 2.0, 6.0, 12.0, 25.0, 40.0}) {
        const ShadowPlace place = shadowPlace(view, camera.eye + Vec3(0, -0.02, -1) * depth);
        EXPECT_TRUE(place.inside) << depth;
        EXPECT_GE(place.texel, texel) << depth;
        EXPECT_GE(place.layer, layer);
        texel = place.texel, layer = place.layer;
    }
    EXPECT_GE(layer, 2);
    EXPECT_LT(shadowPlace(view, camera.eye).texel, shadowPlace(fitShadow({}, sun(), scene), camera.eye).texel / 8);
}

TEST(ShadowView, CascadesMoveByWholeTexels) {
    SceneShadow options;
    options.cascades = 2;
    Camera camera;
    camera.far = 6;
    const Bounds scene{{-40, -1, -40}, {40, 3, 40}};
    const ShadowView before = fitShadow(options, sun(), scene, &camera);
    camera.eye += Vec3(0.123, 0, 0.04), camera.target += Vec3(0.123, 0, 0.04);
    const ShadowView after = fitShadow(options, sun(), scene, &camera);
    const Vec2 shift = Vec2(after.cascades[0] - before.cascades[0]) * (before.size / 2.0);
    EXPECT_NEAR(after.cascades[0].z, before.cascades[0].z, 1e-9 * after.cascades[0].z);
    EXPECT_NEAR(shift.x, std::round(shift.x), 1e-6);
    EXPECT_NEAR(shift.y, std::round(shift.y), 1e-6);
    EXPECT_GT(glm::length(shift), 1);
}

TEST(ShadowView, WideConesAreCubes) {
    Light wide = spot();
    wide.cone->outer = kPi / 2;
    EXPECT_EQ(fitShadow({}, wide, box()).kind, ShadowKind::Cube);
}

/// A wall of depth z over the left half of a spot's map.
std::vector<Image> halfWall(const ShadowView& view, double z) {
    Image image(view.size, view.size, 1);
    for (int y = 0; y < view.size; ++y)
        for (int x = 0; x < view.size; ++x)
            image.at(x, y, 0) = x < view.size / 2 ? static_cast<float>((z - view.near) / (view.far - view.near)) : 1;
    return {image};
}

TEST(ShadowLit, FilterIsABoxOfOneTexelLess) {
    for (const int n : {1, 2, 3, 4, 5, 9}) {
        SceneShadow options;
        options.size = 64, options.filter = n, options.near = 1, options.far = 10;
        const Light light{false, {0, 0, 0}, Rgb(1), SpotCone{{0, 0, -1}, 0.2, 0.5}};
        const ShadowView view = fitShadow(options, light, {{-1, -1, -9}, {1, 1, -1}});
        const std::vector<Image> layers = halfWall(view, 2);
        double last = -1;
        for (int k = -20; k <= 20; ++k) {  // texels from the wall's edge, at depth 8
            const double texels = k * 0.37;
            const Vec2 map(texels * 2 / view.size, 0.01);
            const Vec3 q(map / view.scale * 8.0, 8);
            const Vec3 p = Vec3(glm::inverse(view.fromWorld) * Vec4(q, 1));
            const double lit = shadowLit(view, layers, p, {0, 0, 1});
            const double expected = n == 1 ? (texels >= 0 ? 1 : 0) : clamp01(0.5 + texels / (n - 1));
            EXPECT_NEAR(lit, expected, 1e-9) << n << " " << texels;
            EXPECT_GE(lit, last - 1e-9);
            last = lit;
        }
    }
}

TEST(ShadowLit, BehindTheSurfaceIsDarkAndOutsideIsLit) {
    const ShadowView view = fitShadow({}, spot(), box());
    const std::vector<Image> layers(1, Image(view.size, view.size, 1));  // depth 0 everywhere: all shadowed
    const Vec3 n = -spot().cone->axis;
    EXPECT_EQ(shadowLit(view, layers, {0, 0, 0}, n), 0);
    EXPECT_EQ(shadowLit(view, layers, {0, 0, 0}, -n), 0);
    EXPECT_EQ(shadowLit(view, layers, {4, -5, 9}, {0, 1, 0}), 1) << "outside of the cone";
    EXPECT_EQ(shadowLit(view, layers, {9, 11, 1}, {0, -1, 0}), 1) << "behind the light";
    EXPECT_THROW(shadowLit(view, {}, {0, 0, 0}, n), std::invalid_argument);
}

// The derivation of the bias: surfaces no nearer to the light than the receiver never shadow it.
TEST(ShadowLit, PlanesAndInwardCornersShadowNothing) {
    for (const int n : {1, 3, 5})
        for (const double theta : {0.0, 0.5, 1.0, 1.4, 1.55}) {
            SceneShadow options;
            options.size = 128, options.filter = n;
            const ShadowView view = fitShadow(options, {true, {0, 0, 1}, Rgb(1)}, {{-1, -1, -30}, {1, 1, 30}});
            const Mat3 back = glm::transpose(Mat3(view.fromWorld));
            const Vec3 origin(glm::inverse(view.fromWorld)[3]);
            // In light space: a slope z = x tanθ, and from x = 0 on a wall of constant depth.
            const double slope = std::tan(theta);
            Image image(view.size, view.size, 1);
            for (int y = 0; y < view.size; ++y)
                for (int x = 0; x < view.size; ++x) {
                    const double at = (((x + 0.5) * 2 / view.size - 1) - view.cascades[0].x) / view.cascades[0].z;
                    const double z = std::min(at, 0.0) * slope;
                    image.at(x, y, 0) = static_cast<float>((z - view.near) / (view.far - view.near));
                }
            const Vec3 normal = back * Vec3(slope, 0, -1) / std::sqrt(1 + slope * slope);
            for (int k = 1; k < 200; ++k) {
                const double x = -0.5 * k / 200;
                const Vec3 p = origin + back * Vec3(x, 0.013, x * slope);
                if (std::abs(x * slope) > 25) continue;
                EXPECT_NEAR(shadowLit(view, std::vector<Image>{image}, p, normal), 1, 1e-9)
                    << n << " " << theta << " " << x;
            }
        }
}

TEST(ShadowView, BrokenInputIsRefused) {
    const auto refused = [](const SceneShadow& options, const Light& light = sun(), const Bounds& scene = box()) {
        EXPECT_THROW(fitShadow(options, light, scene), std::invalid_argument);
    };
    SceneShadow o;
    refused((o = {}, o.size = 4, o));
    refused((o = {}, o.bits = 24, o));
    refused((o = {}, o.filter = 0, o));
    refused((o = {}, o.filter = 10, o));
    refused((o = {}, o.cascades = 5, o));
    refused((o = {}, o.cascades = 2, o));  // no camera
    refused((o = {}, o.bias = -1, o));
    refused((o = {}, o.near = 2, o.far = 1, o));
    refused({}, {true, {0, 0, 2}, Rgb(1)});
    refused({}, {false, {0, kInf, 2}, Rgb(1)});
    refused({}, sun(), {});
    EXPECT_NO_THROW(fitShadow({}, sun(), {{0, 0, 0}, {0, 0, 0}})) << "a scene of one point";
    EXPECT_NO_THROW(fitShadow({}, bulb(), {bulb().position, bulb().position}));
}

}  // namespace
}  // namespace nacre
