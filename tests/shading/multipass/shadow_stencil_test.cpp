// Hard shadows by volumes against rays, pixel for pixel.
#include "shading/multipass/shadow_stencil.hpp"

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <glm/gtc/matrix_transform.hpp>

#include "../gpu_evaluate.hpp"
#include "core/scene_description.hpp"
#include "reference/shadow_error.hpp"
#include "shading/image_output.hpp"
#include "shading/pass_state.hpp"
#include "shading/primitives.hpp"
#include "shadow_meshes.hpp"

namespace nacre {
namespace {

constexpr int kWidth = 200, kHeight = 150;

struct Object {
    Mesh mesh;
    glm::dmat4 toWorld{1};
};

struct Scenery {
    std::vector<Object> objects;
    Camera camera;
    Light light;
};

glm::dmat4 at(const Vec3& p) { return glm::translate(glm::dmat4(1), p); }
glm::dmat4 flat() { return glm::rotate(glm::dmat4(1), -kPi / 2, Vec3(1, 0, 0)); }

/// What is drawn of a scenery: 1 in shadow, 2 lit, 0 nothing.
struct Drawn {
    Image mask;
    int settled = 0, zPasses = 0, zFails = 0;
};

/// \param mirror  its own inverse: the objects are seen in it, with the volumes they have outside of it
Drawn draw(const Scenery& scenery, ShadowCounting counting = ShadowCounting::Auto, int samples = 1,
           const glm::dmat4& mirror = glm::dmat4(1), int level = 0) {
    ProgramLoader loader;
    const RenderTarget target({.width = kWidth, .height = kHeight, .samples = samples});
    const Vec4 light = homogeneous(scenery.light);
    std::vector<GpuMesh> meshes;
    std::vector<std::unique_ptr<GpuShadowPoints>> points;
    std::vector<std::unique_ptr<GpuShadowVolume>> volumes;
    std::vector<PlacedShadowVolume> placed;
    for (const Object& o : scenery.objects) {
        meshes.emplace_back(o.mesh);
        const ShadowMesh shape = makeShadowMesh(o.mesh);
        const ShadowVolume volume = makeShadowVolume(shape, o.toWorld, light);
        if (volume.empty()) continue;
        points.push_back(std::make_unique<GpuShadowPoints>(shape));
        volumes.push_back(std::make_unique<GpuShadowVolume>(*points.back(), volume));
        placed.push_back({volumes.back().get(), o.toWorld, boundsOf(o.mesh, o.toWorld), volume.mostLayers()});
    }
    const Program& white = loader.load("lit.vert.glsl", "shadow_mask.frag.glsl");
    ShadowSight sight = ShadowSight::of(scenery.camera, double(kWidth) / kHeight);
    sight.worldToClip = sight.worldToClip * mirror;
    sight.mirrored = glm::determinant(mirror) < 0;
    for (Vec3& corner : sight.window) corner = Vec3(mirror * Vec4(corner, 1));
    const auto drawAll = [&](DrawMode mode) {
        setView(white, scenery.camera, target);
        white.set("nacre_world_to_clip", glm::mat4(sight.worldToClip));
        for (std::size_t i = 0; i < meshes.size(); ++i)
            drawMesh(white, target, meshes[i], scenery.objects[i].toWorld, mode);
    };
    target.clear();
    drawAll(DrawMode::Fill);
    if (level > 0) {  // the view is the left half
        glEnable(GL_SCISSOR_TEST);
        glScissor(0, 0, kWidth / 2, kHeight);
        glClearStencil(level);
        glClear(GL_STENCIL_BUFFER_BIT);
        glDisable(GL_SCISSOR_TEST);
    }
    ShadowStencil stencil(loader);
    stencil.begin(target, level);
    stencil.count(target, placed, light, sight, counting);
    stencil.lit();
    drawAll(DrawMode::AddLight);
    stencil.end(target);
    std::vector<unsigned char> levels(std::size_t{kWidth} * kHeight);
    if (samples == 1) {
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        glReadPixels(0, 0, kWidth, kHeight, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, levels.data());
        for (std::size_t i = 0; i < levels.size(); ++i)
            if (levels[i] != (i % kWidth < kWidth / 2 ? level : 0)) ADD_FAILURE() << "a stencil value is left: " << i;
    }
    return {target.read(1), stencil.settled(), stencil.zPasses(), stencil.zFails()};
}

/// Pixels that see a lit or shadowed surface, and of them those that the mask has wrong though rays of 3 × 3 a pixel
/// find no edge of the shadow within a pixel.
struct Verdict {
    int pixels = 0, dark = 0, wrong = 0;
    int undrawn = 0;
};

Verdict judge(const Scenery& scenery, const Image& mask) {
    Mesh world;
    for (const Object& o : scenery.objects) world = test::together(std::move(world), transformed(o.mesh, o.toWorld));
    const ShadowTruth truth(world, scenery.camera, scenery.light, {3 * kWidth, 3 * kHeight});
    Verdict out;
    Image seen(kWidth, kHeight, 3);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const ShadowPixel pixel = truth.at(3 * x + 1, 3 * y + 1);
            seen.setRgb(x, y, pixel == ShadowPixel::None ? Rgb(0.3) : Rgb(mask.at(x, y, 0) - 1));
            if (pixel == ShadowPixel::None) continue;
            if (mask.at(x, y, 0) == 0) {  // at an outline a ray meets what the pixel's centre just misses
                ++out.undrawn;
                continue;
            }
            ++out.pixels;
            out.dark += pixel == ShadowPixel::Shadowed;
            if ((mask.at(x, y, 0) == 2) == (pixel == ShadowPixel::Lit)) continue;
            bool edge = false;
            for (int v = std::max(0, 3 * y - 2); v < std::min(3 * kHeight, 3 * y + 5); ++v)
                for (int u = std::max(0, 3 * x - 2); u < std::min(3 * kWidth, 3 * x + 5); ++u) {
                    const ShadowPixel other = truth.at(u, v);
                    const bool beside = std::abs(u - 3 * x - 1) <= 1 && std::abs(v - 3 * y - 1) <= 1;
                    edge = edge || (other != pixel && (other != ShadowPixel::None || beside));  // or an outline
                }
            out.wrong += !edge;
            if (!edge) seen.setRgb(x, y, pixel == ShadowPixel::Lit ? Rgb(1, 0, 0) : Rgb(0, 0, 1));
        }
    if (const char* folder = std::getenv("NACRE_TEST_PICTURES")) {
        const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
        static int number = 0;
        writePng(seen, std::filesystem::path(folder) / (std::string(info->name()) + std::to_string(number++) + ".png"),
                 {1});
    }
    return out;
}

void expectRight(const Scenery& scenery, const std::string& words) {
    for (const ShadowCounting counting : {ShadowCounting::Auto, ShadowCounting::ZFail}) {
        const Verdict v = judge(scenery, draw(scenery, counting).mask);
        EXPECT_EQ(v.wrong, 0) << words << (counting == ShadowCounting::Auto ? "" : ", z-fail") << ": of " << v.pixels;
        EXPECT_LE(v.undrawn, 5) << words;
        EXPECT_GT(v.dark, v.pixels / 400) << words << ": hardly any shadow";
        EXPECT_GT(v.pixels - v.dark, v.pixels / 400) << words << ": hardly any light";
    }
}

/// A mesh over a floor, the light above.
Scenery overFloor(Mesh mesh) {
    Scenery out;
    out.objects = {{std::move(mesh), at({0, 0.3, 0})}, {makeQuad(8, 4), at({0, -1.2, 0}) * flat()}};
    out.camera.eye = {1.5, 2.2, 5};
    out.camera.target = {0, -0.3, 0};
    out.camera.fovY = 0.8;
    out.light = {false, {-1.2, 3.2, 1}, Rgb(1), {}};
    return out;
}

class ShadowStencils : public ::testing::Test {
protected:
    void SetUp() override { test::context(); }
};

TEST_F(ShadowStencils, HardMeshesOverAFloor) {
    for (const test::NamedMesh& m : test::hardMeshes()) expectRight(overFloor(m.mesh), m.name);
}

TEST_F(ShadowStencils, DirectionalLightAndOrthographicCamera) {
    for (const test::NamedMesh& m : test::hardMeshes()) {
        Scenery scenery = overFloor(m.mesh);
        scenery.light = {true, glm::normalize(Vec3(-0.6, 1, 0.3)), Rgb(1), {}};
        expectRight(scenery, m.name + ", sun");
        scenery.camera.orthographic = true;
        scenery.camera.height = 5;
        expectRight(scenery, m.name + ", sun, orthographic");
        scenery.light = overFloor({}).light;
        expectRight(scenery, m.name + ", orthographic");
    }
}

TEST_F(ShadowStencils, LightAlongAnOrthographicViewMeetsTheVanishingPoint) {
    Scenery scenery = overFloor(test::box(Vec3(-0.5), Vec3(0.5)));
    scenery.camera.orthographic = true;
    scenery.camera.height = 4;
    scenery.camera.eye = {0, 5, 0.01};
    scenery.camera.target = {0, 0, 0.01};
    scenery.camera.up = {0, 0, -1};
    scenery.light = {true, Vec3(0, 1, 0), Rgb(1), {}};
    const Verdict v = judge(scenery, draw(scenery).mask);
    EXPECT_EQ(v.wrong, 0);
    scenery.light = {true, Vec3(0, -1, 0), Rgb(1), {}};
    EXPECT_EQ(judge(scenery, draw(scenery).mask).wrong, 0);
}

TEST_F(ShadowStencils, CameraInsideAVolume) {
    for (const test::NamedMesh& m : test::hardMeshes()) {
        Scenery scenery = overFloor(transformed(m.mesh, glm::scale(glm::dmat4(1), Vec3(1.1))));
        scenery.camera.eye = {0.1, -0.95, 0.05};
        scenery.camera.target = {3, -1.1, -1};
        scenery.camera.fovY = 1.2;
        scenery.light.position = {0.2, 3, 0.1};
        EXPECT_GT(draw(scenery).zFails, 0) << m.name;
        expectRight(scenery, m.name);
    }
}

TEST_F(ShadowStencils, VolumesStraddlingTheNearPlane) {
    for (const double near : {0.05, 1.0, 4.2, 5.0}) {
        Scenery scenery = overFloor(makeTorus(0.8f, 0.3f, 24, 12));
        scenery.camera.near = near;
        scenery.light.position = {2.5, 3.0, 6};  // beside the eye: volumes run along the view
        expectRight(scenery, "torus, near plane at " + std::to_string(near));
    }
}

TEST_F(ShadowStencils, FloorAcrossNearAndFarPlane) {
    Scenery scenery = overFloor(makeTorus(0.8f, 0.3f, 24, 12));
    scenery.objects[1].mesh = makeQuad(200, 1);
    scenery.camera.near = 3;
    scenery.camera.far = 8;
    expectRight(scenery, "torus");
    scenery.light.position = {0, -0.5, -12};  // beyond the far plane, the shadows come towards the eye
    expectRight(scenery, "torus against the light");
}

TEST_F(ShadowStencils, OccluderBeyondTheFarPlane) {
    Scenery scenery = overFloor(test::box(Vec3(-0.5), Vec3(0.5)));
    scenery.objects[0].toWorld = at({0, 0, -6});
    scenery.camera.far = 9;
    scenery.light.position = {0, 1.5, -12};
    expectRight(scenery, "box");
}

TEST_F(ShadowStencils, LightInsideARoomAndInsideABody) {
    for (const bool inward : {true, false}) {
        Scenery scenery = overFloor(makeSphere(0.5f, 24, 12));
        const Mesh room = test::box({-3, -1.3, -3}, {3, 4, 7});
        scenery.objects.push_back({inward ? test::insideOut(room) : room});
        expectRight(scenery, inward ? "room that faces inwards" : "room that faces outwards");
    }
    Scenery scenery = overFloor(makeSphere(0.5f, 24, 12));
    scenery.light.position = Vec3(0.05, 0.3, 0.1);  // in the ball: all else is dark
    const Verdict v = judge(scenery, draw(scenery).mask);
    EXPECT_EQ(v.wrong, 0);
    EXPECT_GT(v.dark, v.pixels / 2);
}

TEST_F(ShadowStencils, LightInThePlaneOfAFace) {
    Scenery scenery = overFloor(test::box(Vec3(-0.6), Vec3(0.6)));
    scenery.light.position = {-1.5, 0.9, 1.5};  // the upper face's height
    expectRight(scenery, "box");
    scenery.objects[0] = {makeQuad(1.6f, 2), at({0, 0.9, 0}) * flat()};
    EXPECT_EQ(judge(scenery, draw(scenery).mask).wrong, 0);  // seen from its edge, it casts nothing
}

TEST_F(ShadowStencils, MirroredAndFlattenedObjects) {
    for (const Vec3& scale : {Vec3(-1, 1, 1), Vec3(1.2, 0.5, -0.7), Vec3(1, 0, 1)}) {
        Scenery scenery = overFloor(makeTorus(0.8f, 0.3f, 24, 12));
        scenery.objects[0].toWorld =
            at({0, 0.3, 0}) * glm::rotate(glm::dmat4(1), 0.5, Vec3(1, 0, 1)) * glm::scale(glm::dmat4(1), scale);
        expectRight(scenery, "torus times " + std::to_string(scale.x) + ", " + std::to_string(scale.y));
    }
}

TEST_F(ShadowStencils, MoreLayersThanTheStencilCounts) {
    Scenery scenery = overFloor(makeQuad(1.2f, 1));
    scenery.objects[0].toWorld = at({0, 1, 0}) * flat();
    for (int i = 1; i < 300; ++i) scenery.objects.push_back({makeQuad(1.2f, 1), at({0, 1 - 0.003 * i, 0}) * flat()});
    scenery.camera.eye = {0.3, -1, 3};
    scenery.camera.target = {0, -1.1, 0};
    EXPECT_GT(draw(scenery, ShadowCounting::ZFail).settled, 0);
    expectRight(scenery, "300 sheets");
}

TEST_F(ShadowStencils, CountOf128IsNotTakenForNone) {
    Scenery scenery = overFloor(makeQuad(1.2f, 1));
    scenery.objects[0].toWorld = at({0, 1, 0}) * flat();
    for (int i = 1; i < 128; ++i) scenery.objects.push_back({makeQuad(1.2f, 1), at({0, 1 - 0.003 * i, 0}) * flat()});
    expectRight(scenery, "128 sheets");
}

TEST_F(ShadowStencils, BothCountingsAgreeWhereZPassIsSafe) {
    const Scenery scenery = overFloor(makeTorus(0.8f, 0.3f, 48, 24));
    const Drawn passed = draw(scenery), failed = draw(scenery, ShadowCounting::ZFail);
    EXPECT_GT(passed.zPasses, 0);
    EXPECT_EQ(failed.zPasses, 0);
    int different = 0;
    for (std::size_t i = 0; i < passed.mask.data().size(); ++i)
        different += passed.mask.data()[i] != failed.mask.data()[i];
    EXPECT_LT(different, kWidth * kHeight / 500);
}

TEST_F(ShadowStencils, ZPassAloneIsWrongInsideAVolume) {  // the test above would see it
    Scenery scenery = overFloor(test::box(Vec3(-1), Vec3(1)));
    scenery.camera.eye = {0.1, -0.95, 0.05};
    scenery.camera.target = {3, -1.1, -1};
    scenery.camera.fovY = 1.2;
    EXPECT_GT(judge(scenery, draw(scenery, ShadowCounting::ZPass).mask).wrong, 100);
}

TEST_F(ShadowStencils, SamplesOfAPixelAreCountedAlone) {
    const Scenery scenery = overFloor(makeTorus(0.8f, 0.3f, 24, 12));
    const Image one = draw(scenery).mask, four = draw(scenery, ShadowCounting::Auto, 4).mask;
    int between = 0, off = 0;
    for (std::size_t i = 0; i < one.data().size(); ++i) {
        const bool whole = four.data()[i] == std::round(four.data()[i]);
        between += !whole;
        off += whole && four.data()[i] != one.data()[i];
    }
    EXPECT_GT(between, 100);
    EXPECT_LT(off, 150);  // a pixel's centre beside an edge that its samples miss
}

TEST_F(ShadowStencils, MirrorsImageOfAStoredVolume) {
    const glm::dmat4 mirror = glm::translate(glm::dmat4(1), Vec3(-0.4, 0, 0)) *
                              glm::scale(glm::dmat4(1), Vec3(-1, 1, 1)) *
                              glm::translate(glm::dmat4(1), Vec3(0.4, 0, 0));
    for (const test::NamedMesh& m : test::hardMeshes()) {
        const Scenery scenery = overFloor(m.mesh);
        Scenery image = scenery;
        for (Object& o : image.objects) o.toWorld = mirror * o.toWorld;
        image.light.position = Vec3(mirror * Vec4(scenery.light.position, 1));
        for (const ShadowCounting counting : {ShadowCounting::Auto, ShadowCounting::ZFail})
            EXPECT_EQ(judge(image, draw(scenery, counting, 1, mirror).mask).wrong, 0) << m.name;
    }
}

TEST_F(ShadowStencils, ViewsOfALevelCountTheirOwnPixels) {
    const Scenery scenery = overFloor(makeTorus(0.8f, 0.3f, 24, 12));
    const Image all = draw(scenery).mask;
    for (const int level : {1, 63, 64, 127}) {
        const Image half = draw(scenery, ShadowCounting::Auto, 1, glm::dmat4(1), level).mask;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                ASSERT_EQ(half.at(x, y, 0), x < kWidth / 2 ? all.at(x, y, 0) : std::min(all.at(x, y, 0), 1.0f))
                    << level;
    }
    ProgramLoader loader;
    EXPECT_THROW(ShadowStencil(loader).begin(RenderTarget({.width = 8, .height = 8}), 128), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
