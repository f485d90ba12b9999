// Counted shadow volumes against rays.
#include "bench/hybrid_sweep.hpp"
#include "core/light_area.hpp"
#include "shading/hybrid/counted_shadows.hpp"
#include "shading/primitives.hpp"
#include "shading/scene_file.hpp"

namespace nacre::bench {
namespace {

constexpr int kSize = 128;
constexpr const char* kFigures[] = {"3-overlapping",     "4-straddling",         "5a-light-before",
                                    "5b-light-behind",   "6-eye-between",        "7-under-a-table",
                                    "eye-in-several",    "light-in-view-plane",  "light-in-a-body",
                                    "light-at-infinity", "small-before-the-view"};

/// A scene as its camera sees it.
struct Seen {
    Seen(ProgramLoader& loader, const SceneDescription& scene, int size)
        : nodes(nodeTransforms(scene, 0)), geometry(size, size), shadows(loader, scene, nodes), rays(scene, nodes) {
        geometry.draw(loader, scene, nodes, std::vector<Rgb>(scene.materials.size(), Rgb(0.5)), meshes);
        points = geometry.read();
        shadows.begin(geometry, scene.camera);
    }
    std::vector<glm::dmat4> nodes;
    std::map<int, GpuMesh> meshes;
    GeometryBuffer geometry;
    CountedShadows shadows;
    RayScene rays;
    std::vector<SeenPoint> points;
};

/// 1 in shadow, 0 lit, −1 where the side that is seen doesn't face the light.
std::vector<int> tracedShadows(const Seen& seen, const SceneDescription& scene, const Vec4& light) {
    std::vector<int> out(seen.points.size(), -1);
    for (std::size_t i = 0; i < out.size(); ++i) {
        const SeenPoint& p = seen.points[i];
        if (p.place.w == 0) continue;
        const Vec3 place(p.place), n(p.normal), to = light.w == 0 ? Vec3(light) : Vec3(light) - place;
        const double side = glm::dot(n, scene.camera.eye - place) < 0 ? -1 : 1;
        if (side * glm::dot(n, glm::normalize(to)) < 0.05) continue;
        out[i] = seen.rays.blocked(place, light.w == 0 ? place + 100.0 * to : Vec3(light), true);
    }
    return out;
}

/// Whether the eight pixels around agree in object and answer: elsewhere rounding decides.
bool isClear(const Seen& seen, const std::vector<int>& truth, int x, int y) {
    const auto middle = static_cast<std::size_t>(y * kSize + x);
    for (int k = 0; k < 9; ++k) {
        const auto at = static_cast<std::size_t>((y + k / 3 - 1) * kSize + x + k % 3 - 1);
        if (truth[at] != truth[middle] || seen.points[at].place.w != seen.points[middle].place.w) return false;
    }
    return truth[middle] >= 0;
}

void judge(ProgramLoader& loader, const SceneDescription& scene, CountedVerdict& out) {
    Seen seen(loader, scene, kSize);
    const Vec4 light = homogeneous(scene.lights.front().light);
    const std::vector<int> truth = tracedShadows(seen, scene, light);
    for (const VolumeCapping capping : {VolumeCapping::Exact, VolumeCapping::Approximate}) {
        const bool exact = capping == VolumeCapping::Exact;
        seen.shadows.begin(seen.geometry, scene.camera);
        seen.shadows.add(light, 1, {capping, 16});
        const Image counted = seen.shadows.read();
        for (int y = 1; y + 1 < kSize; ++y)
            for (int x = 1; x + 1 < kSize; ++x) {
                if (!isClear(seen, truth, x, y)) continue;
                const bool shadow = counted.at(x, kSize - 1 - y, 0) > 0.5f;
                out.compared += exact;
                if (shadow != (truth[static_cast<std::size_t>(y * kSize + x)] == 1))
                    ++(exact ? out.wrong : out.wrongApproximate);
            }
    }
}

SceneDescription ballOverFloor() {
    SceneDescription scene;
    scene.materials.emplace_back().model = "lambert:kd=0.5";
    scene.meshes = {{"floor", makeQuad(12, 1)}, {"ball", makeSphere(0.5f, 48, 24)}};
    scene.nodes.resize(2);
    for (int i = 0; i < 2; ++i) scene.nodes[static_cast<std::size_t>(i)].mesh = i;
    for (SceneNode& node : scene.nodes) node.material = 0;
    scene.nodes[0].rotation = glm::angleAxis(-kPi / 2, Vec3(1, 0, 0));
    scene.nodes[1].translation = {0, 0.8, 0};
    scene.camera.eye = {2, 2.5, 3};
    scene.camera.target = {0, 0.3, 0};
    scene.camera.fovY = 0.9;
    return scene;
}

}  // namespace

CountedVerdict judgeFigures(ProgramLoader& loader) {
    CountedVerdict out;
    for (const char* figure : kFigures)
        judge(loader, readScene(std::string(NACRE_SOURCE_DIR "/demos/scenes/figures/") + figure + ".json"), out);
    return out;
}

double softShadowPsnr(ProgramLoader& loader) {
    constexpr int kEdge = 256;
    const SceneDescription scene = ballOverFloor();
    const Light lamp{false, {0.5, 3, 0.5}, Rgb(1), {}};
    const LightArea area{{0.4, 0, 0}, {0, 0, 0.4}};
    Seen seen(loader, scene, kEdge);
    for (const Light& p : pointsOfArea(lamp, area, 16)) seen.shadows.add(homogeneous(p), 1.0 / 16);
    const Image drawn = seen.shadows.read(ShadowFilter::EdgeStopping);
    const std::vector<Light> many = pointsOfArea(lamp, area, 1024);
    double squares = 0;
    int count = 0;
    for (int y = 0; y < kEdge; ++y)
        for (int x = 0; x < kEdge; ++x) {
            const SeenPoint& p = seen.points[static_cast<std::size_t>(y * kEdge + x)];
            const Vec3 place(p.place);
            if (p.place.w == 0 || glm::dot(Vec3(p.normal), lamp.position - place) < 0) continue;
            double truth = 0;
            for (const Light& l : many) truth += seen.rays.blocked(place, l.position, true) / 1024.0;
            squares += sqr(drawn.at(x, kEdge - 1 - y, 0) - truth);
            ++count;
        }
    return -10 * std::log10(squares / count);
}

}  // namespace nacre::bench
