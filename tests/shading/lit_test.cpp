// The rasterised picture against the ray-traced one: same mesh, lights, camera and BRDF.
#include <gtest/gtest.h>

#include "factorize/factorize.hpp"
#include "factorize/models/models.hpp"
#include "gpu_evaluate.hpp"
#include "reference/image_compare.hpp"
#include "reference/raytrace.hpp"
#include "shading/lit_pass.hpp"
#include "shading/primitives.hpp"
#include "shading/shading_frame.hpp"

namespace nacre {
namespace {

constexpr int kSize = 96;

/// Pixels whose whole neighbourhood the mesh covers: at outlines the two renderers may see different triangles.
Image interior(const Image& coverage) {
    Image out(coverage.width(), coverage.height(), 1);
    for (int y = 1; y + 1 < coverage.height(); ++y)
        for (int x = 1; x + 1 < coverage.width(); ++x) {
            float least = 1;
            for (int j = -1; j <= 1; ++j)
                for (int i = -1; i <= 1; ++i) least = std::min(least, coverage.at(x + i, y + j, 0));
            out.at(x, y, 0) = least;
        }
    return out;
}

Camera lookingAt(bool orthographic) {
    Camera camera;
    camera.eye = {1.5, 2.0, 2.5};
    camera.orthographic = orthographic;
    camera.fovY = 0.8;
    camera.height = 2.6;
    camera.near = 1;
    camera.far = 8;
    return camera;
}

std::vector<Light> someLights() {
    return {{true, glm::normalize(Vec3(1, 2, 1)), {1.0, 0.5, 0.25}}, {false, {-0.5, 1.5, 1.0}, {0.5, 1.0, 2.0}}};
}

// Single-precision interpolation moves normals by 1e-6 and h by as much; measured 1e-5 to 1e-4. A frame with the wrong
// handedness, or a light's fall-off left out, is off by more than 0.1.
constexpr double kRelative = 1e-3;

void expectSamePicture(const Mesh& mesh, const LitView& view, const BrdfFunction& brdf, const Image& picture) {
    const RaytracedPicture truth = raytrace(mesh, view.camera, view.lights, brdf, {.width = kSize, .height = kSize});
    const Image mask = interior(truth.coverage);
    const double white = pictureWhite(truth.radiance, mask);
    const ImageDifference difference = compareImages(picture, truth.radiance, white, mask);
    EXPECT_GT(difference.pixels, 500u);
    EXPECT_LT(difference.relative, kRelative);
    EXPECT_LT(difference.maxAbs / white, 10 * kRelative);
}

void expectSamePicture(const Mesh& mesh, const std::string& model, bool orthographic) {
    SCOPED_TRACE(model + (orthographic ? " orthographic" : " perspective"));
    const Reflectance reflectance = makeModel(model);
    const LitView view{lookingAt(orthographic), someLights()};
    test::context();
    ProgramLoader loader;
    const RenderTarget target({.width = kSize, .height = kSize});
    target.clear();
    renderDirect(loader, target, GpuMesh(mesh), view, directBrdf(reflectance).value());
    expectSamePicture(mesh, view, reflectance.f, target.read());
}

TEST(LitPass, MatchesTheRayTracer) {
    const Mesh torus = makeTorus(1, 0.4f, 48, 32);
    for (bool orthographic : {false, true}) {
        expectSamePicture(torus, "torrance-sparrow:alpha=0.2,kd=0.2", orthographic);
        expectSamePicture(torus, "ggx:alphax=0.1,alphay=0.4,f=conductor", orthographic);
    }
    expectSamePicture(makeSphere(1, 32, 16, TangentDirection::Radial), "banks:n=20", false);
}

// The ray tracer evaluates the C++ twin of the lookup: same tables, same filter, so the same picture.
TEST(LitPass, FactoredMatchesTheRayTracer) {
    test::context();
    ProgramLoader loader;
    const Mesh sphere = makeSphere(1, 64, 32);
    const GpuMesh gpuSphere(sphere);
    for (const auto& [model, method] : {std::pair{"torrance-sparrow:alpha=0.4,kd=0.2", "cosine"},
                                        {"blinn-phong:n=50,kd=0.3", "single-lobe"},
                                        {"banks:n=20", "tangent"}}) {
        SCOPED_TRACE(model);
        FactorizeOptions options;
        options.method = method;
        const FactoredBrdf factored = factorize(makeModel(model), options);
        const LitView view{lookingAt(false), someLights()};
        const RenderTarget target({.width = kSize, .height = kSize});
        target.clear();
        renderFactored(loader, target, gpuSphere, view, GpuFactoredBrdf(factored));
        expectSamePicture(
            sphere, view, [&](const Vec3& wi, const Vec3& wo) { return evaluate(factored, wi, wo); }, target.read());
    }
}

// Tangents whose length and angle to the normal are off, and left-handed frames.
TEST(LitPass, MatchesTheRayTracerOnSkewedFrames) {
    Mesh mesh = makeTorus(1, 0.4f, 48, 32);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::vec3 t(mesh.tangents[i]), b = glm::cross(mesh.normals[i], t);
        mesh.tangents[i] = glm::vec4(0.6f * t + 0.3f * b + 0.5f * mesh.normals[i], -1.0f);
        mesh.normals[i] *= 1.5f;
    }
    expectSamePicture(mesh, "ward:alphax=0.08,alphay=0.5", false);
    for (glm::vec4& tangent : mesh.tangents) tangent = glm::vec4(0, 0, 0, 1);
    expectSamePicture(mesh, "ggx:alphax=0.2,alphay=0.5", true);  // none left: any perpendicular, the same in both
}

TEST(LitPass, FrameInGlslAndCpp) {
    test::context();
    std::vector<DirectionPair> pairs = test::testPairs(500);  // wi as normal, wo as tangent
    pairs.push_back({{0, 0, 1}, {0, 0, 1}});
    pairs.push_back({{1, 0, 0}, {0, 0, 0}});
    for (const float handedness : {1.0f, -1.0f})
        for (int column = 0; column < 3; ++column) {
            const auto values = test::gpuEvaluate(
                {.code = "#include \"nacre/frame.glsl\"\nvec4 evaluate(vec3 n, vec3 t) {\n"
                         "    mat3 frame = nacre_frame(2.0 * n, vec4(3.0 * t, HANDEDNESS));\n"
                         "    return vec4(frame[COLUMN], nacre_to_local(frame, vec3(1.0, 2.0, 3.0))[COLUMN]);\n}\n",
                 .defines = {{"HANDEDNESS", std::to_string(handedness)}, {"COLUMN", std::to_string(column)}}},
                pairs);
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                const Vec3 cross = glm::cross(pairs[i].wi, pairs[i].wo);
                if (glm::length(cross) < 1e-3 && glm::length(cross) > 0) continue;  // rounding picks the tangent
                const Mat3 frame = shadingFrame(2.0 * pairs[i].wi, Vec4(3.0 * pairs[i].wo, handedness));
                EXPECT_NEAR(glm::dot(frame[1], glm::cross(frame[2], frame[0])), handedness, 1e-6);
                for (int c = 0; c < 3; ++c) EXPECT_NEAR(values[i][c], frame[column][c], 2e-4) << i;
                EXPECT_NEAR(values[i].w, glm::dot(frame[column], Vec3(1, 2, 3)), 1e-3) << i;
            }
        }
}

TEST(LitPass, LightsInThePlaneAndBehind) {
    test::context();
    ProgramLoader loader;
    const RenderTarget target({.width = 16, .height = 16});
    const GpuMesh quad(makeQuad());
    const GpuDirectBrdf brdf = directBrdf(makeModel("lambert:kd=1")).value();
    LitView view;
    for (const Light& light : {Light{true, {1, 0, 0}, Rgb(1)}, Light{true, {0, 0, -1}, Rgb(1)},
                               Light{false, {3, 0, 0}, Rgb(1)}, Light{false, {0, 0, -1}, Rgb(1)}}) {
        view.lights = {light};
        target.clear();
        renderDirect(loader, target, quad, view, brdf);
        const Image picture = target.read();
        for (float value : picture.data()) EXPECT_EQ(value, 0.0f);
    }
    view.lights.clear();
    view.ambient = Rgb(0.25, 0.5, 1);
    target.clear();
    renderDirect(loader, target, quad, view, brdf);
    EXPECT_EQ(target.read().rgb(8, 8), view.ambient);
}

TEST(LitPass, RejectsWhatItCannotDraw) {
    test::context();
    ProgramLoader loader;
    const RenderTarget target({.width = 4, .height = 4});
    const GpuDirectBrdf brdf = directBrdf(makeModel("lambert")).value();
    EXPECT_THROW(GpuMesh(Mesh{}), std::invalid_argument);
    Mesh bad = makeQuad();
    bad.triangles[0].x = 99;
    EXPECT_THROW(GpuMesh{bad}, std::invalid_argument);
    bad = makeQuad();
    bad.tangents.pop_back();
    EXPECT_THROW(GpuMesh{bad}, std::invalid_argument);
    const GpuMesh quad(makeQuad());
    LitView view;
    view.lights = {Light{true, {0, 0, 2}, Rgb(1)}};
    EXPECT_THROW(renderDirect(loader, target, quad, view, brdf), std::invalid_argument);
    view.lights.assign(kMaxLights + 1, Light{});
    EXPECT_THROW(renderDirect(loader, target, quad, view, brdf), std::invalid_argument);
    view.lights.assign(kMaxVertexLights + 1, Light{});
    EXPECT_THROW(renderDirect(loader, target, quad, view, brdf, Addressing::PerVertex), std::invalid_argument);
    view.lights.resize(1);
    EXPECT_THROW(renderDirect(loader, target, quad, view, brdf, Addressing::TextureMatrix), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
