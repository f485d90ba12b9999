// A mesh drawn with a matrix looks as nacre::transformed(mesh, matrix) drawn without.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "core/scene_description.hpp"
#include "factorize/factorize.hpp"
#include "factorize/models/models.hpp"
#include "gpu_evaluate.hpp"
#include "reference/image_compare.hpp"
#include "shading/environment_pass.hpp"
#include "shading/primitives.hpp"

namespace nacre {
namespace {

constexpr int kSize = 96;

// Vertices moved on the GPU and on the CPU differ by rounding: outlines may take or lose a pixel, which alone is worth
// up to 0.04 relative at this size. Measured 1e-6 to 3e-3; handedness forgotten gives 0.2 and more.
constexpr double kRelative = 1e-2;

glm::dmat4 moved(const Vec3& scale) {
    return glm::translate(glm::dmat4(1), {0.3, -0.2, 0.1}) * glm::rotate(glm::dmat4(1), 0.8, {0.3, 1, 0.2}) *
           glm::scale(glm::dmat4(1), scale);
}

struct Case {
    const char* words;
    Vec3 scale;
};
const Case kCases[] = {{"rigid", {1, 1, 1}},
                       {"stretched", {0.6, 1.1, 0.8}},
                       {"mirrored", {-1, 1, 1}},
                       {"mirrored, stretched", {0.9, -0.6, 1.2}},
                       {"mirrored three times", {-0.8, -0.8, -0.8}},
                       {"tiny", {1e-9, 1e-9, 1e-9}}};

Camera cameraFor(const Vec3& scale) {
    Camera camera;
    const double size = std::abs(scale.x) < 1e-6 ? 1e-9 : 1;
    const Vec3 centre = size < 1 ? Vec3(0) : Vec3(0.3, -0.2, 0.1);
    camera.target = centre;
    camera.eye = centre + size * Vec3(1.5, 2.0, 2.5);
    camera.orthographic = true;
    camera.height = 3.4 * size;
    camera.near = 0.1 * size;
    camera.far = 8 * size;
    return camera;
}

std::vector<Light> someLights() {
    return {{true, glm::normalize(Vec3(1, 2, 1)), {1.0, 0.5, 0.25}}, {true, {0, 0, 1}, {0.5, 1.0, 2.0}}};
}

template <class Draw>  // void(const RenderTarget&, const GpuMesh&, const glm::dmat4& toWorld)
void expectSame(const Mesh& mesh, const Case& c, Draw draw) {
    SCOPED_TRACE(c.words);
    const glm::dmat4 toWorld = std::abs(c.scale.x) < 1e-6 ? glm::scale(glm::dmat4(1), c.scale) : moved(c.scale);
    const RenderTarget target({.width = kSize, .height = kSize});
    target.clear();
    draw(target, GpuMesh(mesh), toWorld);
    const Image picture = target.read();
    target.clear();
    draw(target, GpuMesh(transformed(mesh, toWorld)), glm::dmat4(1));
    const Image expected = target.read();
    const ImageDifference difference = compareImages(picture, expected, pictureWhite(expected));
    EXPECT_GT(pictureWhite(expected), 0.06) << "nothing to see";
    EXPECT_LT(difference.relative, kRelative);
}

TEST(ModelMatrix, LitPassesDrawTheTransformedMesh) {
    test::context();
    ProgramLoader loader;
    const Mesh torus = makeTorus(1, 0.4f, 48, 32);
    const Reflectance brushed = makeModel("ggx:alphax=0.1,alphay=0.4,f=conductor");
    const GpuDirectBrdf direct = directBrdf(brushed).value();
    const GpuFactoredBrdf tangent(factorize(makeModel("banks:n=20"), {.method = "tangent", .size = 32}));
    for (const Case& c : kCases) {
        const auto view = [&](const glm::dmat4& toWorld) {
            return LitView{cameraFor(c.scale), someLights(), Rgb(0.05), toWorld};
        };
        for (const Addressing addressing : {Addressing::PerPixel, Addressing::PerVertex})
            expectSame(torus, c, [&](const RenderTarget& target, const GpuMesh& mesh, const glm::dmat4& toWorld) {
                renderDirect(loader, target, mesh, view(toWorld), direct, addressing);
            });
        expectSame(torus, c, [&](const RenderTarget& target, const GpuMesh& mesh, const glm::dmat4& toWorld) {
            LitView one = view(toWorld);
            one.lights.resize(1);
            renderFactored(loader, target, mesh, one, tangent, Addressing::TextureMatrix);
        });
    }
}

TEST(ModelMatrix, ReliefsAndSurroundingsTurnWithTheMesh) {
    test::context();
    ProgramLoader loader;
    HeightMap map{Image(16, 16, 1), Wrap::Repeat};  // a ramp with a step: neither its x nor its y is like its mirror
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) map.heights.at(x, y, 0) = static_cast<float>(0.15 * x + (y < 5 ? 2 : 0));
    BumpMaps maps{16, 16, Wrap::Repeat, {}, {}, {}, {}, {}, {}};
    maps.normals = makeNormals(map);
    maps.ellipses = fitEllipses(map);
    const GpuBump bump(maps);
    EnvMap sky(EnvLayout::Cube, 8);
    for (int y = 0; y < sky.image.height(); ++y)
        for (int x = 0; x < sky.image.width(); ++x)
            sky.image.setRgb(x, y, Rgb(1.2) + envTexelDirection(sky.layout, 8, x, y));
    const GpuEnvironment environment(sky);
    EnvironmentSurface surface;
    surface.reflection.map = &environment;
    const BumpSurface relief{.map = &bump, .tiles = {6, 3}};
    const GpuDirectBrdf matt = directBrdf(makeModel("lambert:kd=0.7")).value();
    const Mesh torus = makeTorus(1, 0.4f, 64, 48);
    for (const Case& c : kCases) {
        expectSame(torus, c, [&](const RenderTarget& target, const GpuMesh& mesh, const glm::dmat4& toWorld) {
            renderDirect(loader, target, mesh, {cameraFor(c.scale), someLights(), Rgb(0), toWorld}, matt, relief);
        });
        expectSame(torus, c, [&](const RenderTarget& target, const GpuMesh& mesh, const glm::dmat4& toWorld) {
            renderEnvironment(loader, target, mesh, cameraFor(c.scale), surface, relief, toWorld);
        });
    }
}

TEST(ModelMatrix, RejectsWhatIsNotFinite) {
    test::context();
    ProgramLoader loader;
    const RenderTarget target({.width = 8, .height = 8});
    const GpuDirectBrdf matt = directBrdf(makeModel("lambert:kd=0.7")).value();
    LitView view{Camera(), someLights()};
    view.toWorld[3][1] = NAN;
    EXPECT_THROW(renderDirect(loader, target, GpuMesh(makeQuad()), view, matt), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
