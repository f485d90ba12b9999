// Rays from specular pixels: against Snell's law through a ball and mirrors by hand.
#include "shading/hybrid/traced_pixels.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "factorize/models/models.hpp"
#include "hybrid_fixture.hpp"
#include "shading/primitives.hpp"

namespace nacre {
namespace {

int addSpecular(SceneDescription& scene, const SceneSpecular& specular) {
    SceneMaterial& m = scene.materials.emplace_back();
    m.name = "specular";
    m.specular = specular;
    return static_cast<int>(scene.materials.size()) - 1;
}

std::vector<BrdfFunction> brdfs(const SceneDescription& scene) {
    std::vector<BrdfFunction> out;
    for (const SceneMaterial& m : scene.materials)
        out.push_back(m.model.empty() ? BrdfFunction() : makeModel(m.model).f);
    return out;
}

SpecularTracer tracerOf(const SceneDescription& scene) {
    return SpecularTracer(scene, nodeTransforms(scene, 0), brdfs(scene));
}

/// A pixel that shows a specular point.
SeenPoint tagged(const Vec3& place, const Vec3& normal, std::size_t node) {
    return {glm::vec4(glm::vec3(place), static_cast<float>(node + 1)), glm::vec4(glm::vec3(normal), 1)};
}

TEST(SpecularTracer, RaysThroughAGlassBallBendAsSnellSays) {
    SceneDescription scene = test::emptyRoom();
    SceneSpecular glass;
    glass.ior = 1.5;
    glass.partial = false;  // one path
    const int material = addSpecular(scene, glass);
    scene.meshes.push_back({"ball", makeSphere(1, 512, 256)});
    SceneNode& ball = scene.nodes.emplace_back();
    ball.mesh = 0, ball.material = material;
    scene.camera.eye = {0, 0, 5};
    const SpecularTracer tracer = tracerOf(scene);
    for (const double height : {0.0, 0.2, 0.5, 0.8}) {
        // From the eye to the ball at this height; both refractions turn the ray by θ − θ' towards the axis.
        const Vec3 place(0, height, std::sqrt(1 - height * height)), along = glm::normalize(place - scene.camera.eye);
        const double before = std::acos(-glm::dot(along, place)), inside = std::asin(std::sin(before) / 1.5);
        const double turned = std::atan2(along.y, -along.z) - 2 * (before - inside);
        const std::vector<SeenPoint> seen{tagged(place, place, 0)};
        const std::vector<TracedEnd> ends = tracer.follow(seen, 1, 4);
        ASSERT_EQ(ends.size(), 1u) << height;
        EXPECT_FALSE(ends[0].hit);
        EXPECT_NEAR(ends[0].direction.y, std::sin(turned), 2e-3) << height;  // chords: (π/256)²/8 of the radius
        EXPECT_NEAR(ends[0].direction.x, 0, 2e-3);
        EXPECT_EQ(ends[0].share, Rgb(1));
    }
}

TEST(SpecularTracer, SharesOfGlassAreFresnels) {
    SceneDescription scene = test::emptyRoom();
    SceneSpecular glass;
    glass.ior = 1.5;
    test::addSquare(scene, 1, {0, 0, 0}, {0, 0, 1}, addSpecular(scene, glass));
    const std::vector<SeenPoint> seen{tagged({0, 0, 0}, {0, 0, 1}, 0)};
    const std::vector<TracedEnd> ends = tracerOf(scene).follow(seen, 1, 4);
    ASSERT_EQ(ends.size(), 2u);
    EXPECT_NEAR(ends[0].share.g, 0.96, 1e-9) << "refracted";
    EXPECT_NEAR(ends[1].share.g, 0.04, 1e-9) << "reflected";
    EXPECT_TRUE(tracerOf(scene).follow(seen, 1, 0).empty());
}

/// A floor before a mirror on the wall, the eye above the floor.
SceneDescription mirrorRoom() {
    SceneDescription scene = test::emptyRoom();
    test::addSquare(scene, 2, {0, 0, 0}, {0, 1, 0});
    test::addSquare(scene, 1, {0, 1, -2}, {0, 0, 1}, addSpecular(scene, {}));
    test::addLight(scene, {false, {0, 1.5, 0}, Rgb(2), {}});
    scene.camera.eye = {0, 1, 2};
    scene.camera.target = {0, 0.9, 0};
    scene.camera.fovY = 1.4;
    return scene;
}

TEST(SpecularTracer, EndsThatTheEyeSeesTakeThePicturesLight) {
    const SceneDescription scene = mirrorRoom();
    const SpecularTracer tracer = tracerOf(scene);
    const Vec3 place(0, 1.0 / 3, -2), onFloor(0, 0, 0);  // on the way from the eye's image at (0, 1, −6)
    std::vector<SeenPoint> seen(9 * 9);
    const glm::dmat4 toClip = scene.camera.projection(1) * scene.camera.view();
    for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 9; ++x) {
            // where each pixel's ray meets the floor
            const glm::dmat4 back = glm::inverse(toClip);
            Vec4 far = back * Vec4((x + 0.5) / 4.5 - 1, (y + 0.5) / 4.5 - 1, 1, 1);
            const Vec3 eye = scene.camera.eye, d = Vec3(far) / far.w - eye, p = eye - eye.y / d.y * d;
            if (d.y < 0)
                seen[static_cast<std::size_t>(9 * y + x)] = {glm::vec4(glm::vec3(p), 1), glm::vec4(0, 1, 0, 0)};
        }
    seen[80] = tagged(place, {0, 0, 1}, 1);
    const std::vector<TracedEnd> ends = tracer.follow(seen, 9, 4);
    ASSERT_EQ(ends.size(), 1u);
    ASSERT_TRUE(ends[0].hit);
    EXPECT_NEAR(glm::length(ends[0].at.place - onFloor), 0, 1e-5);
    Image picture(9, 9, 3);
    for (float& v : picture.data()) v = 7;
    TracedLight light;
    light.lamps = {scene.lights[0].light};
    light.shadowed = {true};
    TracedReport report;
    const Image reused = tracer.shade(ends, seen, picture, light, &report);
    EXPECT_NEAR(reused.at(8, 0, 0), 7, 1e-4) << "row 0 is on top";
    EXPECT_EQ(report.pixels, 1u);
    EXPECT_EQ(report.reused, 1);
    for (SeenPoint& p : seen) p.place.w = 5;  // another node hides the floor
    const Image own = tracer.shade(ends, seen, picture, light, &report);
    EXPECT_EQ(report.reused, 0);
    EXPECT_NEAR(own.at(8, 0, 0), 0.5 / kPi * 2 / (1.5 * 1.5), 1e-6) << "the lamp is right above";
    EXPECT_EQ(own.at(0, 0, 0), 0);
}

TEST(SpecularTracer, OwnLightHasShadowsAndVirtualLights) {
    SceneDescription scene = mirrorRoom();
    const auto lightAt = [&](const TracedLight& light) {
        const SpecularTracer tracer = tracerOf(scene);
        const std::vector<SeenPoint> seen{tagged({0, 1.0 / 3, -2}, {0, 0, 1}, 1)};
        return tracer.shade(tracer.follow(seen, 1, 4), seen, Image(1, 1, 3), light).at(0, 0, 0);
    };
    TracedLight light;
    light.lamps = {scene.lights[0].light};
    light.shadowed = {true};
    EXPECT_GT(lightAt(light), 0);
    test::addSquare(scene, 0.2, {0, 1, 0}, {0, 1, 0});  // between lamp and floor
    EXPECT_EQ(lightAt(light), 0);
    light.shadowed = {false};
    EXPECT_GT(lightAt(light), 0);
    const VirtualPointLight v{{0, 2, 0}, {0, -1, 0}, {0, 2, 0}, {0.1, 0, 0}, {0, 0, 0.1}, Rgb(3)};
    light = {};
    light.virtuals = std::span(&v, 1);
    light.near = NearLight::Point;
    EXPECT_NEAR(lightAt(light), 0.5 / kPi * 3 / kPi / 4, 1e-6);
    light.virtualShadows = true;
    EXPECT_EQ(lightAt(light), 0);
}

TEST(SpecularTracer, SaysWhatItDoesntTrace) {
    SceneDescription scene = mirrorRoom();
    scene.materials[1].specular->spread = 0.1;
    try {
        tracerOf(scene);
        FAIL() << "frosted";
    } catch (const Error& e) {
        EXPECT_THAT(e.what(), testing::StartsWith("traced pixels: material 'specular': expected a clear"));
    }
}

}  // namespace
}  // namespace nacre
