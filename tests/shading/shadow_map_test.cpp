// Shadow maps on the GPU: maps and lookups against the C++ twin and rays; the hard cases.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "factorize/models/models.hpp"
#include "gpu_evaluate.hpp"
#include "reference/raytrace.hpp"
#include "reference/shadow_error.hpp"
#include "shading/lit_pass.hpp"
#include "shading/primitives.hpp"
#include "shading/shadow_map.hpp"

namespace nacre {
namespace {

constexpr int kSize = 192;  ///< of pictures

void append(Mesh& mesh, const Mesh& other) {
    const auto first = static_cast<unsigned>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
    mesh.tangents.insert(mesh.tangents.end(), other.tangents.begin(), other.tangents.end());
    mesh.uvs.insert(mesh.uvs.end(), other.uvs.begin(), other.uvs.end());
    for (const glm::uvec3& t : other.triangles) mesh.triangles.push_back(t + first);
}

Mesh moved(const Mesh& mesh, const Vec3& by) { return transformed(mesh, glm::translate(glm::dmat4(1), by)); }

Mesh floorAt(double y) {
    const glm::dmat4 lie = glm::rotate(glm::dmat4(1), -kPi / 2, Vec3(1, 0, 0));
    return transformed(makeQuad(8, 32), glm::translate(glm::dmat4(1), Vec3(0, y, 0)) * lie);
}

/// A torus that lies on a floor, and a ball over it.
Mesh someScene() {
    Mesh mesh = moved(makeTorus(0.8f, 0.25f, 64, 32), {0, -0.35, 0});
    append(mesh, moved(makeSphere(0.3f, 48, 24), {0.1, 0.35, 0.1}));
    append(mesh, floorAt(-0.6));
    return mesh;
}

Camera someCamera() {
    Camera camera;
    camera.eye = {0.6, 1.6, 3};
    camera.target = {0, -0.3, 0};
    camera.fovY = 0.8;
    return camera;
}

Light spotAt(const Vec3& position, const Vec3& target = {0, -0.3, 0}) {
    return {false, position, Rgb(1), SpotCone{glm::normalize(target - position), 0.3, 0.55}};
}
Light sunFrom(const Vec3& towards) { return {true, glm::normalize(towards), Rgb(1)}; }
Light bulbAt(const Vec3& position) { return {false, position, Rgb(1)}; }

struct Case {
    const char* name;
    Light light;
    SceneShadow options{};
};

std::vector<Case> everyKind() {
    SceneShadow cascades, paraboloid;
    cascades.cascades = 3;
    paraboloid.dualParaboloid = true;
    return {{"spot", spotAt({1.5, 2.5, 1})},
            {"sun", sunFrom({0.6, 0.9, 0.5})},
            {"cascades", sunFrom({0.6, 0.9, 0.5}), cascades},
            {"cube", bulbAt({1.2, 1.5, 0.8})},
            {"paraboloid", bulbAt({1.2, 1.5, 0.8}), paraboloid}};
}

/// Draws the map and, from the camera, its mask.
struct Shadowed {
    Shadowed(const Mesh& mesh, const Light& light, const SceneShadow& options, const Camera& view = someCamera())
        : camera(view), map(options) {
        test::context();
        ProgramLoader loader;
        const GpuMesh gpu(mesh);
        map.update(loader, light, {{{&gpu}}, boundsOf(mesh), &camera, 1});
        const RenderTarget target({.width = kSize, .height = kSize});
        target.clear(glm::vec4(0.5));
        renderShadowMask(loader, target, gpu, camera, map);
        mask = target.read(1);
    }
    Camera camera;
    ShadowMap map;
    Image mask;
};

ShadowError errorOf(const Mesh& mesh, const Light& light, const SceneShadow& options,
                    const Camera& camera = someCamera()) {
    const Shadowed drawn(mesh, light, options, camera);
    return ShadowTruth(mesh, camera, light, {kSize, kSize}).compare(drawn.mask, drawn.map.view());
}

// A few pixels at outlines: rays and rasteriser may see different triangles there.
constexpr double kOffBoundary = 1e-3;

TEST(ShadowMap, IsTheRaysAnswerAwayFromEdges) {
    const Mesh mesh = someScene();
    for (const int bits : {16, 32})
        for (Case c : everyKind()) {
            SCOPED_TRACE(c.name);
            c.options.bits = bits;
            const ShadowTruth truth(mesh, someCamera(), c.light, {kSize, kSize});
            const Image lit = truth.picture();
            EXPECT_GT(std::count(lit.data().begin(), lit.data().end(), 0.0f), 500) << "the scene has shadows";
            const ShadowError error = errorOf(mesh, c.light, c.options);
            EXPECT_GT(error.pixels, 10000u);
            EXPECT_LT(error.offBoundary(), kOffBoundary);
            EXPECT_LT(error.misjudged(), 0.02);
        }
}

TEST(ShadowMap, LookupInGlslAndCpp) {
    const Mesh mesh = someScene();
    for (const int filter : {1, 2, 3, 4, 5})
        for (Case c : everyKind()) {
            SCOPED_TRACE(c.name);
            c.options.filter = filter;
            c.options.bits = filter % 2 == 0 ? 16 : 32;
            const Shadowed drawn(mesh, c.light, c.options);
            const ShadowTruth truth(mesh, someCamera(), c.light, {kSize, kSize});
            const Image twin = truth.mask(drawn.map.view(), drawn.map.download());
            int different = 0, compared = 0;
            for (const float share : drawn.mask.data()) ASSERT_TRUE(share >= 0 && share <= 1.000001f) << share;
            for (int y = 0; y < kSize; ++y)
                for (int x = 0; x < kSize; ++x) {
                    if (truth.at(x, y) == ShadowPixel::None) continue;
                    ++compared;
                    different += std::abs(twin.at(x, y, 0) - drawn.mask.at(x, y, 0)) > 1e-3;
                }
            // Where a texel's comparison hangs on the last bits, and at outlines. A wrong weight differs at every edge.
            EXPECT_LT(different, 1e-3 * compared) << filter;
            EXPECT_GT(compared, 10000);
        }
}

// What a ray through the texel's centre hits, to the depth's resolution. Triangles' edges are left out.
TEST(ShadowMap, HoldsLinearDepth) {
    const Mesh mesh = someScene();
    for (const int bits : {16, 32})
        for (Case c : everyKind()) {
            if (c.options.dualParaboloid) continue;  // the traced map has none
            SCOPED_TRACE(c.name);
            c.options.bits = bits;
            c.options.size = 128;
            const Shadowed drawn(mesh, c.light, c.options);
            const std::vector<Image> layers = drawn.map.download(),
                                     traced = tracedShadowMap(mesh, drawn.map.view(), {false, 0});
            ASSERT_EQ(layers.size(), traced.size());
            const double range = drawn.map.view().far - drawn.map.view().near;
            std::size_t off = 0, all = 0;
            for (std::size_t k = 0; k < layers.size(); ++k)
                for (std::size_t i = 0; i < layers[k].data().size(); ++i, ++all) {
                    // 1e-5: interpolated over triangles that the map sees edge on
                    const double tolerance = drawn.map.view().resolution / range + 1e-5;
                    off += std::abs(layers[k].data()[i] - traced[k].data()[i]) > tolerance;
                }
            EXPECT_LT(static_cast<double>(off), 0.01 * static_cast<double>(all));
        }
}

TEST(ShadowMap, ParaboloidIsTheCubesAnswer) {
    const Mesh mesh = someScene();
    SceneShadow options;
    options.size = 1024;
    const Shadowed cube(mesh, bulbAt({0.2, 1.0, 0.3}), options);
    options.dualParaboloid = true;
    const Shadowed paraboloid(mesh, bulbAt({0.2, 1.0, 0.3}), options);
    double difference = 0;
    for (std::size_t i = 0; i < cube.mask.data().size(); ++i)
        difference += std::abs(cube.mask.data()[i] - paraboloid.mask.data()[i]);
    EXPECT_LT(difference / static_cast<double>(cube.mask.data().size()), 0.01);
}

TEST(ShadowMap, BitsRoundTrip) {
    test::context();
    std::vector<DirectionPair> pairs;
    for (int code = 1; code < 65535; ++code) pairs.push_back({{code / 65535.0, 0, 0}, {0, 0, 0}});
    const auto values = test::gpuEvaluate({.code = "#include \"nacre/shadow.glsl\"\nvec4 evaluate(vec3 wi, vec3 wo) {\n"
                                                   "    vec4 depth = vec4(wi.x, 1.0 - wi.x, 0.0, 1.0);\n"
                                                   "    return vec4(nacre_shadow_decode(nacre_shadow_encode(depth, "
                                                   "vec2(0.5, 4.0), 16), vec2(0.5, 4.0), 16).xy,\n"
                                                   "                nacre_shadow_decode(nacre_shadow_encode(depth, "
                                                   "vec2(0.5, 4.0), 32), vec2(0.5, 4.0), 32).xw);\n}\n"},
                                          pairs);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const auto depth = static_cast<float>(pairs[i].wi.x);
        ASSERT_NEAR(values[i].x, 0.5f + 4 * depth, 1e-6) << i;
        ASSERT_NEAR(values[i].y, 4.5f - 4 * depth, 1e-6) << i;
        ASSERT_NEAR(values[i].z, 0.5f + 4 * depth, 1e-6) << i;
        ASSERT_GE(values[i].w, 1e6) << "nothing";
    }
}

TEST(ShadowMap, MasksMultiplyTheLight) {
    test::context();
    ProgramLoader loader;
    const Mesh mesh = someScene();
    const GpuMesh gpu(mesh);
    const Light a = spotAt({1.5, 2.5, 1}), b = bulbAt({-1, 1.5, 1}), c = sunFrom({0, 1, 0.5});
    SceneShadow options;
    options.filter = 1;
    ShadowMap mapA(options), mapC(options);
    mapA.update(loader, a, {{{&gpu}}, boundsOf(mesh)});
    mapC.update(loader, c, {{{&gpu}}, boundsOf(mesh)});
    const Reflectance model = makeModel("torrance-sparrow:alpha=0.3,kd=0.4");
    LitView view{someCamera(), {a, b, c}, Rgb(0.125)};
    const auto picture = [&](std::vector<Light> lights, std::vector<const ShadowMap*> shadows) {
        const RenderTarget target({.width = kSize, .height = kSize});
        target.clear();
        view.lights = std::move(lights), view.shadows = std::move(shadows);
        renderDirect(loader, target, gpu, view, directBrdf(model).value());
        return target.read();
    };
    const auto mask = [&](const ShadowMap& map) {
        const RenderTarget target({.width = kSize, .height = kSize});
        target.clear();
        renderShadowMask(loader, target, gpu, view.camera, map);
        return target.read();
    };
    const Image all = picture({a, b, c}, {&mapA, nullptr, &mapC});
    const Image onlyA = picture({a}, {}), onlyB = picture({b}, {}), onlyC = picture({c}, {nullptr});
    const Image maskA = mask(mapA), maskC = mask(mapC);
    for (std::size_t i = 0; i < all.data().size(); ++i) {
        const double ambient = onlyB.data()[i] > 0 ? 0.125 : 0;
        const double expected = maskA.data()[i] * (onlyA.data()[i] - ambient) + onlyB.data()[i] +
                                maskC.data()[i] * (onlyC.data()[i] - ambient);
        ASSERT_NEAR(all.data()[i], expected, 1e-5 * (1 + expected)) << i;
    }
}

TEST(ShadowMap, PlacedAndMirroredCastersAreTheMovedMesh) {
    test::context();
    ProgramLoader loader;
    const Mesh mesh = someScene();
    const glm::dmat4 place = glm::translate(glm::dmat4(1), Vec3(0.2, 0.1, -0.1)) *
                             glm::rotate(glm::dmat4(1), 0.4, Vec3(0, 1, 0)) *
                             glm::scale(glm::dmat4(1), Vec3(-1, 1.2, 0.9));
    const Mesh whole = transformed(mesh, place);
    for (const auto faces : {SceneShadow::Faces::Both, SceneShadow::Faces::Front, SceneShadow::Faces::Back}) {
        SceneShadow options;
        options.faces = faces;
        options.size = 256;
        ShadowMap placed(options), expected(options);
        const GpuMesh gpu(mesh), gpuWhole(whole);
        const Light light = spotAt({1.5, 2.5, 1});
        placed.update(loader, light, {{{&gpu, place}}, boundsOf(mesh, place)});
        expected.update(loader, light, {{{&gpuWhole}}, boundsOf(whole)});
        const Image a = placed.download()[0], b = expected.download()[0];
        std::size_t off = 0;
        for (std::size_t i = 0; i < a.data().size(); ++i) off += std::abs(a.data()[i] - b.data()[i]) > 1e-4;
        EXPECT_LT(off, a.data().size() / 200);
    }
}

// Closed bodies: back faces alone shadow the floor just so, and leave the lit side without a stored surface of its own.
TEST(ShadowMap, FrontAndBackFaces) {
    const Mesh mesh = someScene();
    for (const auto faces : {SceneShadow::Faces::Front, SceneShadow::Faces::Back}) {
        SceneShadow options;
        options.faces = faces;
        const ShadowError error = errorOf(mesh, sunFrom({0.6, 0.9, 0.5}), options);
        EXPECT_LT(error.offBoundary(), faces == SceneShadow::Faces::Front ? kOffBoundary : 0.01);
    }
    SceneShadow front, back;
    front.faces = SceneShadow::Faces::Front, back.faces = SceneShadow::Faces::Back;
    front.size = back.size = 64;
    const Shadowed f(makeSphere(), sunFrom({0, 0, 1}), front), b(makeSphere(), sunFrom({0, 0, 1}), back);
    EXPECT_LT(f.map.download()[0].at(32, 32, 0), 0.01);
    EXPECT_GT(b.map.download()[0].at(32, 32, 0), 0.99);
}

TEST(ShadowMap, UserBiasOverrides) {
    const Mesh mesh = someScene();
    SceneShadow none, huge;
    none.bias = 0, huge.bias = 10;
    none.bits = 16;
    EXPECT_GT(errorOf(mesh, sunFrom({0.6, 0.9, 0.5}), none).acne, 100u) << "without a bias depth's steps show";
    const Shadowed drawn(mesh, sunFrom({0.6, 0.9, 0.5}), huge);
    for (const float share : drawn.mask.data()) EXPECT_GE(share, 0) << "and nothing is shadowed by others";
    EXPECT_GT(errorOf(mesh, sunFrom({0.6, 0.9, 0.5}), huge).leaks, 100u);
}

// ---- hard cases

TEST(ShadowMapHardCases, LightInsideAMesh) {
    Mesh mesh = moved(makeSphere(0.8f, 64, 32), {0, 0.3, 0});
    append(mesh, floorAt(-0.6));
    for (const bool paraboloid : {false, true}) {
        SceneShadow options;
        options.dualParaboloid = paraboloid;
        const Shadowed drawn(mesh, bulbAt({0.1, 0.2, 0}), options);
        const ShadowTruth truth(mesh, drawn.camera, bulbAt({0.1, 0.2, 0}), {kSize, kSize});
        const ShadowError error = truth.compare(drawn.mask, drawn.map.view());
        EXPECT_GT(error.pixels, 5000u);
        EXPECT_LT(error.offBoundary(), kOffBoundary) << "the ball's shell keeps the light in";
        const Image lit = truth.picture();
        EXPECT_EQ(std::count(lit.data().begin(), lit.data().end(), 1.0f), 0);
    }
}

TEST(ShadowMapHardCases, LightAtTheCamera) {
    const Mesh mesh = someScene();
    const Camera camera = someCamera();
    for (const Light& light : {spotAt(camera.eye, camera.target), bulbAt(camera.eye)}) {
        const ShadowError error = errorOf(mesh, light, {});
        EXPECT_GT(error.pixels, 10000u);
        EXPECT_LT(error.misjudged(), kOffBoundary) << "what the camera sees is lit";
    }
}

TEST(ShadowMapHardCases, CasterTouchesTheReceiver) {
    Mesh mesh = floorAt(0);
    append(mesh, moved(makeSphere(0.5f, 96, 48), {0, 0.5, 0}));                                    // in one point
    append(mesh, transformed(makeQuad(1, 8), glm::translate(glm::dmat4(1), Vec3(-1.2, 0.5, 0))));  // along an edge
    for (const Case& c : everyKind()) {
        SCOPED_TRACE(c.name);
        const ShadowError error = errorOf(mesh, c.light, c.options);
        EXPECT_LT(error.offBoundary(), kOffBoundary);
    }
}

TEST(ShadowMapHardCases, NearToFarAsOneToAHundredThousand) {
    const Mesh mesh = someScene();
    for (Case c : everyKind()) {
        if (c.light.directional) continue;
        SCOPED_TRACE(c.name);
        c.options.near = 1e-4;
        c.options.far = 10;
        for (const int bits : {16, 32}) {
            c.options.bits = bits;
            EXPECT_LT(errorOf(mesh, c.light, c.options).offBoundary(), kOffBoundary) << bits;
        }
    }
}

TEST(ShadowMapHardCases, CasterBehindTheLight) {
    Mesh mesh = floorAt(-0.6), behind = moved(makeSphere(0.5f, 32, 16), {1.5, 3.5, 1});
    append(mesh, behind);
    for (const Case& c : everyKind()) {
        if (c.light.directional) continue;
        SCOPED_TRACE(c.name);
        const Shadowed drawn(mesh, c.light, c.options);
        const ShadowTruth truth(mesh, drawn.camera, c.light, {kSize, kSize});
        EXPECT_LT(truth.compare(drawn.mask, drawn.map.view()).misjudged(), kOffBoundary);
    }
}

TEST(ShadowMapHardCases, DegenerateAndDuplicateTriangles) {
    Mesh mesh = someScene();
    const std::vector<glm::uvec3> once = mesh.triangles;
    mesh.triangles.insert(mesh.triangles.end(), once.begin(), once.end());
    mesh.triangles.push_back({5, 5, 5});
    mesh.triangles.push_back({0, 7, 7});
    for (const Case& c : everyKind()) {
        SCOPED_TRACE(c.name);
        EXPECT_LT(errorOf(mesh, c.light, c.options).offBoundary(), kOffBoundary);
    }
}

TEST(ShadowMapHardCases, EmptyCasters) {
    test::context();
    ProgramLoader loader;
    const Mesh mesh = floorAt(-0.6);
    const GpuMesh gpu(mesh);
    for (const Case& c : everyKind()) {
        SCOPED_TRACE(c.name);
        ShadowMap map(c.options);
        const Camera camera = someCamera();
        map.update(loader, c.light, {{}, boundsOf(mesh), &camera, 1});
        const RenderTarget target({.width = 32, .height = 32});
        target.clear(glm::vec4(1));
        renderShadowMask(loader, target, gpu, camera, map);
        const Image mask = target.read(1);
        for (const float share : mask.data()) ASSERT_NEAR(share, 1, 1e-6);
    }
}

TEST(ShadowMapHardCases, LightInThePlaneOfASurface) {
    const Mesh mesh = floorAt(0);
    for (const Light& light : {bulbAt({1, 0, 0}), sunFrom({1, 0, 0}), spotAt({3, 0, 0}, {0, 0, 0})}) {
        const Shadowed drawn(mesh, light, {});
        for (const float share : drawn.mask.data()) ASSERT_TRUE(share >= 0 && share <= 1);
    }
}

TEST(ShadowMap, BrokenInputIsRefused) {
    test::context();
    ProgramLoader loader;
    const GpuMesh gpu(makeQuad());
    const RenderTarget target({.width = 4, .height = 4});
    ShadowMap map;
    EXPECT_THROW(renderShadowMask(loader, target, gpu, Camera{}, map), std::invalid_argument) << "not drawn";
    EXPECT_THROW(map.update(loader, Light{}, {{{nullptr}}, boundsOf(makeQuad())}), std::invalid_argument);
    EXPECT_THROW(map.update(loader, Light{}, {{{&gpu}}, {}}), std::invalid_argument) << "no bounds";
    map.update(loader, Light{}, {{{&gpu}}, boundsOf(makeQuad())});
    const GpuDirectBrdf brdf = directBrdf(makeModel("torrance-sparrow")).value();
    LitView view{Camera{}, {Light{}, Light{}}};
    view.shadows = {&map};
    EXPECT_THROW(renderDirect(loader, target, gpu, view, brdf), std::invalid_argument) << "one for two lights";
    view.lights = {bulbAt({0, 0, 1})};
    EXPECT_THROW(renderDirect(loader, target, gpu, view, brdf), std::invalid_argument) << "another kind of light";
    view.lights = {Light{}};
    EXPECT_THROW(renderDirect(loader, target, gpu, view, brdf, Addressing::PerVertex), std::invalid_argument);
    EXPECT_NO_THROW(renderDirect(loader, target, gpu, view, brdf));
}

TEST(ShadowMap, DrawsAndLooksUpInEveryDialect) {
    const Mesh mesh = someScene();
    for (const Case& c : everyKind())
        for (const int bits : {16, 32}) {
            std::vector<Image> masks;
            for (const auto& [api, dialect] :
                 {std::pair{GlApi::Core33, Glsl::V330}, {GlApi::Core45, Glsl::V450}, {GlApi::Es3, Glsl::Es300}}) {
                test::context(api);
                ProgramLoader loader(dialect);
                const GpuMesh gpu(mesh);
                SceneShadow options = c.options;
                options.bits = bits;
                ShadowMap map(options);
                const Camera camera = someCamera();
                map.update(loader, c.light, {{{&gpu}}, boundsOf(mesh), &camera, 1});
                const RenderTarget target({.width = 64, .height = 64});
                target.clear();
                renderShadowMask(loader, target, gpu, camera, map);
                masks.push_back(target.read(1));
            }
            EXPECT_EQ(masks[0].data(), masks[1].data()) << c.name;
            EXPECT_EQ(masks[0].data(), masks[2].data()) << c.name;
        }
    test::context();
}

}  // namespace
}  // namespace nacre
