// Spots in GLSL: the function against its C++ twin, and pictures against the ray tracer.
#include <gtest/gtest.h>

#include "factorize/models/models.hpp"
#include "gpu_evaluate.hpp"
#include "reference/raytrace.hpp"
#include "shading/lit_pass.hpp"
#include "shading/primitives.hpp"

namespace nacre {
namespace {

constexpr double kSinglePrecision = 1e-4;  // cosines hold 24 bits and are divided by the edge's width, 0.01 at least

TEST(Spot, ShareInGlslAndCpp) {
    test::context();
    const auto pairs = test::testPairs(1000);
    for (const SpotCone& cone : {SpotCone{glm::normalize(Vec3(0.2, -0.3, -1)), 0, kPi / 2},
                                 SpotCone{{0, 0, -1}, 0.4, 0.8}, SpotCone{{0, 0, -1}, 0.7, 0.7155}}) {
        const double edge = std::cos(cone.inner) - std::cos(cone.outer);
        const Vec4 packed = Vec4(cone.axis, -std::cos(cone.outer)) / edge;
        const auto values = test::gpuEvaluate(
            {.code = "#include \"nacre/light.glsl\"\nvec4 evaluate(vec3 wi, vec3 wo) {\n"
                     "    return vec4(nacre_cone_share(CONE, wi), nacre_cone_share(vec4(0.0, 0.0, 0.0, 1.0), wi), "
                     "0.0, 0.0);\n}\n",
             .defines = {{"CONE", "vec4(" + std::to_string(packed.x) + "," + std::to_string(packed.y) + "," +
                                      std::to_string(packed.z) + "," + std::to_string(packed.w) + ")"}}},
            pairs);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            EXPECT_NEAR(values[i].x, coneShare(cone, pairs[i].wi), kSinglePrecision) << i;
            EXPECT_EQ(values[i].y, 1) << i;
        }
    }
}

Light someSpot() {
    return {false, {0.3, 0.2, 1.5}, {2, 1, 0.5}, SpotCone{glm::normalize(Vec3(-0.2, 0, -1)), 0.2, 0.5}};
}

TEST(Spot, PicturesAreTheRayTracers) {
    test::context();
    ProgramLoader loader;
    const Mesh mesh = makeQuad(2, 64);
    const Reflectance model = makeModel("torrance-sparrow:alpha=0.3,kd=0.4");
    const LitView view{Camera{}, {someSpot(), {false, {-0.5, 0.5, 1}, {0, 1, 2}}}};
    const RaytracedPicture truth = raytrace(mesh, view.camera, view.lights, model.f, {.width = 64, .height = 64});
    const double white = 1;
    for (const Addressing addressing : {Addressing::PerPixel, Addressing::PerVertex}) {
        const RenderTarget target({.width = 64, .height = 64});
        target.clear();
        renderDirect(loader, target, GpuMesh(mesh), view, directBrdf(model).value(), addressing);
        const Image picture = target.read();
        // At the vertices the falloff is interpolated: 64 × 64 squares leave 0.5 % of it.
        const double tolerance = addressing == Addressing::PerPixel ? 1e-3 : 1e-2;
        for (int y = 4; y < 60; ++y)
            for (int x = 4; x < 60; ++x)
                for (int c = 0; c < 3; ++c)
                    ASSERT_NEAR(picture.at(x, y, c), truth.radiance.at(x, y, c), tolerance * white) << x << " " << y;
    }
}

TEST(Spot, BrokenConesAreRefused) {
    test::context();
    ProgramLoader loader;
    const RenderTarget target({.width = 4, .height = 4});
    LitView view{Camera{}, {someSpot()}};
    view.lights[0].directional = true;
    EXPECT_THROW(renderDirect(loader, target, GpuMesh(makeQuad()), view, directBrdf(makeModel("lambert")).value()),
                 std::invalid_argument);
}

}  // namespace
}  // namespace nacre
