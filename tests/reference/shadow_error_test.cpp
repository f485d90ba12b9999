// The measure of shadows: rays' answers with closed forms, what counts as acne, leak and boundary, simulated maps.
#include "reference/shadow_error.hpp"

#include <gtest/gtest.h>

namespace nacre {
namespace {

constexpr int kSize = 100;

/// Squares [-s, s]² at height z, facing +z.
Mesh squares(const std::vector<std::pair<float, float>>& sizesAndHeights) {
    Mesh m;
    for (const auto& [s, z] : sizesAndHeights) {
        const auto first = static_cast<unsigned>(m.positions.size());
        for (const glm::vec2 c : {glm::vec2(-s, -s), glm::vec2(s, -s), glm::vec2(s, s), glm::vec2(-s, s)}) {
            m.positions.emplace_back(c, z);
            m.normals.emplace_back(0, 0, 1);
        }
        m.triangles.emplace_back(first, first + 1, first + 2);
        m.triangles.emplace_back(first, first + 2, first + 3);
    }
    return m;
}

/// From the side, so that the ground under the square is seen: 45° in x.
Camera aside() {
    Camera c;
    c.eye = {3, 0, 3};
    c.up = {0, 0, 1};
    c.orthographic = true;
    c.height = 2;
    return c;
}

/// A square of edge 1 at height 1 over the ground, light above it at height 2: a shadow of edge 2.
struct Square {
    Mesh mesh = squares({{4, 0}, {0.25f, 1}});
    Light light{false, {0, 0, 2}, Rgb(1), SpotCone{{0, 0, -1}, 0.7, 0.8}};
    Camera camera = aside();
    ShadowView view() const {
        SceneShadow options;
        options.size = 256;
        return fitShadow(options, light, boundsOf(mesh));
    }
    ShadowTruth truth() const { return {mesh, camera, light, {kSize, kSize}}; }
};

TEST(ShadowTruth, IsTheSquaresShadow) {
    const Square s;
    const Image lit = s.truth().picture();
    int shadowed = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            // orthographic at 45°: the ground point of the pixel; what the square hides is left out
            const Vec2 p((2 * (x + 0.5) / kSize - 1), 1 - 2 * (y + 0.5) / kSize);
            const Vec3 ground(-p.y * std::sqrt(2.0), p.x, 0);
            const Vec3 high = ground + Vec3(1, 0, 1);  // the same ray at height 1
            if (std::abs(high.x) < 0.26 && std::abs(high.y) < 0.26) continue;
            if (std::abs(std::abs(ground.x) - 0.5) < 0.01 || std::abs(std::abs(ground.y) - 0.5) < 0.01) continue;
            const bool dark = std::abs(ground.x) < 0.5 && std::abs(ground.y) < 0.5;
            ASSERT_EQ(lit.at(x, y, 0), dark ? 0 : 1) << x << " " << y;
            shadowed += dark;
        }
    EXPECT_GT(shadowed, 500);
}

TEST(ShadowTruth, ErrorsAreAcneLeaksOrAtABoundary) {
    const Square s;
    const ShadowTruth truth = s.truth();
    const ShadowView view = s.view();
    Image mask = truth.picture();
    EXPECT_EQ(truth.compare(mask, view).misjudged(), 0);
    EXPECT_GT(truth.compare(mask, view).pixels, 9000u);
    // One pixel of each: in the shadow, in the light, at the shadow's edge (ground y = 0.5 within a texel).
    const auto pixelAt = [](const Vec2& ground) {
        return glm::ivec2(static_cast<int>((ground.y + 1) / 2 * kSize),
                          static_cast<int>((1 + ground.x / std::sqrt(2.0)) / 2 * kSize));
    };
    const glm::ivec2 inside = pixelAt({0, 0}), outside = pixelAt({0.2, 0.9}), edge = pixelAt({0, 0.5});
    ASSERT_EQ(mask.at(inside.x, inside.y, 0), 0);
    ASSERT_EQ(mask.at(outside.x, outside.y, 0), 1);
    for (const glm::ivec2& p : {inside, outside, edge}) mask.at(p.x, p.y, 0) = 1 - mask.at(p.x, p.y, 0);
    const ShadowError error = truth.compare(mask, view);
    EXPECT_EQ(error.leaks, 1u);
    EXPECT_EQ(error.acne, 1u);
    EXPECT_EQ(error.boundary, 1u);
}

// Where a floor meets a wall the light's view has a crease, but no shadow's edge: an error there is no boundary pixel.
TEST(ShadowTruth, ACreaseIsNoBoundary) {
    Mesh mesh = squares({{4, 0}});
    for (glm::vec3& p : mesh.positions) p.y = std::min(p.y, 0.2f);  // no floor goes on behind the wall
    const auto first = static_cast<unsigned>(mesh.positions.size());
    for (const glm::vec3 p :
         {glm::vec3(-4, 0.2f, 0), glm::vec3(4, 0.2f, 0), glm::vec3(4, 0.2f, 4), glm::vec3(-4, 0.2f, 4)}) {
        mesh.positions.push_back(p);
        mesh.normals.emplace_back(0, -1, 0);
    }
    mesh.triangles.emplace_back(first, first + 1, first + 2);
    mesh.triangles.emplace_back(first, first + 2, first + 3);
    Camera camera;
    camera.eye = {0, -4, 3};
    camera.up = {0, 0, 1};
    const Light light{true, glm::normalize(Vec3(0.1, -1, 0.3)), Rgb(1)};
    const ShadowTruth truth(mesh, camera, light, {kSize, kSize});
    SceneShadow options;
    options.size = 64;  // coarse: the crease lies within the filter of many pixels
    const Image black(kSize, kSize, 1);
    const ShadowError error = truth.compare(black, fitShadow(options, light, boundsOf(mesh)));
    EXPECT_EQ(error.boundary, 0u);
    EXPECT_EQ(error.acne, error.pixels);
}

TEST(ShadowTruth, SurfacesThatTheLightDoesNotFaceAreNoQuestion) {
    Square s;
    s.light = {false, {0, 0, -2}, Rgb(1), {}};
    const Image lit = s.truth().picture();
    for (const float v : lit.data()) EXPECT_EQ(v, 0.5f);
}

TEST(TracedShadowMap, HoldsDepthsInItsCode) {
    const Square s;
    ShadowView view = s.view();
    view.near = 0.002, view.far = 2.1;
    for (const bool hyperbolic : {false, true})
        for (const int bits : {0, 12, 16, 24}) {
            const Image map = tracedShadowMap(s.mesh, view, {hyperbolic, bits})[0];
            const auto z = [&](int x, int y) { return view.near + (view.far - view.near) * map.at(x, y, 0); };
            // A z-buffer's step at depth z is z² (1/near − 1/far) / 2^bits; floats hold the rest.
            const double step = bits == 0 ? 0 : hyperbolic ? 4 * 500 / std::pow(2, bits) : 2.1 / std::pow(2, bits);
            const double rounding = 1e-6;
            EXPECT_NEAR(z(128, 128), 1, 0.5 * step + rounding) << hyperbolic << bits;
            EXPECT_NEAR(z(5, 5), 2, std::min(1.0, 0.6 * step) + rounding) << hyperbolic << bits;
        }
}

TEST(TracedShadowMap, FineCodesJudgeRightAndCoarseOnesWorse) {
    const Square s;
    const ShadowTruth truth = s.truth();
    ShadowView view = s.view();
    view.near = 0.002, view.far = 2.1;
    const auto error = [&](const DepthCode& code) {
        ShadowView coded = view;
        coded.resolution = 1e-6 + (code.hyperbolic || code.bits == 0 ? 0 : 0.5 * 2.1 / std::pow(2, code.bits));
        const auto layers = tracedShadowMap(s.mesh, view, code);
        return truth.compare(truth.mask(coded, layers, code.hyperbolic ? code.bits : 0), coded);
    };
    EXPECT_EQ(error({false, 0}).offBoundary(), 0);
    EXPECT_EQ(error({false, 16}).offBoundary(), 0);
    EXPECT_EQ(error({true, 24}).offBoundary(), 0);
    EXPECT_GT(error({true, 8}).offBoundary(), 0.05) << "a step is wider than the square is high";
    EXPECT_EQ(error({false, 8}).offBoundary(), 0) << "linear: 1/255 of the range";
}

TEST(ShadowTruth, SameBitsForAnyThreadCount) {
    const Square s;
    ShadowErrorOptions options{kSize, kSize, 1};
    const ShadowTruth one(s.mesh, s.camera, s.light, options);
    options.threads = 7;
    const ShadowTruth seven(s.mesh, s.camera, s.light, options);
    EXPECT_EQ(one.picture().data(), seven.picture().data());
    const auto layers = tracedShadowMap(s.mesh, s.view(), {}, 1);
    EXPECT_EQ(layers[0].data(), tracedShadowMap(s.mesh, s.view(), {}, 7)[0].data());
    EXPECT_EQ(one.mask(s.view(), layers).data(), seven.mask(s.view(), layers).data());
}

TEST(ShadowTruth, BrokenInputIsRefused) {
    Square s;
    EXPECT_THROW(s.truth().compare(Image(3, 3, 1), s.view()), std::invalid_argument);
    EXPECT_THROW(ShadowTruth(s.mesh, s.camera, s.light, {0, 1}), std::invalid_argument);
    ShadowView view = s.view();
    view.near = 0;
    EXPECT_THROW(tracedShadowMap(s.mesh, view, {true, 24}), std::invalid_argument);
    s.mesh.triangles.emplace_back(0, 1, 99);
    EXPECT_THROW(s.truth(), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
