#include "bench/shadow_sweep.hpp"

#include <fmt/format.h>

#include "factorize/factorize.hpp"
#include "factorize/models/models.hpp"
#include "reference/shadow_error.hpp"
#include "shading/alpha_shadow.hpp"
#include "shading/primitives.hpp"
#include "shading/shadow_map.hpp"
#include "shading/timing.hpp"

namespace nacre::bench {
namespace {

constexpr int kPixels = 512;  ///< edge of the pictures
constexpr const char* kModel = "torrance-sparrow:d=beckmann,g=smith,alpha=0.2,f=dielectric";

ShadowMeasurement begin(const ShadowBenchScene& scene, const ShadowLight& light, const std::string& method,
                        const std::string& setting) {
    ShadowMeasurement m;
    m.scene = scene.name;
    m.light = light.name;
    m.method = method;
    m.setting = setting;
    return m;
}

void take(ShadowMeasurement& m, const ShadowError& error) {
    m.acne = error.share(error.acne);
    m.leaks = error.share(error.leaks);
    m.boundary = error.share(error.boundary);
}

SceneShadow optionsFor(const ShadowLight& light, int size, int bits, int filter) {
    SceneShadow options;
    options.size = size, options.bits = bits, options.filter = filter;
    options.cascades = light.cascades, options.dualParaboloid = light.dualParaboloid;
    return options;
}

ShadowTruth truthOf(const ShadowBenchScene& scene, const ShadowLight& light) {
    return {scene.mesh, scene.camera, light.light, {kPixels, kPixels}};
}

/// The scene on the GPU, and what is drawn of it.
class Stage {
public:
    Stage(ProgramLoader& loader, const ShadowBenchScene& scene)
        : loader_(loader), scene_(scene), mesh_(scene.mesh), target_({.width = kPixels, .height = kPixels}) {}

    ShadowScene shadowScene() const { return {{{&mesh_}}, boundsOf(scene_.mesh), &scene_.camera, 1}; }
    Image mask(const ShadowMap& map) const {
        target_.clear();
        renderShadowMask(loader_, target_, mesh_, scene_.camera, map);
        return target_.read(1);
    }
    /// Seconds of: drawing the map; a frame without and with shadow, of a factored BRDF and of one evaluated directly.
    std::vector<double> seconds(const Light& light, ShadowMap& map, const GpuMesh& mesh, int repeats) const {
        const GpuDirectBrdf direct = directBrdf(makeModel(kModel)).value();
        const GpuFactoredBrdf factored(factorize(makeModel(kModel), FactorizeOptions{}));
        LitView plain{scene_.camera, {light}}, shadowed = plain;
        shadowed.shadows = {&map};
        const ShadowScene drawn = shadowScene();
        const std::vector<std::function<void()>> frames{
            [&] { map.update(loader_, light, drawn); },
            [&] { target_.clear(), renderFactored(loader_, target_, mesh, plain, factored); },
            [&] { target_.clear(), renderFactored(loader_, target_, mesh, shadowed, factored); },
            [&] { target_.clear(), renderDirect(loader_, target_, mesh, plain, direct); },
            [&] { target_.clear(), renderDirect(loader_, target_, mesh, shadowed, direct); }};
        return medianFrameSeconds(frames, {.repeats = repeats});
    }
    const GpuMesh& mesh() const { return mesh_; }
    /// Lit by the paper's method: a light so bright that all it reaches is.
    Image alphaMask(const Light& light, const AlphaShadowOptions& options, ShadowView& view) const {
        Light bright = light;
        bright.color = Rgb(1e5);
        AlphaShadow shadow(options);
        shadow.update(loader_, bright, shadowScene());
        view = shadow.view();
        const Image picture = shadow.render(loader_, shadowScene().casters, {scene_.camera, {bright}},
                                            directBrdf(makeModel("lambert")).value(), kPixels, kPixels);
        Image out(kPixels, kPixels, 1);
        for (int y = 0; y < kPixels; ++y)
            for (int x = 0; x < kPixels; ++x) out.at(x, y, 0) = picture.at(x, y, 1) > 0 ? 1 : 0;
        return out;
    }

private:
    ProgramLoader& loader_;
    const ShadowBenchScene& scene_;
    GpuMesh mesh_;
    RenderTarget target_;
};

ShadowMeasurement measureMap(ProgramLoader& loader, const Stage& stage, const ShadowBenchScene& scene,
                             const ShadowLight& light, const ShadowTruth& truth, int size, int bits, int filter) {
    ShadowMeasurement m =
        begin(scene, light, fmt::format("linear depth, {} bits", bits), fmt::format("{}², filter {}", size, filter));
    m.size = size, m.bits = bits;
    const SceneShadow options = optionsFor(light, size, bits, filter), usual;
    m.usual = size == usual.size && bits == usual.bits && filter == usual.filter;
    ShadowMap map(options);
    map.update(loader, light.light, stage.shadowScene());
    take(m, truth.compare(stage.mask(map), map.view()));
    m.bytes = static_cast<double>(map.bytes());
    return m;
}

ShadowMeasurement measureAlpha(const Stage& stage, const ShadowBenchScene& scene, const ShadowLight& light,
                               const ShadowTruth& truth, int size, int bits) {
    ShadowMeasurement m =
        begin(scene, light, fmt::format("alpha test, {} bits", bits), fmt::format("{}², no filter", size));
    m.size = size, m.bits = bits;
    m.bytes = 4.0 * size * size * bits / 8;  // RGBA
    ShadowView view;
    const Image mask = stage.alphaMask(light.light, {.size = size, .bits = bits}, view);
    take(m, truth.compare(mask, view));
    return m;
}

/// One spot map with near = far / ratio, its depths in another code. The same bias rule for all codes.
ShadowMeasurement measureCode(const ShadowBenchScene& scene, const ShadowLight& light, const ShadowTruth& truth,
                              double ratio, const DepthCode& code) {
    SceneShadow options;
    const ShadowView fitted = fitShadow(options, light.light, boundsOf(scene.mesh));
    options.far = fitted.far, options.near = fitted.far / ratio;
    ShadowView view = fitShadow(options, light.light, boundsOf(scene.mesh));
    // fitShadow knows 16 and 32 bits; 32 has what single precision leaves, to which the code's half step comes
    if (!code.hyperbolic) view.resolution += 0.5 * (view.far - view.near) / std::pow(2.0, code.bits);
    ShadowMeasurement m = begin(scene, light, code.hyperbolic ? "z-buffer, traced" : "linear, traced",
                                fmt::format("near/far 1/{:g}, {} bits", ratio, code.bits));
    m.bits = code.bits;
    m.nearToFar = 1 / ratio;
    const std::vector<Image> layers = tracedShadowMap(scene.mesh, view, code);
    take(m, truth.compare(truth.mask(view, layers, code.hyperbolic ? code.bits : 0), view));
    return m;
}

void raise(Bar& bar, double value, const std::string& where) {
    if (bar.measured && value <= bar.value) return;
    bar.value = value;
    bar.worst = where;
    bar.measured = true;
}

void sweepScene(const ShadowBenchScene& scene, const ShadowSweepOptions& options, std::vector<ShadowMeasurement>& out) {
    const Stage stage(*options.loader, scene);
    const std::vector<int> sizes = options.quick ? std::vector{512, 1024} : std::vector{256, 512, 1024, 2048};
    for (const ShadowLight& light : shadowLights()) {
        report(options.progress, fmt::format("shadows of {}, {}", scene.name, light.name), 0);
        const ShadowTruth truth = truthOf(scene, light);
        for (const int size : sizes)
            for (const int bits : {16, 32})
                out.push_back(measureMap(*options.loader, stage, scene, light, truth, size, bits, 3));
        for (const int filter : {1, 5})
            out.push_back(measureMap(*options.loader, stage, scene, light, truth, 1024, 32, filter));
        if (!light.light.cone) continue;
        for (const int size : sizes)
            for (const int bits : {8, 16, 32}) out.push_back(measureAlpha(stage, scene, light, truth, size, bits));
        for (ShadowMeasurement& m : out) {
            if (m.scene != scene.name || m.light != light.name || m.method.rfind("linear depth", 0) != 0) continue;
            const int filter = m.setting.back() - '0';
            ShadowMap map(optionsFor(light, m.size, m.bits, filter));
            const std::vector<double> s = stage.seconds(light.light, map, stage.mesh(), options.quick ? 5 : 11);
            m.updateMs = 1000 * s[0];
            m.frame = s[2] / s[1];
        }
    }
}

}  // namespace

std::vector<ShadowMeasurement> sweepShadows(const std::vector<ShadowBenchScene>& scenes,
                                            const ShadowSweepOptions& options) {
    std::vector<ShadowMeasurement> out;
    const std::size_t count = options.quick ? std::min<std::size_t>(1, scenes.size()) : scenes.size();
    if (options.loader)
        for (std::size_t i = 0; i < count; ++i) sweepScene(scenes[i], options, out);
    const ShadowBenchScene& scene = scenes[count > 1 ? 1 : 0];
    const ShadowLight spot = shadowLights().front();
    const ShadowTruth truth = truthOf(scene, spot);
    const std::vector<double> ratios = options.quick ? std::vector{1e3} : std::vector{10.0, 1e2, 1e3, 1e4, 1e5};
    for (const double ratio : ratios)
        for (const int bits : options.quick ? std::vector{16, 24} : std::vector{8, 10, 12, 16, 20, 24})
            for (const bool hyperbolic : {false, true}) {
                report(options.progress, fmt::format("depth codes, near/far 1/{:g}, {} bits", ratio, bits), 0);
                out.push_back(measureCode(scene, spot, truth, ratio, {hyperbolic, bits}));
            }
    return out;
}

std::vector<Bar> measureShadowBars(const std::vector<ShadowBenchScene>& scenes, const ShadowSweepOptions& options) {
    Bar off{"shadow maps, 1024, 32 bits, spot, sun and bulb", "acne and leaks off boundaries, share of pixels", 0.001};
    Bar hard{"the same, grazing sun, paraboloids, cascades", "acne and leaks off boundaries, share of pixels", 0.001};
    Bar codes{"linear 16 bits less z-buffer 24, near/far 1/1000", "acne and leaks, share of pixels", 0};
    Bar frame{"frame of a scene, factored BRDF, one shadow, filter 3", "times the unshadowed frame's", 1.5};
    Bar direct{"the same, the model evaluated", "times the unshadowed frame's", 1.5};
    Bar square{"the same two, a square that fills the picture", "times the unshadowed frame's", 1.5};
    const std::vector<ShadowLight> lights = shadowLights();
    for (const ShadowBenchScene& scene : scenes) {
        report(options.progress, "bars of shadows on " + scene.name, 0);
        const ShadowTruth spot = truthOf(scene, lights[0]);
        const double linear = [&] {
            const ShadowMeasurement m = measureCode(scene, lights[0], spot, 1000, {false, 16});
            return m.acne + m.leaks;
        }();
        const ShadowMeasurement z = measureCode(scene, lights[0], spot, 1000, {true, 24});
        raise(codes, linear - (z.acne + z.leaks),
              fmt::format("{}: {:.2e}, {:.2e}", scene.name, linear, z.acne + z.leaks));
        if (!options.loader) continue;
        const Stage stage(*options.loader, scene);
        for (std::size_t i = 0; i < lights.size(); ++i) {
            const ShadowTruth truth = truthOf(scene, lights[i]);
            const ShadowMeasurement m = measureMap(*options.loader, stage, scene, lights[i], truth, 1024, 32, 3);
            raise(i < 3 ? off : hard, m.acne + m.leaks,
                  fmt::format("{}, {}: acne {:.1e}, leaks {:.1e}, at boundaries {:.1e}", scene.name, lights[i].name,
                              m.acne, m.leaks, m.boundary));
        }
        ShadowMap map;
        const auto without = [&](double seconds) {
            return fmt::format("{}, {:.2f} ms without", scene.name, 1000 * seconds);
        };
        const std::vector<double> s = stage.seconds(lights[0].light, map, stage.mesh(), 15);
        raise(frame, s[2] / s[1], without(s[1]));
        raise(direct, s[4] / s[3], without(s[3]));
        const std::vector<double> q = stage.seconds(lights[0].light, map, GpuMesh(makeQuad(12, 8)), 15);
        raise(square, q[2] / q[1], "factored, map of " + without(q[1]));
        raise(square, q[4] / q[3], "evaluated, map of " + without(q[3]));
    }
    return {off, hard, codes, frame, direct, square};
}

}  // namespace nacre::bench
