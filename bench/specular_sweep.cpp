#include "bench/specular_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "bench/specular_lab.hpp"
#include "reference/image_compare.hpp"
#include "shading/multipass/quality.hpp"
#include "shading/scene_file.hpp"

namespace nacre::bench {
namespace {

/// One way in which pictures of a scene differ.
struct Setting {
    std::string name;
    SceneSwitches on;
    bool usual = false;
};

struct Knob {
    std::string scene, name;
    SceneSwitches full;  ///< what the truth has
    std::vector<Setting> settings;
};

class Sweep {
public:
    Sweep(const SpecularSweepOptions& options, std::vector<SpecularMeasurement>& out) : options_(options), out_(out) {}

    void run(const Knob& knob, const std::function<void(SceneDescription&)>& edit = {}) {
        report(options_.progress, fmt::format("{}: {}", knob.scene, knob.name), 0);
        SceneDescription scene = readScene(options_.scenes / (knob.scene + ".json"));
        if (edit) edit(scene);
        SpecularLab lab(*options_.loader, std::move(scene));
        const int size = options_.quick ? 64 : 384;
        lab.draw(knob.full, size);
        const Image truth = lab.trace(knob.full, size, options_.quick ? 64 : 1024);
        const double white = pictureWhite(truth);
        for (const Setting& setting : knob.settings) {
            SpecularMeasurement m{knob.scene, knob.name, setting.name, setting.usual};
            const ImageDifference off = compareImages(lab.draw(setting.on, size), truth, white);
            m.rmsOverMean = off.rmsOverMean;
            m.psnr = off.psnrSrgb;
            m.ms = 1000 * lab.frameSeconds(options_.quick ? 1 : 5);
            m.passes = lab.renderer().schedule().passes.size();
            m.views = lab.renderer().schedule().views.size() - 1;
            m.lights = lab.renderer().schedule().lights.size();
            lab.trace(setting.on, size, setting.on.specular.shears);
            m.tracedMs = 1000 * lab.traceSeconds();
            out_.push_back(m);
        }
    }

private:
    const SpecularSweepOptions& options_;
    std::vector<SpecularMeasurement>& out_;
};

SceneSwitches withVolumes(int depth, int lightDepth) {
    SceneSwitches out;
    out.shadowMethod = ShadowMethod::Volumes;
    out.specular.depth = depth;
    out.specular.lightDepth = lightDepth;
    return out;
}

Knob recursion(bool quick) {
    Knob out{"mirrors", "recursion depth", withVolumes(quick ? 3 : 8, 0), {}};
    for (const int depth : quick ? std::vector{0, 2} : std::vector{0, 1, 2, 3, 4, 6, 8})
        out.settings.push_back(
            {fmt::format("depth {}", depth), withVolumes(depth, 0), depth == SpecularOptions().depth});
    return out;
}

Knob lightDepths(const std::string& scene, int most) {
    Knob out{scene, "light depth", withVolumes(SpecularOptions().depth, most), {}};
    for (int depth = 0; depth <= most; ++depth) {
        out.settings.push_back({fmt::format("{} faces", depth), withVolumes(SpecularOptions().depth, depth),
                                depth == std::min(most, SpecularOptions().lightDepth)});
    }
    return out;
}

Knob shears(bool quick) {
    Knob out{"plates", "samples of frosted glass", withVolumes(2, 0), {}};
    for (const int count : quick ? std::vector{2, 8} : std::vector{1, 2, 4, 8, 16, 32, 64})
        for (const ShearSampling sampling : {ShearSampling::LowDiscrepancy, ShearSampling::Random}) {
            SceneSwitches on = out.full;
            on.specular.shears = count;
            on.specular.sampling = sampling;
            const bool random = sampling == ShearSampling::Random;
            out.settings.push_back({fmt::format("{} {}", count, random ? "random" : "of low discrepancy"), on,
                                    !random && count == SpecularOptions().shears});
        }
    return out;
}

Knob qualities(bool quick) {
    Knob out{"mirrors", "quality", withVolumes(quick ? 3 : 8, 1), {}};
    for (int level = 0; level < kQualityLevels; level += quick ? 2 : 1)
        out.settings.push_back({qualityName(level), atQuality(out.full, level), level == 0});
    return out;
}

}  // namespace

std::vector<SpecularMeasurement> sweepSpecular(const SpecularSweepOptions& options) {
    std::vector<SpecularMeasurement> out;
    if (!options.loader) return out;
    Sweep sweep(options, out);
    sweep.run(recursion(options.quick));
    sweep.run(shears(options.quick), [](SceneDescription& scene) {
        for (SceneMaterial& m : scene.materials)
            if (m.specular) m.specular->ior = 1, m.specular->spread = 0.12;
    });
    sweep.run(lightDepths("lit-by-mirror", 1));
    if (!options.quick) sweep.run(lightDepths("stained-glass", 1));
    if (!options.quick) sweep.run(lightDepths("bevelled-glass", 2));
    sweep.run(qualities(options.quick));
    return out;
}

}  // namespace nacre::bench
