// Pictures of surrounded meshes against the ray tracer's hits shaded by the same formula: orientation first.
#include "shading/environment_pass.hpp"

#include <gtest/gtest.h>

#include "factorize/factorize.hpp"
#include "factorize/models/models.hpp"
#include "gpu_evaluate.hpp"
#include "reference/environment_shading.hpp"
#include "reference/image_compare.hpp"
#include "shading/primitives.hpp"

namespace nacre {
namespace {

constexpr int kSize = 96;
constexpr EnvLayout kAll[] = {EnvLayout::LatLong, EnvLayout::Cube, EnvLayout::DualParaboloid, EnvLayout::Octahedral};

/// No two directions look alike, and none like its mirror image.
Rgb radianceFrom(const Vec3& d) { return {std::exp(1.2 * d.x), std::exp(0.9 * d.y + 0.4 * d.x * d.z), std::exp(d.z)}; }

EnvMap mapOf(EnvLayout layout, int size, double gain = 1) {
    EnvMap map(layout, size);
    for (int y = 0; y < map.image.height(); ++y)
        for (int x = 0; x < map.image.width(); ++x)
            map.image.setRgb(x, y, gain * radianceFrom(envTexelDirection(layout, size, x, y)));
    return map;
}

Camera lookingAt(bool orthographic) {
    Camera camera;
    camera.eye = {1.5, 1.0, 2.5};
    camera.orthographic = orthographic;
    camera.fovY = 0.8;
    camera.height = 2.6;
    camera.near = 1;
    camera.far = 8;
    return camera;
}

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

AssetTexture fresnelTable() {
    Image image(128, 1, 1);
    for (int i = 0; i < 128; ++i) {
        const double c = sqr(i / 127.0);
        image.at(i, 0, 0) = static_cast<float>(0.04 + 0.96 * std::pow(1 - c, 5));
    }
    return makeTexture("fresnel", "sqrt_cos", image, TexelFormat::Half);
}

Rgb lookupFresnelTable(const AssetTexture& table, double cosine) {
    const int n = table.image.width();
    return Rgb(sampleBilinear(table.image, static_cast<float>((std::sqrt(cosine) * (n - 1) + 0.5) / n), 0.5f).x);
}

// Half floats round by 2.4e-4 on average; a face or an axis the wrong way round is off by more than 0.3.
constexpr double kRelative = 1e-3;

void expectSame(const Image& picture, const Image& truth, const Image& mask) {
    const ImageDifference difference = compareImages(picture, truth, pictureWhite(truth, mask), mask);
    EXPECT_GT(difference.pixels, 500u);
    EXPECT_LT(difference.relative, kRelative);
    EXPECT_LT(difference.maxAbs, 10 * kRelative * maxComponent(Rgb(pictureWhite(truth, mask))));
}

class EnvironmentPass : public ::testing::Test {
protected:
    void SetUp() override { test::context(); }

    Image draw(const Mesh& mesh, const Camera& camera, const EnvironmentSurface& surface) {
        const RenderTarget target({.width = kSize, .height = kSize});
        target.clear();
        ProgramLoader loader;
        renderEnvironment(loader, target, GpuMesh(mesh), camera, surface);
        return target.read();
    }
};

// The surrounding is a formula here, so that the picture is right only if every flip on the way is.
TEST_F(EnvironmentPass, MirrorsShowWhatIsThereInEveryLayout) {
    const Mesh torus = makeTorus(1, 0.4f, 96, 64);
    for (const EnvLayout layout : kAll)
        for (const bool orthographic : {false, true}) {
            SCOPED_TRACE(toString(layout) + (orthographic ? " orthographic" : " perspective"));
            const GpuEnvironment map(mapOf(layout, 256));
            EnvironmentSurface surface;
            surface.reflection.map = &map;
            const Image picture = draw(torus, lookingAt(orthographic), surface);
            const TracedSurface traced =
                traceSurface(torus, lookingAt(orthographic), {.width = kSize, .height = kSize});
            const RaytracedPicture truth =
                assemblePicture(traced, shadeSurrounded(traced, {.reflection = radianceFrom}));
            expectSame(picture, truth.radiance, interior(truth.coverage));
        }
}

TEST_F(EnvironmentPass, EveryTermInBothCombinations) {
    const Mesh sphere = makeSphere(1, 64, 32);
    const AssetTexture table = fresnelTable();
    const GpuEnvironmentTable gpuTable(table);
    for (const EnvLayout layout : kAll) {
        const std::vector<EnvMap> chain = {mapOf(layout, 64), mapOf(layout, 32, 0.5)};
        const EnvMap diffuse = mapOf(layout, 32, 0.3);
        const GpuEnvironment gpuChain(chain, {.scale = 4}), gpuDiffuse(diffuse);
        for (const EnvironmentCombine combine : {EnvironmentCombine::Add, EnvironmentCombine::Blend}) {
            SCOPED_TRACE(toString(layout));
            EnvironmentSurface surface;
            surface.reflection = {&gpuChain, 0.5, Rgb(1, 0.9, 0.8)};
            surface.transmission = {&gpuChain, 1, Rgb(0.2, 0.4, 0.6)};
            surface.diffuse = {&gpuDiffuse, 7, Rgb(0.5, 0.3, 0.1)};  // a single map: the lod is clamped to it
            surface.ior = 1.3;
            surface.table = &gpuTable;
            surface.combine = combine;
            const SurroundedSurface twin{[&](const Vec3& d) {
                                             return Rgb(1, 0.9, 0.8) * 0.5 *
                                                    (sampleEnv(chain[0], d) + sampleEnv(chain[1], d));
                                         },
                                         [&](const Vec3& d) { return Rgb(0.2, 0.4, 0.6) * sampleEnv(chain[1], d); },
                                         [&](const Vec3& d) { return Rgb(0.5, 0.3, 0.1) * sampleEnv(diffuse, d); },
                                         [&](double c) { return lookupFresnelTable(table, c); },
                                         1.3,
                                         combine == EnvironmentCombine::Blend};
            const TracedSurface traced = traceSurface(sphere, lookingAt(false), {.width = kSize, .height = kSize});
            const RaytracedPicture truth = assemblePicture(traced, shadeSurrounded(traced, twin));
            expectSame(draw(sphere, lookingAt(false), surface), truth.radiance, interior(truth.coverage));
        }
    }
}

TEST_F(EnvironmentPass, TheSkyIsBehindAndTurns) {
    const Mesh sphere = makeSphere(0.5f, 64, 32);
    Mat3 turn(0);  // a quarter about y: world +z is the map's +x
    turn[0] = {0, 0, -1}, turn[1] = {0, 1, 0}, turn[2] = {1, 0, 0};
    for (const EnvLayout layout : kAll)
        for (const bool orthographic : {false, true})
            for (const Mat3& fromWorld : {Mat3(1), turn}) {
                SCOPED_TRACE(toString(layout) + (orthographic ? " orthographic" : " perspective"));
                const GpuEnvironment map(mapOf(layout, 256));
                EnvironmentSurface surface;
                surface.reflection.map = &map;
                surface.fromWorld = fromWorld;
                const Camera camera = lookingAt(orthographic);
                const RenderTarget target({.width = kSize, .height = kSize});
                target.clear();
                ProgramLoader loader;
                const GpuMesh mesh(sphere);
                renderEnvironment(loader, target, mesh, camera, surface);
                renderSky(loader, target, camera, surface.reflection, fromWorld);
                const auto turned = [&](const Vec3& d) { return radianceFrom(fromWorld * d); };
                const TracedSurface traced = traceSurface(sphere, camera, {.width = kSize, .height = kSize});
                const RaytracedPicture truth =
                    assemblePicture(traced, shadeSurrounded(traced, {.reflection = turned}, turned));
                Image mask = interior(truth.coverage);  // and the background away from the outline
                Image outside(kSize, kSize, 1);
                for (std::size_t i = 0; i < outside.data().size(); ++i)
                    outside.data()[i] = 1 - truth.coverage.data()[i];
                outside = interior(outside);
                for (std::size_t i = 0; i < outside.data().size(); ++i) mask.data()[i] += outside.data()[i];
                expectSame(target.read(), truth.radiance, mask);
            }
}

TEST_F(EnvironmentPass, LampsAndSurroundingAddUp) {
    const Mesh torus = makeTorus(1, 0.4f, 48, 32);
    const GpuMesh mesh(torus);
    const GpuEnvironment map(mapOf(EnvLayout::Cube, 64));
    const AssetTexture table = fresnelTable();
    const GpuEnvironmentTable gpuTable(table);
    EnvironmentSurface surface;
    surface.reflection.map = &map;
    surface.diffuse = {&map, 0, Rgb(0.2)};
    surface.table = &gpuTable;
    const LitView view{lookingAt(false), {{true, glm::normalize(Vec3(1, 2, 1)), Rgb(1, 0.5, 0.25)}}, Rgb(0.1)};
    FactorizeOptions options;
    options.method = "single-lobe";
    const Reflectance model = makeModel("blinn-phong:n=50,kd=0.3");
    const GpuFactoredBrdf factored(factorize(model, options));
    ProgramLoader loader;
    const RenderTarget target({.width = kSize, .height = kSize});
    const auto picture = [&](const auto& render) {
        target.clear();
        render();
        return target.read();
    };
    const Image surrounding = draw(torus, view.camera, surface);
    const auto expectSum = [&](const Image& lamps, const Image& both) {
        for (std::size_t i = 0; i < both.data().size(); ++i)
            EXPECT_NEAR(both.data()[i], lamps.data()[i] + surrounding.data()[i], 1e-4);
    };
    expectSum(picture([&] { renderFactored(loader, target, mesh, view, factored); }),
              picture([&] { renderFactored(loader, target, mesh, view, factored, surface); }));
    const GpuDirectBrdf direct = directBrdf(model).value();
    expectSum(picture([&] { renderDirect(loader, target, mesh, view, direct); }),
              picture([&] { renderDirect(loader, target, mesh, view, direct, surface); }));
}

TEST_F(EnvironmentPass, RejectsWhatItCannotDraw) {
    const GpuEnvironment cube(mapOf(EnvLayout::Cube, 4)), octahedron(mapOf(EnvLayout::Octahedral, 4));
    EnvironmentSurface surface;
    surface.reflection.map = &cube;
    surface.diffuse.map = &octahedron;
    const Mesh quad = makeQuad();
    EXPECT_THROW(draw(quad, {}, surface), std::invalid_argument);
    surface.diffuse.map = nullptr;
    surface.ior = 0;
    EXPECT_THROW(draw(quad, {}, surface), std::invalid_argument);
    surface.ior = 1;
    surface.reflection.lod = std::nan("");
    EXPECT_THROW(draw(quad, {}, surface), std::invalid_argument);
    const RenderTarget target({.width = 4, .height = 4});
    ProgramLoader loader;
    EXPECT_THROW(renderSky(loader, target, {}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
