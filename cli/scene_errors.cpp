#include "cli/scene_errors.hpp"

#include <algorithm>
#include <limits>

#include "cli/output_file.hpp"

namespace nacre::cli {
namespace {

/// An approximation, switched off in the picture and left out of the reference.
struct Approximation {
    const char* name;
    SceneSwitches off;
    SceneParts without;
};

/// Whether it lights something.
bool hasSurrounding(const SceneDescription& scene) {
    return std::any_of(scene.nodes.begin(), scene.nodes.end(), [&](const SceneNode& node) {
        return node.material >= 0 && scene.materials[static_cast<std::size_t>(node.material)].surrounding;
    });
}

std::vector<Approximation> approximationsOf(const SceneDescription& scene) {
    bool brdf = false, relief = false, indirect = false;
    for (const SceneNode& node : scene.nodes) {
        if (node.material < 0) continue;
        const SceneMaterial& m = scene.materials[static_cast<std::size_t>(node.material)];
        brdf = brdf || m.brdf >= 0;
        relief = relief || (m.relief && m.relief->shadow != BumpShadow::None);
        indirect = indirect || (m.relief && m.relief->indirectLight >= 0);
    }
    const bool shadows = std::any_of(scene.lights.begin(), scene.lights.end(),
                                     [](const SceneLight& light) { return light.shadow.has_value(); });
    std::vector<Approximation> out;
    const auto add = [&out](const char* name) -> Approximation& {
        return out.emplace_back(Approximation{name, {}, {}});
    };
    if (brdf && !scene.lights.empty()) add("brdf").without.bakedBrdf = true;
    if (shadows) {
        Approximation& a = add("shadow maps");
        a.off.shadows = a.without.shadows = false;
    }
    if (relief) {
        Approximation& a = add("relief shadows");
        a.off.reliefShadow = BumpShadow::None;
        a.without.reliefShadow = false;
    }
    if (indirect) {
        Approximation& a = add("indirect light");
        a.off.indirect = a.without.indirect = false;
    }
    if (hasSurrounding(scene)) {
        Approximation& a = add("surrounding");
        a.off.surrounding = a.without.surrounding = false;
    }
    return out;
}

double squareError(const ImageDifference& d) { return std::pow(10, -d.psnrSrgb / 10); }

}  // namespace

Image shrunk(const Image& fine, int n) {
    if (n == 1) return fine;
    Image out(fine.width() / n, fine.height() / n, 3);
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x) {
            Rgb sum(0);
            for (int k = 0; k < n * n; ++k) sum += fine.rgb(n * x + k % n, n * y + k / n);
            out.setRgb(x, y, sum / double(n * n));
        }
    return out;
}

Image shoot(SceneRenderer& renderer, const SceneShot& shot) {
    const int n = shot.samples;
    const RenderTarget target({.width = n * shot.width, .height = n * shot.height});
    renderer.render(target, shot.time);
    return shrunk(target.read(), n);
}

double fastestFrame(SceneRenderer& renderer, const SceneShot& shot, int frames) {
    const RenderTarget target({.width = shot.samples * shot.width, .height = shot.samples * shot.height});
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < frames; ++i) {
        const Stopwatch watch;
        renderer.render(target, shot.time);
        target.read();
        least = std::min(least, watch.seconds());
    }
    return least;
}

SceneErrors measureScene(SceneRenderer& renderer, const Image& picture, const SceneShot& shot, int rays, bool shares,
                         const Progress& progress) {
    const SceneDescription& scene = renderer.scene();
    const std::vector<Approximation> list = shares ? approximationsOf(scene) : std::vector<Approximation>();
    std::vector<SceneParts> parts(1);  // all
    for (const Approximation& a : list) parts.push_back(a.without);
    if (hasSurrounding(scene)) parts.emplace_back().occlusion = true;
    for (SceneParts& part : parts) part.interreflection = shot.interreflection;
    const SceneTruths truths = openTruths(scene, 0, progress);
    SceneTraceOptions options{.width = shot.width, .height = shot.height, .supersample = rays, .time = shot.time};
    options.specularDepth = renderer.switches.specular.depth;
    options.lightDepth = renderer.switches.specular.lightDepth;
    options.progress = progress;
    const Stopwatch watch;
    std::vector<Image> traced = traceScene(scene, scene.camera, truths, parts, options);
    const SceneSwitches before = renderer.switches;
    SceneErrors out;
    out.seconds = watch.seconds();
    out.notes = truths.notes;
    out.white = pictureWhite(traced[0]);
    out.all = compareImages(picture, traced[0], out.white);
    if (hasSurrounding(scene)) out.occluded = compareImages(picture, traced.back(), out.white);
    for (std::size_t i = 0; i < list.size(); ++i) {
        const bool brdf = list[i].without.bakedBrdf;
        renderer.switches = list[i].off;
        renderer.switches.specular = before.specular;
        renderer.switches.shadowMethod = before.shadowMethod;
        if (brdf) renderer.switches.reflectance = SceneReflectance::Direct;
        const Image off = shoot(renderer, shot);
        const ImageDifference without = compareImages(brdf ? picture : off, traced[i + 1], out.white);
        out.shares.push_back({list[i].name, compareImages(off, traced[0], out.white).psnrSrgb, without.psnrSrgb,
                              1 - squareError(without) / squareError(out.all)});
    }
    renderer.switches = before;
    out.reference = std::move(traced[0]);
    return out;
}

}  // namespace nacre::cli
