#include <fmt/format.h>

#include "bench/specular_lab.hpp"
#include "bench/specular_sweep.hpp"
#include "reference/image_compare.hpp"
#include "shading/scene_file.hpp"

namespace nacre::bench {
namespace {

/// The worse value stays.
void raise(Bar& bar, double value, const std::string& where) {
    if (bar.measured && (bar.atLeast ? value >= bar.value : value <= bar.value)) return;
    bar.value = value;
    bar.worst = where;
    bar.measured = true;
}

SceneSwitches volumes(int lightDepth) {
    SceneSwitches out;
    out.shadowMethod = ShadowMethod::Volumes;
    out.specular.lightDepth = lightDepth;
    return out;
}

Image halved(const Image& fine) {
    Image out(fine.width() / 2, fine.height() / 2, 3);
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x)
            out.setRgb(x, y,
                       0.25 * (fine.rgb(2 * x, 2 * y) + fine.rgb(2 * x + 1, 2 * y) + fine.rgb(2 * x, 2 * y + 1) +
                               fine.rgb(2 * x + 1, 2 * y + 1)));
    return out;
}

/// Share of pixels that show what rays show: colours are plain.
double sameShare(const Image& drawn, const Image& traced) {
    int same = 0;
    for (int y = 0; y < drawn.height(); ++y)
        for (int x = 0; x < drawn.width(); ++x)
            same += maxComponent(glm::abs(drawn.rgb(x, y) - traced.rgb(x, y))) <= 2e-3;
    return same / double(drawn.width() * drawn.height());
}

class Bars {
public:
    explicit Bars(const SpecularSweepOptions& options) : options_(options) {}

    std::vector<Bar> all() {
        light("lit-by-mirror", 1, true);
        light("stained-glass", 1, false);
        if (!options_.quick) light("bevelled-glass", 2, false);
        facing();
        frosted();
        std::vector<Bar> out{error_, seconds_, faster_, glass_, facing_, frosted_};
        for (const char* scene : {"lit-by-mirror", "cornell-box", "bathroom", "light-regions"})
            out.push_back(stored(scene));
        return out;
    }

private:
    SpecularLab open(const std::string& scene) const {
        report(options_.progress, "bars of specular views on " + scene, 0);
        return {*options_.loader, readScene(options_.scenes / (scene + ".json"))};
    }

    void light(const std::string& scene, int depth, bool timed) {
        SpecularLab lab = open(scene);
        const SceneSwitches on = volumes(depth);
        const Image drawn = lab.draw(on, options_.quick ? 128 : 1024);
        const double seconds = lab.frameSeconds(options_.quick ? 1 : 5);
        const Image traced = lab.trace(on, drawn.width()), truth = halved(traced);
        const double off = compareImages(halved(drawn), truth, pictureWhite(truth)).rmsOverMean;
        raise(timed ? error_ : glass_, off, fmt::format("{}, {:.2f} s a frame", scene, seconds));
        if (!timed) return;
        raise(seconds_, seconds, scene);
        raise(faster_, lab.traceSeconds() / seconds, fmt::format("{}, {:.2f} s", scene, lab.traceSeconds()));
    }
    void facing() {
        SpecularLab lab = open("facing-mirrors");
        SceneSwitches on;
        on.specular.depth = 8;
        const int size = options_.quick ? 64 : 512;
        const Image drawn = lab.draw(on, size, 4);
        raise(facing_, sameShare(drawn, lab.trace(on, size)), "facing-mirrors");
    }
    void frosted() {
        for (const double roughness : {0.1, 0.25}) {
            report(options_.progress, "bars of frosted glass", 0);
            SceneDescription scene = readScene(options_.scenes / "plates.json");
            for (SceneMaterial& m : scene.materials)
                if (m.specular) m.specular->roughness = roughness;
            SpecularLab lab(*options_.loader, std::move(scene));
            SceneSwitches on = volumes(0);
            on.specular.shears = 32;
            const int size = options_.quick ? 48 : 320;
            const Image drawn = lab.draw(on, size), traced = lab.trace(on, size, options_.quick ? 64 : 512);
            raise(frosted_, compareImages(drawn, traced, pictureWhite(traced)).psnrSrgb,
                  fmt::format("plates, Beckmann's alpha {:g}", roughness));
        }
    }
    Bar stored(const std::string& scene) const {
        SpecularLab lab = open(scene);
        lab.draw(volumes(0), 16);
        const ShadowVolumeCounts counts = lab.renderer().shadowVolumes();
        Bar out{"stored shadow volumes, " + scene, "times less than one a polygon", 8, 0, true};
        raise(out, static_cast<double>(counts.bytesAPolygon) / static_cast<double>(counts.bytes),
              fmt::format("{:.1f} kB", static_cast<double>(counts.bytes) / 1e3));
        return out;
    }

    const SpecularSweepOptions& options_;
    Bar error_{"direct and mirror light, 512², 2 x 2 samples", "RMS / mean", 0.02};
    Bar seconds_{"the same", "seconds a frame", 1.1};
    Bar faster_{"the same, our reference's time at equal samples", "times the frame's", 1, 0, true};
    Bar glass_{"light through stained and bevelled glass, the same", "RMS / mean", 0.02};
    Bar facing_{"two mirrors, depth 8, 4 samples", "share of pixels as traced", 0.999, 0, true};
    Bar frosted_{"frosted glass, 32 samples", "PSNR [dB]", 32, 0, true};
};

}  // namespace

std::vector<Bar> measureSpecularBars(const SpecularSweepOptions& options) {
    if (!options.loader) return {};
    return Bars(options).all();
}

}  // namespace nacre::bench
