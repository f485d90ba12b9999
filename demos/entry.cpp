#include "demos/entry.hpp"

#include <fmt/format.h>

#include <chrono>

#include "demos/picture.hpp"
#include "reference/factored_metrics.hpp"
#include "reference/image_compare.hpp"
#include "reference/raytrace.hpp"
#include "shading/lit_pass.hpp"
#include "shading/timing.hpp"

namespace nacre {
namespace {

/// Of white: the backdrop's grey.
constexpr double kBackdrop = 0.11;
/// Share of pixels that may lie beyond the end of the difference's colour scale.
constexpr double kBeyondScale = 0.001;

struct PictureSize {
    int width, height;  ///< [pixels]
};

/// About size² pixels of the given shape.
PictureSize pictureSize(double aspect, int size) {
    return {static_cast<int>(std::lround(size * std::sqrt(aspect))),
            static_cast<int>(std::lround(size / std::sqrt(aspect)))};
}

std::string texturesText(const FactoredBrdf& brdf) {
    std::string text;
    for (const AssetTexture& t : brdf.textures) {
        const std::string one =
            fmt::format("{} × {} × {} {}", t.image.width(), t.image.height(), t.image.channels(), toString(t.format));
        text += text.empty() ? one : ", " + one;
    }
    return text;
}

double secondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Bakes, writes ID.exr, reads it back, and measures what was read: the file is what the pictures show.
Baked bakeAndMeasure(const Recipe& recipe, const Reflectance& truth, const EntryOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    const FactoredBrdf made = factorize(truth, recipe.bake);
    Baked baked;
    baked.facts.bakeSeconds = secondsSince(start);
    const std::filesystem::path file = options.folder / (recipe.id + ".exr");
    Asset asset = toAsset(made);
    asset.meta["command"] = bakeCommand(recipe);
    asset.meta["source"] = truth.source;
    writeAsset(asset, file);
    baked.brdf = factoredFromAsset(readAsset(file), file.string());
    AssetFacts& f = baked.facts;
    f.source = truth.source;
    f.method = made.method;
    f.form = toString(made.form);
    f.textures = texturesText(made);
    f.bytes = made.bytes();
    f.fetches = made.fetches;
    f.error = measureBrdf(functionOf(baked.brdf), truth.f,
                          {.samples = options.samples, .isotropic = truth.isotropic, .truthEnergy = truth.energy});
    return baked;
}

struct Way {
    std::string name, label;
    Addressing addressing;
};

std::vector<Way> waysOf(const Recipe& recipe) {
    std::vector<Way> ways = {{"pixel", "per pixel", Addressing::PerPixel}};
    if (recipe.allAddressings) {
        ways.push_back({"vertex", "per vertex (fast Phong)", Addressing::PerVertex});
        ways.push_back({"matrix", "texture matrices", Addressing::TextureMatrix});
    }
    return ways;
}

/// Radiance (premultiplied by coverage) and coverage, 2 × 2 samples a pixel.
struct Rendered {
    Image radiance, coverage;
};

Rendered drawTwiceAsLarge(const PictureSize& size, const std::function<void(const RenderTarget&)>& draw) {
    RenderTargetOptions options;
    options.width = 2 * size.width;
    options.height = 2 * size.height;
    const RenderTarget target(options);
    target.clear(glm::vec4(0));
    draw(target);
    const Image rgba = halved(target.read(4));
    return {rgba, channelOf(rgba, 3)};
}

RaytracedPicture traceReference(const Stage& stage, const Reflectance& truth, const PictureSize& size) {
    RaytraceOptions options;
    options.width = size.width;
    options.height = size.height;
    options.supersample = 2;
    return raytrace(stage.mesh, stage.camera, stage.lights, truth.f, options);
}

/// Everything an entry's drawing needs at hand.
struct Scene {
    const Recipe& recipe;
    const Stage& stage;
    ProgramLoader& loader;
    const EntryOptions& options;
    const PictureSize& size;
    const GpuMesh& mesh;
    const LitView& view;
    GpuFactoredBrdf factored;
    std::optional<GpuDirectBrdf> direct;
};

void addShots(Entry& entry, const Scene& scene, const RaytracedPicture& reference) {
    const double white =
        scene.recipe.white > 0 ? scene.recipe.white : pictureWhite(reference.radiance, reference.coverage);
    const double background = kBackdrop * white;
    std::vector<Rendered> drawn;
    double scale = 0;
    for (const Way& way : waysOf(scene.recipe)) {
        drawn.push_back(drawTwiceAsLarge(scene.size, [&](const RenderTarget& target) {
            renderFactored(scene.loader, target, scene.mesh, scene.view, scene.factored, way.addressing);
        }));
        scale = std::max(scale, differenceQuantile(drawn.back().radiance, reference.radiance, white, reference.coverage,
                                                   kBeyondScale));
    }
    entry.differenceScale = roundUpScale(std::max(scale, 1e-3));  // below a quarter of an 8-bit step nothing shows
    entry.reference =
        encodePicture(entry.id + "-reference.png", over(reference.radiance, reference.coverage, background), white);
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        const Way way = waysOf(scene.recipe)[i];
        const ImageDifference d = compareImages(drawn[i].radiance, reference.radiance, white, reference.coverage);
        Shot shot;
        shot.label = way.label;
        shot.psnr = d.psnrSrgb;
        shot.relativeError = d.relative;
        const std::string stem = entry.id + "-" + way.name;
        shot.picture = encodePicture(stem + ".png", over(drawn[i].radiance, drawn[i].coverage, background), white);
        shot.difference = encodePicture(
            stem + "-difference.png",
            differenceImage(drawn[i].radiance, reference.radiance, white, entry.differenceScale, reference.coverage),
            1);
        entry.shots.push_back(std::move(shot));
    }
}

/// Of the frames as drawn for the pictures: 2 × 2 samples a pixel.
void addTimes(Entry& entry, const Scene& scene) {
    RenderTargetOptions targetOptions;
    targetOptions.width = 2 * scene.size.width;
    targetOptions.height = 2 * scene.size.height;
    const RenderTarget target(targetOptions);
    std::vector<std::function<void()>> frames;
    for (const Way& way : waysOf(scene.recipe))
        frames.push_back([&, addressing = way.addressing] {
            target.clear();
            renderFactored(scene.loader, target, scene.mesh, scene.view, scene.factored, addressing);
        });
    const LitView unlit{scene.view.camera, {}, Rgb(0)};
    const GpuDirectBrdf lambert = *directBrdf(openReflectance("lambert"));
    frames.push_back([&] {
        target.clear();
        renderDirect(scene.loader, target, scene.mesh, unlit, lambert);
    });
    if (scene.direct)
        frames.push_back([&] {
            target.clear();
            renderDirect(scene.loader, target, scene.mesh, scene.view, *scene.direct);
        });
    TimingOptions timing;
    timing.repeats = scene.options.timingRepeats;
    const std::vector<double> seconds = medianFrameSeconds(frames, timing);
    for (std::size_t i = 0; i < entry.shots.size(); ++i) entry.shots[i].milliseconds = 1000 * seconds[i];
    entry.geometryMilliseconds = 1000 * seconds[entry.shots.size()];
    if (scene.direct) entry.directMilliseconds = 1000 * seconds.back();
}

}  // namespace

Entry makeEntry(const Recipe& recipe, const Stage& stage, ProgramLoader& loader, BakedCache& cache,
                const EntryOptions& options) {
    Entry entry;
    entry.id = recipe.id;
    entry.section = recipe.section;
    entry.title = recipe.title;
    entry.caption = recipe.caption;
    entry.command = bakeCommand(recipe);
    const PictureSize size = pictureSize(stage.aspect, options.size);
    entry.scene = fmt::format("{}; {} × {} pixels, 2 × 2 samples each.", stage.words, size.width, size.height);
    report(options.progress, recipe.id + ": bake", 0);
    const Reflectance truth = openReflectance(recipe.source);
    Recipe unnamed = recipe;
    unnamed.id.clear();
    const auto found = cache.find(bakeCommand(unnamed));
    const Baked& baked =
        found != cache.end()
            ? found->second
            : cache.emplace(bakeCommand(unnamed), bakeAndMeasure(recipe, truth, options)).first->second;
    entry.asset = baked.facts;
    report(options.progress, recipe.id + ": ray trace", 0.4);
    const RaytracedPicture reference = traceReference(stage, truth, size);
    report(options.progress, recipe.id + ": draw", 0.7);
    const GpuMesh mesh(stage.mesh);
    const LitView view{stage.camera, stage.lights, Rgb(0)};
    const Scene scene{recipe, stage, loader, options, size, mesh, view, GpuFactoredBrdf(baked.brdf), directBrdf(truth)};
    entry.directLabel = scene.direct ? truth.source.substr(0, truth.source.find(':')) + " in the same shader, per pixel"
                                     : "No time of a direct evaluation: this reflectance is a table, not a formula.";
    addShots(entry, scene, reference);
    report(options.progress, recipe.id + ": time", 0.8);
    addTimes(entry, scene);
    return entry;
}

}  // namespace nacre
