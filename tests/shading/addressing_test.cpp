// HSE's three ways to address the tables: what each computes, and how they approach each other.
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "gpu_evaluate.hpp"
#include "reference/image_compare.hpp"
#include "shading/lit_pass.hpp"
#include "shading/primitives.hpp"

namespace nacre {
namespace {

constexpr int kSize = 96;

ProgramLoader standInLoader() {
    return ProgramLoader(Glsl::V330, {NACRE_SOURCE_DIR "/tests/shading/shaders", shaderFolder()});
}

AssetTexture table(const std::string& name, double (*value)(double x, double y), bool signedCoordinates) {
    Image image(64, 64, 3);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const double u = x / 63.0, v = y / 63.0;
            const double f = signedCoordinates ? value(2 * u - 1, 2 * v - 1) : value(u, v);
            image.setRgb(x, y, Rgb(f, 0.5 * f, 0.25 * f));
        }
    return makeTexture(name, "stand_in", image, TexelFormat::Half);
}

/// A smooth lobe: A = cos^8 delta · (1 + (1 − cosθ)), B = 1/(0.2 + cosα cosβ).
FactoredBrdf cosineBrdf() {
    FactoredBrdf brdf;
    brdf.form = FactoredForm::Cosine;
    brdf.textures = {table(
                         "a", [](double t, double d) { return std::pow(d, 8) * (2 - t); }, false),
                     table(
                         "b", [](double a, double b) { return 1 / (0.2 + a * b); }, false)};
    brdf.params[0] = glm::vec4(0.05f);
    return brdf;
}

FactoredBrdf tangentBrdf() {
    FactoredBrdf brdf;
    brdf.form = FactoredForm::Tangent;
    brdf.textures = {table(
        "t", [](double l, double v) { return std::exp(-4 * (l + v) * (l + v)); }, true)};
    return brdf;
}

LitView paperView() {  // directional light, orthographic camera
    LitView view;
    view.camera.eye = {1, 2, 2};
    view.camera.orthographic = true;
    view.camera.height = 2.8;
    view.lights = {Light{true, glm::normalize(Vec3(-0.5, -1, 2)), {1, 1, 1}}};
    return view;
}

Image render(ProgramLoader& loader, const Mesh& mesh, const GpuFactoredBrdf& brdf, Addressing addressing) {
    const RenderTarget target({.width = kSize, .height = kSize});
    target.clear();
    renderFactored(loader, target, GpuMesh(mesh), paperView(), brdf, addressing);
    return target.read();
}

double relativeDifference(const Image& a, const Image& b) { return compareImages(a, b, pictureWhite(b)).relative; }

// Second order in the edge: twice the triangles each way, a quarter of the difference, for both forms and both ways.
TEST(Addressing, ApproachesPerPixelWithTheSquareOfTheEdge) {
    test::context();
    ProgramLoader loader = standInLoader();
    for (const FactoredBrdf& factored : {cosineBrdf(), tangentBrdf()}) {
        const GpuFactoredBrdf brdf(factored);
        for (Addressing addressing : {Addressing::PerVertex, Addressing::TextureMatrix}) {
            double before = 0;
            for (int n : {20, 40, 80}) {
                const Mesh torus = makeTorus(1, 0.4f, 2 * n, n);
                const double error = relativeDifference(render(loader, torus, brdf, addressing),
                                                        render(loader, torus, brdf, Addressing::PerPixel));
                EXPECT_GT(error, 0);  // it is an approximation, and not the same shader
                EXPECT_NEAR(before > 0 ? error / before : 0.25, 0.25, 0.15) << n << " " << brdf.defines()[0].second;
                before = error;
            }
            EXPECT_LT(before, 5e-3);
        }
    }
}

// On a plane nothing is interpolated: all three agree but for rounding.
TEST(Addressing, AgreesOnAPlane) {
    test::context();
    ProgramLoader loader = standInLoader();
    for (const FactoredBrdf& factored : {cosineBrdf(), tangentBrdf()}) {
        const GpuFactoredBrdf brdf(factored);
        const Image truth = render(loader, makeQuad(), brdf, Addressing::PerPixel);
        EXPECT_GT(truth.rgb(kSize / 2, kSize / 2).r, 0.01);
        for (Addressing addressing : {Addressing::PerVertex, Addressing::TextureMatrix})
            EXPECT_LT(relativeDifference(render(loader, makeQuad(), brdf, addressing), truth), 1e-5);
    }
}

// The picture's value at one pixel of a plane is what equations 2 and 3 give by hand.
TEST(Addressing, ComputesTheTablesProduct) {
    test::context();
    ProgramLoader loader = standInLoader();
    const FactoredBrdf factored = cosineBrdf();
    const LitView view = paperView();
    const Vec3 l = view.lights[0].position, v = glm::normalize(view.camera.eye), h = glm::normalize(l + v);
    const auto fetch = [](const AssetTexture& t, double x, double y) {
        const auto place = [](double c) { return static_cast<float>((c * 63 + 0.5) / 64); };
        return static_cast<double>(sampleBilinear(t.image, place(x), place(y)).r);
    };
    const double f = 0.05 + fetch(factored.textures[0], glm::dot(h, l), h.z) * fetch(factored.textures[1], l.z, v.z);
    for (Addressing addressing : {Addressing::PerPixel, Addressing::PerVertex, Addressing::TextureMatrix})
        EXPECT_NEAR(render(loader, makeQuad(), GpuFactoredBrdf(factored), addressing).rgb(kSize / 2, kSize / 2).r,
                    f * l.z, 1e-4 * f);
}

TEST(Addressing, TextureMatricesRejectWhatTheyCannotDo) {
    test::context();
    ProgramLoader loader = standInLoader();
    const RenderTarget target({.width = 4, .height = 4});
    const GpuMesh quad(makeQuad());
    const GpuFactoredBrdf cosine(cosineBrdf());
    LitView view = paperView();
    const auto draw = [&](const GpuFactoredBrdf& brdf) {
        renderFactored(loader, target, quad, view, brdf, Addressing::TextureMatrix);
    };
    EXPECT_NO_THROW(draw(cosine));
    view.camera.orthographic = false;
    EXPECT_THROW(draw(cosine), std::invalid_argument);
    view = paperView();
    view.lights.push_back(view.lights[0]);
    EXPECT_THROW(draw(cosine), std::invalid_argument);
    view = paperView();
    view.lights[0].directional = false;
    EXPECT_THROW(draw(cosine), std::invalid_argument);
    view = paperView();
    FactoredBrdf other = cosineBrdf();
    other.form = FactoredForm::HalfDiff;
    EXPECT_THROW(draw(GpuFactoredBrdf(other)), std::invalid_argument);
    other.textures.resize(5, other.textures[0]);
    EXPECT_THROW(GpuFactoredBrdf{other}, std::invalid_argument);
}

// 8-bit tables reach the shader through scale and bias.
TEST(Addressing, FactoredTablesHaveScaleAndBias) {
    test::context();
    ProgramLoader loader = standInLoader();
    FactoredBrdf factored = cosineBrdf();
    const Image truth = render(loader, makeQuad(), GpuFactoredBrdf(factored), Addressing::PerPixel);
    for (AssetTexture& texture : factored.textures)
        texture = makeTexture(texture.name, texture.mapping, texture.image, TexelFormat::Unorm8);
    const Image coarse = render(loader, makeQuad(), GpuFactoredBrdf(factored), Addressing::PerPixel);
    EXPECT_LT(relativeDifference(coarse, truth), 0.02);  // a 255th of the range in each table, 256 filter weights
    EXPECT_GT(relativeDifference(coarse, truth), 1e-6);
}

}  // namespace
}  // namespace nacre
