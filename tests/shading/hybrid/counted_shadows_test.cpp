// HYBRID figures 3 to 7 as scenes whose answer per pixel a ray knows.
#include "shading/hybrid/counted_shadows.hpp"

#include <gtest/gtest.h>

#include "core/light_area.hpp"
#include "gpu_evaluate.hpp"
#include "hybrid_fixture.hpp"
#include "shading/primitives.hpp"

namespace nacre {
namespace {

struct Figure {
    std::string name;
    SceneDescription scene;
    Vec4 light;
    bool needsEnds = false;  ///< wrong without
};

SceneDescription floorRoom(const Vec3& eye, const Vec3& target) {
    SceneDescription scene = test::emptyRoom();
    test::addSquare(scene, 6, {0, 0, 0}, {0, 1, 0});
    scene.camera.eye = eye;
    scene.camera.target = target;
    scene.camera.fovY = 0.9;
    return scene;
}

void addMesh(SceneDescription& scene, Mesh mesh, const Vec3& at) {
    scene.meshes.push_back({"mesh", std::move(mesh)});
    SceneNode& node = scene.nodes.emplace_back();
    node.mesh = static_cast<int>(scene.meshes.size()) - 1;
    node.material = 0;
    node.translation = at;
}

void addTable(SceneDescription& scene) {
    test::addSquare(scene, 1.2, {0, 1, 0}, {0, 1, 0});
    for (const double x : {-1.0, 1.0})
        for (const double z : {-1.0, 1.0}) addMesh(scene, makeTorus(0.08f, 0.04f, 12, 8), {x, 0.5, z});
}

std::vector<Figure> figures() {
    std::vector<Figure> out;
    Figure f{"3: overlapping volumes, a body that isn't convex", floorRoom({3, 3, 4}, {0, 0.5, 0}), {0.5, 4, 0.3, 1}};
    addMesh(f.scene, makeSphere(0.4f, 24, 12), {0, 0.6, 0});
    addMesh(f.scene, makeSphere(0.3f, 24, 12), {0.1, 1.8, 0.05});
    addMesh(f.scene, makeTorus(0.6f, 0.2f, 32, 16), {-1, 0.9, 0.4});
    out.push_back(f);
    f = {"4: a volume's edge goes through the view plane", floorRoom({0, 1, 3}, {0, 0.4, 0}), {-4, 3, 3.2, 1}};
    f.scene.camera.near = 0.5;
    test::addSquare(f.scene, 1, {-1.5, 1.5, 3.9}, glm::normalize(Vec3(-1, 0.3, 0)));
    addMesh(f.scene, makeSphere(0.3f, 24, 12), {0.6, 0.3, 1});
    out.push_back(f);
    f = {"5a: the light is before the eye", floorRoom({0, 1, 3}, {0, 1, 0}), {0, 2, -4, 1}, true};
    test::addSquare(f.scene, 1.6, {0, 1.5, -1}, {0, 0, -1});
    addMesh(f.scene, makeSphere(0.4f, 24, 12), {0.2, 0.6, 0.5});
    out.push_back(f);
    f = {"5b: the light is behind the eye", floorRoom({0, 1, 3}, {0, 0.8, 0}), {0, 1.4, 6, 1}, true};
    test::addSquare(f.scene, 0.8, {0, 1.2, 4.5}, {0, 0, 1});
    addMesh(f.scene, makeSphere(0.4f, 24, 12), {0.2, 0.6, 0.5});
    out.push_back(f);
    f = {"6: the eye is between light and occluder", floorRoom({0, 1, 3}, {0, 0.8, 0}), {0, 2, 5, 1}};
    addMesh(f.scene, makeSphere(0.4f, 24, 12), {0.2, 0.6, 0.5});
    test::addSquare(f.scene, 0.5, {-0.7, 1, 0}, {0, 0, 1});
    out.push_back(f);
    f = {"7: under a table", floorRoom({0, 0.5, 2}, {0, 0.4, 0}), {0.4, 3, 1.5, 1}, true};
    f.scene.camera.near = 0.05;
    addTable(f.scene);
    f.scene.nodes[1].scale = {2, 2, 1};
    out.push_back(f);
    f = {"the light is in the view plane", floorRoom({0, 1, 3}, {0, 0.6, 0}), {}};
    addMesh(f.scene, makeSphere(0.4f, 24, 12), {0.2, 0.6, 0.5});
    const Vec3 forward = glm::normalize(f.scene.camera.target - f.scene.camera.eye), right(1, 0, 0);
    f.light = Vec4(f.scene.camera.eye + f.scene.camera.near * forward + 2.0 * right + glm::cross(right, forward), 1);
    test::addSquare(f.scene, 0.4, {1, 1.7, 2.4}, glm::normalize(Vec3(1, 0.5, 0.4)));
    out.push_back(f);
    f = {"the camera is in several volumes", floorRoom({0, 1, 3}, {0, 0.6, 0}), {0, 6, 3.5, 1}, true};
    for (const double y : {2.0, 2.5, 3.0, 4.0}) test::addSquare(f.scene, 0.7, {0, y, 3}, {0, 1, 0});
    addMesh(f.scene, makeSphere(0.4f, 24, 12), {0.2, 0.6, 0.5});
    out.push_back(f);
    f = {"the light is inside a body", floorRoom({0, 1, 3}, {0, 0.6, 0}), {0.2, 0.7, 0.5, 1}};
    addMesh(f.scene, makeSphere(0.4f, 24, 12), {0.2, 0.6, 0.5});
    out.push_back(f);
    f = {"the light is infinitely far", floorRoom({0, 1, 3}, {0, 0.6, 0}), Vec4(glm::normalize(Vec3(0.2, 1, 0.6)), 0)};
    addMesh(f.scene, makeSphere(0.4f, 24, 12), {0.2, 0.6, 0.5});
    test::addSquare(f.scene, 0.7, {0.4, 2.5, 4}, {0, 1, 0});
    out.push_back(f);
    return out;
}

constexpr int kSize = 128;

struct Verdict {
    int compared = 0, shadowed = 0, wrong = 0;
};

/// Against a ray to the light, where the side that is seen faces it and the eight pixels around agree in object and
/// answer: there, rounding decides.
Verdict judge(const Figure& f, const CountedShadowOptions& options) {
    test::context();
    ProgramLoader loader;
    const auto nodes = nodeTransforms(f.scene, 0);
    GeometryBuffer geometry(kSize, kSize);
    std::map<int, GpuMesh> meshes;
    geometry.draw(loader, f.scene, nodes, test::albedos(f.scene), meshes);
    CountedShadows shadows(loader, f.scene, nodes);
    shadows.begin(geometry, f.scene.camera);
    shadows.add(f.light, 1, options);
    const Image image = shadows.read();
    const std::vector<SeenPoint> seen = geometry.read();
    const RayScene rays(f.scene, nodes);
    std::vector<int> truth(seen.size(), -1);
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (seen[i].place.w == 0) continue;
        const Vec3 place(seen[i].place);
        Vec3 n(seen[i].normal);
        if (glm::dot(n, f.scene.camera.eye - place) < 0) n = -n;
        const Vec3 to = f.light.w == 0 ? Vec3(f.light) : Vec3(f.light) - place;
        if (glm::dot(n, glm::normalize(to)) < 0.05) continue;
        truth[i] = rays.blocked(place, f.light.w == 0 ? place + 100.0 * to : Vec3(f.light), true);
    }
    Verdict out;
    for (int y = 1; y + 1 < kSize; ++y)
        for (int x = 1; x + 1 < kSize; ++x) {
            const auto at = [&](int dx, int dy) { return static_cast<std::size_t>((y + dy) * kSize + x + dx); };
            bool clear = truth[at(0, 0)] >= 0;
            for (int k = 0; k < 9; ++k) {
                const std::size_t there = at(k % 3 - 1, k / 3 - 1);
                clear = clear && truth[there] == truth[at(0, 0)] && seen[there].place.w == seen[at(0, 0)].place.w;
            }
            if (!clear) continue;
            ++out.compared;
            out.shadowed += truth[at(0, 0)];
            out.wrong += (image.at(x, kSize - 1 - y, 0) > 0.5f) != (truth[at(0, 0)] == 1);
        }
    return out;
}

TEST(CountedShadows, EveryPixelOfTheFiguresIsRightWithBothEnds) {
    for (const Figure& f : figures()) {
        const Verdict v = judge(f, {VolumeCapping::Exact});
        EXPECT_GT(v.compared, 1000) << f.name;
        EXPECT_EQ(v.wrong, 0) << f.name << ": of " << v.compared << ", " << v.shadowed << " in shadow";
    }
}

TEST(CountedShadows, OpenVolumesAreWrongWhereThePaperSaysSo) {
    for (const Figure& f : figures()) {
        if (!f.needsEnds) continue;
        EXPECT_GT(judge(f, {VolumeCapping::None}).wrong, 100) << f.name;
    }
}

TEST(CountedShadows, ApproximateEndsMissFewPixels) {
    for (const Figure& f : figures()) {
        const Verdict v = judge(f, {VolumeCapping::Approximate, 16});
        EXPECT_LE(v.wrong, 0.01 * v.compared) << f.name;
        std::printf("figure %s: %.3f %% wrong\n", f.name.c_str(), 100.0 * v.wrong / v.compared);
    }
}

/// A ball over a floor under a square lamp.
TEST(CountedShadows, SixteenPointsAndTheEdgeStoppingFilterMakeSoftShadows) {
    test::context();
    ProgramLoader loader;
    SceneDescription scene = floorRoom({2, 2.5, 3}, {0, 0.3, 0});
    addMesh(scene, makeSphere(0.5f, 48, 24), {0, 0.8, 0});
    const Light lamp{false, {0.5, 3, 0.5}, Rgb(1), {}};
    const LightArea area{{0.4, 0, 0}, {0, 0, 0.4}};
    const auto nodes = nodeTransforms(scene, 0);
    constexpr int kEdge = 256;
    GeometryBuffer geometry(kEdge, kEdge);
    std::map<int, GpuMesh> meshes;
    geometry.draw(loader, scene, nodes, test::albedos(scene), meshes);
    CountedShadows shadows(loader, scene, nodes);
    shadows.begin(geometry, scene.camera);
    for (const Light& p : pointsOfArea(lamp, area, 16)) shadows.add(homogeneous(p), 1.0 / 16);
    const std::vector<SeenPoint> seen = geometry.read();
    const RayScene rays(scene, nodes);
    const std::vector<Light> many = pointsOfArea(lamp, area, 1024);
    std::map<ShadowFilter, double> squares;
    std::map<ShadowFilter, Image> images;
    for (const ShadowFilter f : {ShadowFilter::None, ShadowFilter::Box, ShadowFilter::EdgeStopping})
        images[f] = shadows.read(f);
    int count = 0;
    for (int y = 0; y < kEdge; ++y)
        for (int x = 0; x < kEdge; ++x) {
            const SeenPoint& p = seen[static_cast<std::size_t>(y * kEdge + x)];
            const Vec3 place(p.place);
            if (p.place.w == 0 || glm::dot(Vec3(p.normal), lamp.position - place) < 0) continue;
            double truth = 0;
            for (const Light& l : many) truth += rays.blocked(place, l.position, true) / 1024.0;
            for (const auto& [f, image] : images) squares[f] += sqr(image.at(x, kEdge - 1 - y, 0) - truth);
            ++count;
        }
    const auto psnr = [&](ShadowFilter f) { return -10 * std::log10(squares[f] / count); };
    std::printf("16 points: %.1f dB, 7 x 7 average %.1f dB, edge-stopping %.1f dB\n", psnr(ShadowFilter::None),
                psnr(ShadowFilter::Box), psnr(ShadowFilter::EdgeStopping));
    EXPECT_GE(psnr(ShadowFilter::EdgeStopping), 35);
    EXPECT_GT(psnr(ShadowFilter::EdgeStopping), psnr(ShadowFilter::Box));
}

}  // namespace
}  // namespace nacre
