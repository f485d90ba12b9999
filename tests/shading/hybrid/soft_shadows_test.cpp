// Soft shadows from a light's points, by counted volumes and by maps, against many rays (HYBRID section 4.1).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../gpu_evaluate.hpp"
#include "core/light_area.hpp"
#include "hybrid_fixture.hpp"
#include "shading/hybrid/hybrid_renderer.hpp"
#include "shading/hybrid/sampled_shadows.hpp"
#include "shading/primitives.hpp"

namespace nacre {
namespace {

/// A ball over a floor under a square lamp.
SceneDescription softRoom() {
    SceneDescription scene = test::emptyRoom();
    test::addSquare(scene, 6, {0, 0, 0}, {0, 1, 0});
    scene.meshes.push_back({"ball", makeSphere(0.5f, 48, 24)});
    SceneNode& ball = scene.nodes.emplace_back();
    ball.mesh = 1, ball.material = 0;
    ball.translation = {0, 0.8, 0};
    scene.camera.eye = {2, 2.5, 3};
    scene.camera.target = {0, 0.3, 0};
    scene.camera.fovY = 0.9;
    return scene;
}

const Light kLamp{false, {0.5, 3, 0.5}, Rgb(1), {}};
const LightArea kArea{{0.4, 0, 0}, {0, 0, 0.4}};

/// A view of a scene, and which share of many of the lamp's points each pixel doesn't see.
struct SoftView {
    explicit SoftView(SceneDescription description, int edge = 256)
        : scene(std::move(description)), nodes(nodeTransforms(scene, 0)), geometry(edge, edge) {
        geometry.draw(loader, scene, nodes, test::albedos(scene), meshes);
    }

    /// PSNR of levels, where the surface faces the lamp.
    double psnr(const Image& levels) {
        if (truth.empty()) trace();
        double squares = 0;
        int count = 0;
        const int edge = geometry.width();
        for (int i = 0; i < edge * edge; ++i) {
            const double expected = truth[static_cast<std::size_t>(i)];
            if (expected < 0) continue;
            squares += sqr(levels.at(i % edge, edge - 1 - i / edge, 0) - expected);
            ++count;
        }
        return -10 * std::log10(squares / count);
    }

    Image counted(int points, ShadowFilter filter) {
        CountedShadows shadows(loader, scene, nodes);
        shadows.begin(geometry, scene.camera);
        for (const Light& p : pointsOfArea(kLamp, kArea, points)) shadows.add(homogeneous(p), 1.0 / points);
        return shadows.read(filter);
    }

    Image mapped(int points, ShadowFilter filter, const MappedShadowOptions& options = {}) {
        MappedShadows shadows(scene, nodes);
        ShadowLevels levels(geometry.width(), geometry.height());
        levels.clear();
        shadows.add(loader, geometry, scene.camera, pointsOfArea(kLamp, kArea, points), levels, options);
        return levels.read(loader, geometry, filter);
    }

    const Context& context = test::context();
    ProgramLoader loader;
    SceneDescription scene;
    std::vector<glm::dmat4> nodes;
    GeometryBuffer geometry;
    std::map<int, GpuMesh> meshes;
    std::vector<double> truth;  ///< -1 where nothing is compared

private:
    void trace() {
        const RayScene rays(scene, nodes);
        const std::vector<Light> many = pointsOfArea(kLamp, kArea, 1024);
        for (const SeenPoint& p : geometry.read()) {
            const Vec3 place(p.place);
            truth.push_back(p.place.w == 0 || glm::dot(Vec3(p.normal), kLamp.position - place) < 0 ? -1 : 0);
            if (truth.back() < 0) continue;
            for (const Light& l : many) truth.back() += rays.blocked(place, l.position, true) / 1024.0;
        }
    }
};

TEST(SoftShadows, SixteenPointsAndTheEdgeStoppingFilter) {
    SoftView view(softRoom());
    for (const bool maps : {false, true}) {
        const auto psnr = [&](ShadowFilter f) { return view.psnr(maps ? view.mapped(16, f) : view.counted(16, f)); };
        const double none = psnr(ShadowFilter::None), box = psnr(ShadowFilter::Box),
                     edge = psnr(ShadowFilter::EdgeStopping);
        std::printf("%s: 16 points: %.1f dB, 7 x 7 average %.1f dB, edge-stopping %.1f dB\n", maps ? "maps" : "volumes",
                    none, box, edge);
        EXPECT_GE(edge, 35);
        EXPECT_GT(edge, box);
    }
}

TEST(MappedShadows, NearTheVolumesOfTheSamePointsAsMapsGrow) {
    SoftView view(softRoom());
    const Image exact = view.counted(16, ShadowFilter::None);
    const auto wrong = [&](int size) {
        const Image levels = view.mapped(16, ShadowFilter::None, {size});
        double sum = 0;
        for (std::size_t i = 0; i < exact.data().size(); ++i) sum += std::abs(levels.data()[i] - exact.data()[i]);
        return sum / static_cast<double>(exact.data().size());
    };
    const double coarse = wrong(64), fine = wrong(512);
    std::printf("mean difference of levels: %.4f at 64, %.4f at 512 texels\n", coarse, fine);
    EXPECT_LT(fine, 0.4 * coarse);
    EXPECT_LT(fine, 0.003);
}

TEST(MappedShadows, DrawOnlyFacesThatTheViewCanLookUp) {
    SoftView view(softRoom());
    MappedShadows shadows(view.scene, view.nodes);
    ShadowLevels levels(view.geometry.width(), view.geometry.height());
    levels.clear();
    shadows.add(view.loader, view.geometry, view.scene.camera, pointsOfArea(kLamp, kArea, 4), levels);
    const std::size_t all = view.scene.meshes[0].mesh.triangles.size() + view.scene.meshes[1].mesh.triangles.size();
    EXPECT_GE(shadows.trianglesDrawn(), 4 * all) << "below the lamp are all of them";
    EXPECT_LT(shadows.trianglesDrawn(), 4 * 2 * all);
}

TEST(MappedShadows, AllAroundALamp) {
    // Within a box, whose every side has a small square before it.
    SceneDescription scene = test::emptyRoom();
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
            Vec3 at(0);
            at[axis] = sign;
            test::addSquare(scene, 2, 2.0 * at, -at);
            test::addSquare(scene, 0.3, at + Vec3(0.1, 0.05, 0.15), -at);
        }
    const Light middle{false, {0, 0, 0}, Rgb(1), {}};
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
            Vec3 at(0), up(0);
            at[axis] = sign, up[(axis + 1) % 3] = 1;
            scene.camera.eye = 0.3 * up;
            scene.camera.target = at;
            scene.camera.up = up;
            scene.camera.fovY = 1.9;
            scene.camera.near = 0.05;
            SoftView view(scene, 128);
            MappedShadows shadows(scene, view.nodes);
            ShadowLevels levels(128, 128);
            levels.clear();
            shadows.add(view.loader, view.geometry, scene.camera, std::vector<Light>{middle}, levels, {512});
            const Image image = levels.read(view.loader, view.geometry, ShadowFilter::None);
            const RayScene rays(scene, view.nodes);
            const std::vector<SeenPoint> seen = view.geometry.read();
            int wrong = 0, dark = 0;
            for (int i = 0; i < 128 * 128; ++i) {
                const SeenPoint& p = seen[static_cast<std::size_t>(i)];
                if (p.place.w == 0) continue;
                const bool blocked = rays.blocked(Vec3(p.place), middle.position, true);
                dark += blocked;
                wrong += blocked != (image.at(i % 128, 127 - i / 128, 0) > 0.5f);
            }
            EXPECT_GT(dark, 300) << axis << " " << sign;
            EXPECT_LT(wrong, 0.01 * 128 * 128) << axis << " " << sign << ": only along edges";
        }
}

/// The soft room with its lamp, for a renderer.
SceneDescription litRoom() {
    SceneDescription scene = softRoom();
    test::addLight(scene, kLamp);
    scene.lights.back().area = kArea;
    return scene;
}

TEST(SampledShadows, AreAsTheRaysSayAndTheFasterIsTaken) {
    SoftView view(litRoom());
    SampledShadows shadows(view.loader, view.scene);
    const auto draw = [&](const SampledShadowOptions& options) {
        shadows.draw(view.geometry, view.scene.camera, view.nodes, options);
        return shadows.choice();
    };
    SampledShadowChoice choice = draw({});
    EXPECT_GE(choice.mapPsnr, 35);
    EXPECT_GE(choice.volumePsnr, 35);
    EXPECT_EQ(choice.taken == SampledShadowMethod::Maps, choice.mapSeconds < choice.volumeSeconds);
    EXPECT_STREQ(nameOf(draw({.leastPsnr = 0.5 * (choice.mapPsnr + choice.volumePsnr)}).taken), nameOf(choice.taken))
        << "chosen once";
    SampledShadows anew(view.loader, view.scene);
    anew.draw(view.geometry, view.scene.camera, view.nodes, {.leastPsnr = 1000});
    choice = anew.choice();
    EXPECT_EQ(choice.taken == SampledShadowMethod::Maps, choice.mapPsnr > choice.volumePsnr) << "none is near enough";
    EXPECT_EQ(draw({SampledShadowMethod::Maps}).taken, SampledShadowMethod::Maps);
    EXPECT_THROW(draw({.points = 0}), std::invalid_argument);
    EXPECT_THROW(draw({.points = 65}), std::invalid_argument);
}

/// Against hard shadows by volumes: a lamp, a direction, and a direction without shadow.
TEST(SampledShadows, DimOnlyTheLightsThatHaveThem) {
    SceneDescription scene = softRoom();
    test::addLight(scene, kLamp);
    test::addLight(scene, Light{true, glm::normalize(Vec3(0.2, 1, 0.1)), Rgb(0.3)}, false);
    test::addLight(scene, Light{true, glm::normalize(Vec3(-1, 2, 0)), Rgb(0.5)});
    test::context();
    ProgramLoader loader;
    const std::vector<BrdfFunction> brdfs(scene.materials.size());
    const auto picture = [&](const std::optional<SampledShadowOptions>& shadows) {
        HybridRenderer renderer(loader, scene, {test::albedos(scene), brdfs});
        renderer.direct().switches.shadowMethod = ShadowMethod::Volumes;
        HybridOptions options;
        options.shadows = shadows;
        return renderer.draw(128, 128, options).direct;
    };
    const Image exact = picture(std::nullopt);
    for (const auto& [method, most] :
         {std::pair(SampledShadowMethod::Volumes, 0.0), {SampledShadowMethod::Maps, 0.01}}) {
        const Image levels = picture(SampledShadowOptions{method});
        int wrong = 0;
        for (int y = 0; y < 128; ++y)
            for (int x = 0; x < 128; ++x)
                wrong += glm::length(levels.rgb(x, y) - exact.rgb(x, y)) > 1e-3 * (1 + glm::length(exact.rgb(x, y)));
        EXPECT_LE(wrong, most * 128 * 128) << nameOf(method);
    }
}

TEST(MappedShadows, RefuseWhatTheyCannotDraw) {
    SoftView view(softRoom(), 16);
    MappedShadows shadows(view.scene, view.nodes);
    ShadowLevels levels(16, 16), other(8, 8);
    const auto add = [&](const std::vector<Light>& points, ShadowLevels& to, int size) {
        shadows.add(view.loader, view.geometry, view.scene.camera, points, to, {size});
    };
    EXPECT_THROW(add({}, levels, 64), std::invalid_argument);
    EXPECT_THROW(add(std::vector<Light>(65, kLamp), levels, 64), std::invalid_argument);
    EXPECT_THROW(add({Light{}}, levels, 64), std::invalid_argument) << "a direction";
    EXPECT_THROW(add({kLamp}, levels, 4), std::invalid_argument);
    EXPECT_THROW(add({kLamp}, other, 64), std::invalid_argument);
}

TEST(MappedShadows, OfAnEmptyRoomAreNone) {
    SceneDescription scene = test::emptyRoom();
    SoftView view(scene, 16);
    MappedShadows shadows(scene, view.nodes);
    ShadowLevels levels(16, 16);
    levels.clear();
    shadows.add(view.loader, view.geometry, scene.camera, std::vector<Light>{kLamp}, levels);
    EXPECT_THAT(levels.read(view.loader, view.geometry, ShadowFilter::EdgeStopping).data(), testing::Each(0));
}

}  // namespace
}  // namespace nacre
