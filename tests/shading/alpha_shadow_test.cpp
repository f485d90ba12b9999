// The alpha-tested shadow map of HSE section 2.1: both forms, all bits, against rays.
#include "shading/alpha_shadow.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "factorize/models/models.hpp"
#include "gpu_evaluate.hpp"
#include "reference/raytrace.hpp"
#include "reference/shadow_error.hpp"
#include "shading/primitives.hpp"
#include "shading/texture.hpp"

namespace nacre {
namespace {

constexpr int kSize = 160;
constexpr double kSteep = 0.003;  // acne on the ball's sides, beyond what the bias clears

void append(Mesh& mesh, const Mesh& other) {
    const auto first = static_cast<unsigned>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
    mesh.tangents.insert(mesh.tangents.end(), other.tangents.begin(), other.tangents.end());
    mesh.uvs.insert(mesh.uvs.end(), other.uvs.begin(), other.uvs.end());
    for (const glm::uvec3& t : other.triangles) mesh.triangles.push_back(t + first);
}

/// A ball above a floor.
Mesh someScene() {
    const glm::dmat4 lie = glm::rotate(glm::dmat4(1), -kPi / 2, Vec3(1, 0, 0));
    Mesh mesh = transformed(makeQuad(6, 16), glm::translate(glm::dmat4(1), Vec3(0, -0.8, 0)) * lie);
    append(mesh, makeSphere(0.5f, 64, 32));
    return mesh;
}

Camera someCamera() {
    Camera camera;
    camera.eye = {0.6, 1.8, 3};
    camera.target = {0, -0.4, 0};
    camera.fovY = 0.8;
    return camera;
}

std::vector<Light> someLights() {
    const Vec3 at(1, 3, 0.5);
    return {{false, at, Rgb(6), SpotCone{glm::normalize(Vec3(0, -0.5, 0) - at), 0.4, 0.5}},
            {true, glm::normalize(Vec3(0.3, 1, 0.2)), Rgb(0.6)}};
}

struct Drawn {
    Image picture;
    ShadowView view;
};

Drawn draw(const Mesh& mesh, const Light& light, const AlphaShadowOptions& options, GlApi api = GlApi::Core33,
           Glsl dialect = Glsl::V330) {
    test::context(api);
    ProgramLoader loader(dialect);
    const GpuMesh gpu(mesh);
    AlphaShadow shadow(options);
    const ShadowScene scene{{{&gpu}}, boundsOf(mesh)};
    shadow.update(loader, light, scene);
    const LitView view{someCamera(), {light}, Rgb(0.0625)};
    return {shadow.render(loader, scene.casters, view, directBrdf(makeModel("lambert")).value(), kSize, kSize),
            shadow.view()};
}

/// What a picture misjudges. The light is so bright that all it reaches is brighter than the ambient light.
ShadowError errorOf(const Mesh& mesh, const Light& light, const AlphaShadowOptions& options) {
    Light bright = light;
    bright.color *= 1e4;
    const Drawn drawn = draw(mesh, bright, options);
    Image mask(kSize, kSize, 1);
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) mask.at(x, y, 0) = drawn.picture.at(x, y, 1) > 0.0625 * 1.1 ? 1 : 0;
    return ShadowTruth(mesh, someCamera(), light, {kSize, kSize}).compare(mask, drawn.view);
}

TEST(AlphaShadow, RampInGlslAndCpp) {
    test::context();
    Image ramp(kAlphaRampTexels, 1, 1);
    for (int i = 0; i < kAlphaRampTexels; ++i) ramp.at(i, 0, 0) = static_cast<float>(i) / (kAlphaRampTexels - 1);
    const Texture texture(ramp);
    std::vector<DirectionPair> pairs;
    for (int i = -10; i <= 1010; ++i) pairs.push_back({{i / 1000.0 + 1e-4, 0, 0}, {0, 0, 0}});
    for (const int bits : {8, 16, 32}) {
        const auto values = test::gpuEvaluate(
            {.code = "#include \"nacre/alpha_shadow.glsl\"\nuniform sampler2D ramp;\n"
                     "vec4 evaluate(vec3 wi, vec3 wo) {\n    float a = nacre_alpha_ramp(ramp, wi.x, STEPS);\n"
                     "    return vec4(a, nacre_alpha_difference(a, 0.25), 0.0, 0.0);\n}\n",
             .defines = {{"STEPS", bits == 32 ? "0.0" : std::to_string((1 << bits) - 1) + ".0"}},
             .bind =
                 [&](const Program& program) {
                     texture.bind(2);
                     program.set("ramp", 2);
                 }},
            pairs);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            EXPECT_NEAR(values[i].x, alphaRamp(pairs[i].wi.x, bits), bits == 16 ? 2e-5 : 1e-6) << bits << " " << i;
            EXPECT_NEAR(values[i].y, std::max(0.0f, values[i].x - 0.25f), 1e-7);
        }
    }
}

// 8 bits: a step is 1/255 of the range, so what is nearer than that to its caster is lit; both scenes keep a gap.
TEST(AlphaShadow, BothFormsAreTheRaysAnswer) {
    const Mesh mesh = someScene();
    for (const Light& light : someLights())
        for (const bool multiTexture : {true, false})
            for (const int bits : {8, 16, 32}) {
                SCOPED_TRACE(std::to_string(bits) + (multiTexture ? " multi-texturing" : " one texture"));
                const ShadowError error = errorOf(mesh, light, {.bits = bits, .multiTexture = multiTexture});
                EXPECT_GT(error.pixels, 8000u);
                EXPECT_LT(error.offBoundary(), kSteep);
                EXPECT_LT(error.misjudged(), 0.03);
            }
}

TEST(AlphaShadow, BothFormsAgree) {
    const Mesh mesh = someScene();
    for (const Light& light : someLights())
        for (const int bits : {8, 16, 32}) {
            const Image one = draw(mesh, light, {.bits = bits, .multiTexture = true}).picture,
                        many = draw(mesh, light, {.bits = bits, .multiTexture = false}).picture;
            std::size_t different = 0;
            for (std::size_t i = 0; i < one.data().size(); ++i)
                different += std::abs(one.data()[i] - many.data()[i]) > 1.5 / 255;
            EXPECT_LT(different, one.data().size() / 2000) << bits;
        }
}

TEST(AlphaShadow, LitPartsAreTheLitPass) {
    const Mesh mesh = someScene();
    for (const Light& light : someLights()) {
        const Drawn drawn = draw(mesh, light, {.bits = 32});
        const RaytracedPicture truth = raytrace(mesh, someCamera(), {light}, makeModel("lambert").f,
                                                {.width = kSize, .height = kSize, .shadows = true});
        std::size_t off = 0, covered = 0;
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) {
                if (truth.coverage.at(x, y, 0) == 0) continue;
                ++covered;
                off += std::abs(drawn.picture.at(x, y, 0) - 0.0625 - truth.radiance.at(x, y, 0)) > 2e-3;
            }
        EXPECT_LT(static_cast<double>(off), 0.03 * static_cast<double>(covered));
    }
}

TEST(AlphaShadow, WithoutBiasSurfacesShadowThemselves) {
    const Mesh mesh = someScene();
    const Light light = someLights()[0];
    EXPECT_GT(errorOf(mesh, light, {.bits = 32, .bias = 0}).acne, 1000u);
    EXPECT_GT(errorOf(mesh, light, {.bits = 32, .bias = 10}).leaks, 100u);
}

TEST(AlphaShadow, DrawsInEveryDialect) {
    const Mesh mesh = someScene();
    for (const bool multiTexture : {true, false}) {
        const AlphaShadowOptions options{.multiTexture = multiTexture};
        const Image a = draw(mesh, someLights()[0], options).picture,
                    b = draw(mesh, someLights()[0], options, GlApi::Core45, Glsl::V450).picture;
        EXPECT_EQ(a.data(), b.data());
    }
    test::context();
}

TEST(AlphaShadow, BrokenInputIsRefused) {
    test::context();
    ProgramLoader loader;
    EXPECT_THROW(AlphaShadow({.bits = 24}), std::invalid_argument);
    AlphaShadow shadow;
    const GpuMesh gpu(makeQuad());
    const GpuDirectBrdf brdf = directBrdf(makeModel("lambert")).value();
    const LitView view{Camera{}, {someLights()[1]}};
    const std::vector<ShadowCaster> meshes{{&gpu}};
    EXPECT_THROW(shadow.render(loader, meshes, view, brdf, 4, 4), std::invalid_argument) << "not drawn";
    EXPECT_THROW(shadow.update(loader, {false, {0, 0, 1}, Rgb(1)}, {meshes, boundsOf(makeQuad())}),
                 std::invalid_argument)
        << "a cube";
    shadow.update(loader, someLights()[1], {meshes, boundsOf(makeQuad())});
    EXPECT_THROW(shadow.render(loader, meshes, {Camera{}, someLights()}, brdf, 4, 4), std::invalid_argument);
    EXPECT_NO_THROW(shadow.render(loader, meshes, view, brdf, 4, 4));
}

}  // namespace
}  // namespace nacre
