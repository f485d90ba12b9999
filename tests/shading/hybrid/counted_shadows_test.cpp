// HYBRID figures 3 to 7 as scenes whose answer per pixel a ray knows.
#include "shading/hybrid/counted_shadows.hpp"

#include <gtest/gtest.h>

#include "../gpu_evaluate.hpp"
#include "hybrid_fixture.hpp"
#include "shading/scene_file.hpp"

namespace nacre {
namespace {

struct Figure {
    std::string name;
    bool needsEnds;  ///< wrong without
    SceneDescription scene;
    Vec4 light;
};

/// demos/scenes/figures
std::vector<Figure> figures() {
    std::vector<Figure> out;
    for (const auto& [name, needsEnds] : {std::pair<std::string, bool>{"3-overlapping", false},
                                          {"4-straddling", false},
                                          {"5a-light-before", true},
                                          {"5b-light-behind", true},
                                          {"6-eye-between", false},
                                          {"7-under-a-table", true},
                                          {"light-in-view-plane", false},
                                          {"eye-in-several", true},
                                          {"light-in-a-body", false},
                                          {"light-at-infinity", false},
                                          {"small-before-the-view", false}}) {
        Figure f{name, needsEnds, readScene(NACRE_SOURCE_DIR "/demos/scenes/figures/" + name + ".json"), {}};
        f.light = homogeneous(f.scene.lights.front().light);
        out.push_back(std::move(f));
    }
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
    geometry.draw(loader, f.scene, nodes, std::vector<Rgb>(f.scene.materials.size(), Rgb(0.5)), meshes);
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

TEST(CountedShadows, ApproximateEndsMissWhatTheRaysMiss) {
    for (const Figure& f : figures()) {
        const auto wrong = [&](int rays) {
            const Verdict v = judge(f, {VolumeCapping::Approximate, rays});
            return static_cast<double>(v.wrong) / v.compared;
        };
        const double one = wrong(1), sixteen = wrong(16), many = wrong(1024);
        std::printf("%s: wrong with 1, 16, 1024 rays: %.2f %%, %.2f %%, %.2f %%\n", f.name.c_str(), 100 * one,
                    100 * sixteen, 100 * many);
        EXPECT_EQ(many, 0) << f.name;
        if (f.name == "small-before-the-view") {
            EXPECT_GT(one, 0.001) << "its shadow is a fiftieth of the view plane";
        }
    }
}

}  // namespace
}  // namespace nacre
