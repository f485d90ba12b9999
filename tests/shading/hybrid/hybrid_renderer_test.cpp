// Virtual lights as drawn: against closed forms, and HYBRID figure 8.
#include "shading/hybrid/hybrid_renderer.hpp"

#include <gtest/gtest.h>

#include "../gpu_evaluate.hpp"
#include "hybrid_fixture.hpp"

namespace nacre {
namespace {

struct Drawn {
    HybridPicture picture;
    HybridReport report;
};

Drawn draw(const SceneDescription& scene, const VirtualLightOptions& lights, int size = 33) {
    test::context();
    ProgramLoader loader;
    HybridRenderer renderer(loader, scene, test::materialsOf(scene));
    HybridOptions options;
    options.virtualLights = lights;
    HybridPicture picture = renderer.draw(size, size, options);
    return {std::move(picture), renderer.report()};
}

double largest(const Image& image) {
    float out = 0;
    for (const float v : image.data()) {
        EXPECT_TRUE(std::isfinite(v));
        out = std::max(out, v);
    }
    return out;
}

/// A floor under a ceiling, and a lamp between them that shines up alone; the camera is between both too.
SceneDescription litCeiling() {
    SceneDescription scene = test::emptyRoom();
    test::addSquare(scene, 2, {0, 0, 0}, {0, 0, 1});
    test::addSquare(scene, 0.7, {0, 0, 1}, {0, 0, -1});
    test::addLight(scene, {false, {0, 0, 0.5}, Rgb(1), SpotCone{{0, 0, 1}, 1.3, 1.5}});
    scene.camera.eye = {0, 0, 0.95};
    scene.camera.target = {0, 0, 0};
    scene.camera.near = 0.01;
    return scene;
}

TEST(HybridRenderer, CeilingLightsTheFloorByItsFormFactor) {
    const Drawn out = draw(litCeiling(), {.count = 256, .shadows = true});
    // E(x, y) = I cosθ / r² on the ceiling; what the floor's middle gets of it by quadrature
    double expected = 0;
    constexpr int kSteps = 400;
    for (int j = 0; j < kSteps; ++j)
        for (int i = 0; i < kSteps; ++i) {
            const double side = 1.4 / kSteps, x = side * (i + 0.5) - 0.7, y = side * (j + 0.5) - 0.7;
            const double r2 = x * x + y * y + 0.25, irradiance = 0.5 / (r2 * std::sqrt(r2)), d2 = x * x + y * y + 1;
            expected += 0.5 / kPi * irradiance / (d2 * d2) * side * side;
        }
    expected *= 0.5 / kPi;
    EXPECT_NEAR(out.picture.indirect.at(16, 16, 1), expected, 0.01 * expected);
    EXPECT_EQ(out.report.leftOut, 0);
    EXPECT_EQ(out.report.lights, 256u);
}

TEST(HybridRenderer, Figure8LightLeaksWithoutShadowMapsAndDoesNotWithThem) {
    // A lit wall at x = −1, a screen at x = 0 that the lamp is on the wall's side of, and a floor behind the screen.
    SceneDescription scene = test::emptyRoom();
    test::addSquare(scene, 1, {-1, 0, 0}, {1, 0, 0});
    test::addSquare(scene, 3, {0, 0, 0}, {-1, 0, 0}, test::addWhite(scene, 0));
    test::addSquare(scene, 0.5, {1, -0.5, 0}, {0, 1, 0});
    test::addLight(scene, {false, {-0.5, 0, 0}, Rgb(1), {}});
    scene.camera.eye = {1, 1, 0};
    scene.camera.target = {1, 0, 0};
    scene.camera.up = {0, 0, 1};
    const Image leaks = draw(scene, {.count = 32}).picture.indirect,
                mended = draw(scene, {.count = 32, .shadows = true}).picture.indirect;
    EXPECT_GT(leaks.at(16, 16, 0), 1e-3);
    EXPECT_LT(largest(mended), 0.02 * largest(leaks)) << "from lights that the floor sees at its horizon";
}

TEST(HybridRenderer, AVirtualLightOnTheShadedSurfaceAddsNothingToIt) {
    SceneDescription scene = test::emptyRoom();
    test::addSquare(scene, 1, {0, 0, 0}, {0, 0, 1});
    test::addLight(scene, {false, {0, 0, 1}, Rgb(1), {}});
    for (const NearLight near : {NearLight::Point, NearLight::Disk, NearLight::Rectangle})
        for (const bool shadows : {false, true})
            EXPECT_LT(largest(draw(scene, {.count = 16, .shadows = shadows, .near = near}).picture.indirect), 1e-6);
}

TEST(HybridRenderer, TheClampSaysWhatItTakes) {
    SceneDescription scene = test::emptyRoom();  // a corner
    test::addSquare(scene, 1, {0, 0, 0}, {0, 0, 1});
    test::addSquare(scene, 1, {1, 0, 1}, {-1, 0, 0});
    test::addLight(scene, {false, {0, 0, 1}, Rgb(1), {}});
    const Drawn point = draw(scene, {.count = 16, .near = NearLight::Point}),
                disk = draw(scene, {.count = 16, .near = NearLight::Disk});
    EXPECT_EQ(point.report.clamped, 0);
    EXPECT_GT(disk.report.clamped, 0.01);
    double ofPoint = 0, ofDisk = 0;
    for (const float v : point.picture.indirect.data()) ofPoint += v;
    for (const float v : disk.picture.indirect.data()) ofDisk += v;
    EXPECT_NEAR(disk.report.clamped, 1 - ofDisk / ofPoint, 1e-3);
}

TEST(HybridRenderer, AnEmptyRoomIsBlack) {
    SceneDescription scene = test::emptyRoom();
    test::addLight(scene, {false, {0, 0, 1}, Rgb(1), {}});
    const Drawn out = draw(scene, {.shadows = true});
    EXPECT_EQ(largest(out.picture.blended), 0);
    EXPECT_EQ(out.report.lights, 0u);
}

TEST(VirtualLightGlsl, IsItsTwin) {
    test::context();
    const std::vector<DirectionPair> pairs = test::testPairs(200);
    const char* kNear[] = {"NACRE_VIRTUAL_POINT", "NACRE_VIRTUAL_DISK", "NACRE_VIRTUAL_RECTANGLE"};
    for (const NearLight near : {NearLight::Point, NearLight::Disk, NearLight::Rectangle})
        for (const double distance : {0.7, 3.0}) {
            const auto values = test::gpuEvaluate(
                {"#include \"nacre/virtual_light.glsl\"\n"
                 "vec4 evaluate(vec3 wi, vec3 wo) { return vec4(nacre_virtual_light(" +
                 std::string(kNear[static_cast<int>(near)]) + ", " + std::to_string(distance) +
                 " * wi, wo, vec3(0.0, 0.0, -1.0), 0.24 / 3.14159265, vec3(0.2, 0.0, 0.0), vec3(0.0, -0.3, 0.0)), "
                 "0.0, 0.0); }"},
                pairs);
            VirtualPointLight light{{}, {0, 0, -1}, {}, {0.2, 0, 0}, {0, -0.3, 0}, Rgb(1)};
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                light.place = distance * pairs[i].wi;
                const Vec2 expected = virtualLightGeometry(light, Vec3(0), pairs[i].wo, near);
                EXPECT_NEAR(values[i].x, expected.x, 1e-4 * (1 + expected.x)) << i;
                EXPECT_NEAR(values[i].y, expected.y, 1e-6 * (1 + expected.y)) << i;
            }
        }
    const auto frame =
        test::gpuEvaluate({"#include \"nacre/virtual_light.glsl\"\n"
                           "vec4 evaluate(vec3 wi, vec3 wo) { return vec4(wo * nacre_virtual_frame(-wi), 0.0); }"},
                          pairs);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const Vec3 local = glm::transpose(virtualLightFrame(-pairs[i].wi)) * pairs[i].wo;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(frame[i][c], local[c], 1e-6) << i;
        EXPECT_NEAR(glm::determinant(virtualLightFrame(-pairs[i].wi)), 1, 1e-9);
    }
}

}  // namespace
}  // namespace nacre
