// HSE's three ways to address the tables: what each computes, and how they approach each other.
#include <gtest/gtest.h>

#include "factorize/factorize.hpp"
#include "factorize/models/models.hpp"
#include "gpu_evaluate.hpp"
#include "reference/image_compare.hpp"
#include "shading/lit_pass.hpp"
#include "shading/primitives.hpp"

namespace nacre {
namespace {

constexpr int kSize = 96;

FactoredBrdf bake(const std::string& model, const std::string& method) {
    FactorizeOptions options;
    options.method = method;
    return factorize(makeModel(model), options);
}

/// HSE's own form, with a lobe that its linear tables resolve.
FactoredBrdf cosineBrdf() { return bake("torrance-sparrow:alpha=0.5,f=schlick,f0=0.9/0.6/0.3,kd=0.1", "cosine"); }
FactoredBrdf tangentBrdf() { return bake("banks:n=8,kd=0.1", "tangent"); }

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
    ProgramLoader loader;
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
    ProgramLoader loader;
    for (const FactoredBrdf& factored : {cosineBrdf(), tangentBrdf()}) {
        const GpuFactoredBrdf brdf(factored);
        const Image truth = render(loader, makeQuad(), brdf, Addressing::PerPixel);
        EXPECT_GT(truth.rgb(kSize / 2, kSize / 2).r, 0.01);
        for (Addressing addressing : {Addressing::PerVertex, Addressing::TextureMatrix})
            EXPECT_LT(relativeDifference(render(loader, makeQuad(), brdf, addressing), truth), 1e-5);
    }
}

// The picture's value at one pixel of a plane is the C++ lookup times cosα, whichever way it was addressed.
TEST(Addressing, ComputesTheLookup) {
    test::context();
    ProgramLoader loader;
    const LitView view = paperView();
    const Vec3 l = view.lights[0].position, v = glm::normalize(view.camera.eye);
    for (const FactoredBrdf& factored : {cosineBrdf(), tangentBrdf()})
        for (Addressing addressing : {Addressing::PerPixel, Addressing::PerVertex, Addressing::TextureMatrix}) {
            const Rgb expected = evaluate(factored, l, v) * l.z;
            const Rgb found =
                render(loader, makeQuad(), GpuFactoredBrdf(factored), addressing).rgb(kSize / 2, kSize / 2);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(found[c], expected[c], 1e-4 * expected[c]) << toString(factored.form);
        }
}

// "Fast Phong" does not normalise: between normals tilted by +60 and -60 degrees the interpolated n·l stays cos 60,
// where a normalised vector would face the light, and the per-pixel picture does.
TEST(Addressing, PerVertexVectorsShrinkBetweenVertices) {
    test::context();
    ProgramLoader loader;
    Mesh quad = makeQuad();
    for (std::size_t i = 0; i < quad.positions.size(); ++i) {
        const double tilt = (quad.positions[i].y > 0 ? 1 : -1) * kPi / 3;
        quad.normals[i] = glm::vec3(0, std::sin(tilt), std::cos(tilt));
    }
    LitView view;
    view.lights = {Light{true, {0, 0, 1}, Rgb(kPi)}};
    const GpuDirectBrdf white = directBrdf(makeModel("lambert:kd=1")).value();
    const auto middle = [&](Addressing addressing) {
        const RenderTarget target({.width = 9, .height = 9});
        target.clear();
        renderDirect(loader, target, GpuMesh(quad), view, white, addressing);
        return target.read().rgb(4, 4).g;
    };
    EXPECT_NEAR(middle(Addressing::PerVertex), 0.5, 1e-5);
    EXPECT_NEAR(middle(Addressing::PerPixel), 1.0, 1e-5);
}

TEST(Addressing, TextureMatricesRejectWhatTheyCannotDo) {
    test::context();
    ProgramLoader loader;
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

}  // namespace
}  // namespace nacre
