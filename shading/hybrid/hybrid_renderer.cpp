#include "shading/hybrid/hybrid_renderer.hpp"

#include <epoxy/gl.h>

#include <limits>
#include <memory>

#include "core/error.hpp"
#include "core/light_area.hpp"

namespace nacre {

SceneDescription withoutSpecular(SceneDescription scene) {
    for (SceneMaterial& material : scene.materials) {
        if (!material.specular) continue;
        SceneMaterial black;
        black.name = material.name;
        material = black;
    }
    return scene;
}

double clampedShare(const Image& indirect) {
    require(indirect.channels() == 4, "clampedShare: expected four channels");
    double kept = 0, clamped = 0;
    for (int y = 0; y < indirect.height(); ++y)
        for (int x = 0; x < indirect.width(); ++x) {
            kept += luminance(indirect.rgb(x, y));
            clamped += indirect.at(x, y, 3);
        }
    return clamped > 0 ? clamped / (clamped + kept) : 0;
}

HybridRenderer::HybridRenderer(ProgramLoader& loader, SceneDescription scene, HybridMaterials materials)
    : loader_(loader),
      scene_(std::move(scene)),
      materials_(std::move(materials)),
      direct_(loader, withoutSpecular(scene_)),
      sampled_(loader, scene_) {
    const std::size_t count = scene_.materials.size();
    require(materials_.albedos.size() == count && materials_.brdfs.size() == count,
            "hybrid: expected an albedo and a BRDF for each material");
    for (std::size_t i = 0; i < count; ++i)
        if (scene_.materials[i].specular) materials_.albedos[i] = Rgb(0);
    direct_.setTiming(true);
}

static double secondsSince(PipeClock::time_point start) {
    return std::chrono::duration<double>(PipeClock::now() - start).count();
}

void HybridRenderer::stage(const char* name, const std::function<void()>& work) {
    glFinish();
    const auto start = PipeClock::now();
    work();
    glFinish();
    report_.stages.push_back({name, secondsSince(start), std::numeric_limits<double>::quiet_NaN()});
}

void HybridRenderer::placeVirtualLights(const VirtualLightOptions& options, const std::vector<glm::dmat4>& nodes,
                                        PipeCrew* crew) {
    SceneElements elements;
    std::vector<ElementPower> sources;
    std::optional<GpuElements> gpu;
    const DrawShare share = crew ? crew->share() : DrawShare();
    stage("elements", [&] {
        elements = sceneElements(scene_, nodes, materials_.albedos, options.elements);
        gpu.emplace(elements);
    });
    stage("item buffers", [&] {
        sources = powerOfSources(loader_, *gpu, elements, scene_, nodes, options.power, share);
        if (crew) crew->gather(sources, elements.elements.size());
    });
    stage("choice", [&] {
        if (!crew || crew->leads())
            lights_ = chooseVirtualLights(elements, sumOfSources(sources, elements.elements.size()), options.count,
                                          options.choice);
        if (crew) crew->spread(lights_);
    });
    report_.elements = elements.elements.size();
    report_.lights = lights_.lights.size();
    report_.leftOut = lights_.leftOut;
}

void HybridRenderer::drawShadowMaps(const VirtualLightOptions& options, const std::vector<glm::dmat4>& nodes,
                                    std::span<const VirtualPointLight> lights) {
    shadows_.reset();
    if (!options.shadows || lights.empty()) return;
    stage("shadow maps", [&] {
        const SceneElements coarse =
            sceneElements(scene_, nodes, materials_.albedos, {options.shadowElements, options.elements.bits});
        shadows_.emplace(options.shadowSize).draw(loader_, GpuElements(coarse), coarse.bounds, lights);
    });
}

/// As direct() lights: by points of areas with shadow volumes, by their middle with maps.
TracedLight HybridRenderer::lightOfEnds(const HybridOptions& options, const std::vector<glm::dmat4>& nodes) const {
    TracedLight out;
    const SceneSwitches& on = direct_.switches;
    const std::vector<Light> lights = lightsInWorld(scene_, nodes);
    const auto areas = areasInWorld(scene_, nodes);
    for (std::size_t i = 0; on.lamps && i < lights.size(); ++i) {
        const bool shadow = on.shadows && scene_.lights[i].shadow;
        const bool points = areas[i] && shadow && on.shadowMethod != ShadowMethod::Maps;
        const int count = options.shadows ? options.shadows->points : on.lightPoints;
        for (const Light& lamp : points ? pointsOfArea(lights[i], *areas[i], count) : std::vector{lights[i]}) {
            out.lamps.push_back(lamp);
            out.shadowed.push_back(shadow);
        }
    }
    if (!options.virtualLights) return out;
    out.virtuals = lights_.lights;
    out.virtualShadows = options.virtualLights->shadows;
    out.near = options.virtualLights->near;
    return out;
}

static Image sum(const Image& a, const Image& b) {
    Image out = a;
    for (std::size_t i = 0; i < a.data().size(); ++i) out.data()[i] += b.data()[i];
    return out;
}

static Image withoutAlpha(const Image& image) {
    Image out(image.width(), image.height(), 3);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) out.setRgb(x, y, image.rgb(x, y));
    return out;
}

/// A frame while it is drawn, and what its end on the CPU needs.
struct HybridRenderer::Drawing {
    int width, height;
    HybridOptions options;
    double time;
    std::vector<glm::dmat4> nodes;
    GeometryBuffer* geometry = nullptr;
    std::vector<const RenderTarget*> targets{};  ///< direct, indirect
    std::vector<SeenPoint> seen{};
    std::optional<SpecularTracer> tracer{};
    std::future<std::vector<TracedEnd>> ends{};  ///< joins when it goes: before all that it needs
    VirtualLights lights{};
    TracedLight light{};
    HybridReport report{};
};

/// The share's part of the light, into the targets.
void HybridRenderer::drawLight(const Drawing& drawing, const DrawShare& share) {
    direct_.switches.share = share;
    stage("direct", [&] { direct_.render(*drawing.targets[0], drawing.time); });
    for (const PassTime& pass : direct_.passes())
        if (pass.name == "shadow volumes" || pass.name == "shadow maps" || pass.name == "light")
            report_.shadowSeconds += pass.wallSeconds;
    if (!drawing.options.virtualLights) return;
    std::vector<VirtualPointLight> lights;
    for (std::size_t i = 0; i < lights_.lights.size(); ++i)
        if (share.takes(i)) lights.push_back(lights_.lights[i]);
    drawShadowMaps(*drawing.options.virtualLights, drawing.nodes, lights);
    stage("virtual lights", [&] {
        drawing.targets[1]->clear();
        addVirtualLights(loader_, *drawing.targets[1], *drawing.geometry, lights, shadows_ ? &*shadows_ : nullptr,
                         drawing.options.virtualLights->near);
    });
}

std::function<CompositedFrame()> HybridRenderer::drawAll(Drawing& d, PipeCrew* crew) {
    const auto start = PipeClock::now();
    report_ = {};
    lights_ = {};
    GeometryBuffer geometry(d.width, d.height);
    d.geometry = &geometry;
    stage("geometry", [&] { geometry.draw(loader_, scene_, d.nodes, materials_.albedos, meshes_); });
    if (d.options.traced && (!crew || crew->leads())) {
        stage("tags", [&] { d.seen = geometry.read(); });
        d.tracer.emplace(scene_, d.nodes, materials_.brdfs);
        const int depth = direct_.switches.specular.depth;
        d.ends = std::async(std::launch::async, [&d, depth] { return d.tracer->follow(d.seen, d.width, depth); });
    }
    if (d.options.shadows && (!crew || crew->leads()))
        stage("shadows", [&] {
            direct_.switches.lightLevels = sampled_.draw(geometry, scene_.camera, d.nodes, *d.options.shadows);
            direct_.switches.shadowMethod = ShadowMethod::Levels;
        });
    report_.shadows = sampled_.choice();
    if (d.options.virtualLights) placeVirtualLights(*d.options.virtualLights, d.nodes, crew);
    const RenderTarget direct({.width = d.width, .height = d.height}),
        indirect({.width = d.width, .height = d.height, .depth = false});
    d.targets = {&direct};
    if (d.options.virtualLights) d.targets.push_back(&indirect);
    std::function<CompositedFrame()> out;
    bool again = false;
    do {
        drawLight(d, crew ? crew->share() : DrawShare());
        const double seconds = secondsSince(start);
        stage("composite", [&] {
            if (crew) {
                out = crew->composite(loader_, d.targets, seconds, again);
                return;
            }
            CompositedFrame frame;
            for (const RenderTarget* target : d.targets) frame.images.push_back(target->read(4));
            frame.drawSeconds = {seconds};
            out = [frame = std::move(frame)]() mutable { return std::move(frame); };
        });
    } while (again);
    if (d.options.traced && (!crew || crew->leads())) d.light = lightOfEnds(d.options, d.nodes);
    d.lights = lights_;
    d.light.virtuals = d.lights.lights;
    d.report = report_;
    d.targets.clear();
    return out;
}

/// On the CPU: nothing of OpenGL, and no member but of the drawing.
HybridFrame HybridRenderer::finish(Drawing& d, const CompositedFrame& composited) {
    const Image black(d.width, d.height, 3);
    HybridFrame out{{black, black, black, black}, std::move(d.report)};
    HybridPicture& picture = out.picture;
    out.report.pipes = composited.drawSeconds;
    picture.direct = withoutAlpha(composited.images.at(0));
    if (d.options.virtualLights) {
        out.report.clamped = clampedShare(composited.images.at(1));
        picture.indirect = withoutAlpha(composited.images[1]);
    }
    picture.blended = sum(picture.direct, picture.indirect);
    if (!d.options.traced) return out;
    const auto start = PipeClock::now();
    picture.traced = d.tracer->shade(d.ends.get(), d.seen, picture.blended, d.light, &out.report.traced);
    picture.blended = sum(picture.blended, picture.traced);
    out.report.stages.push_back({"traced", secondsSince(start), std::numeric_limits<double>::quiet_NaN()});
    return out;
}

HybridPicture HybridRenderer::draw(int width, int height, const HybridOptions& options, double time) {
    Drawing drawing{width, height, options, time, nodeTransforms(scene_, time)};
    HybridFrame frame = finish(drawing, drawAll(drawing, nullptr)());
    report_ = std::move(frame.report);
    return std::move(frame.picture);
}

std::future<HybridFrame> HybridRenderer::start(int width, int height, const HybridOptions& options, double time,
                                               PipeCrew& crew) {
    require(crew.leads(), "hybrid: expected the first pipe to start a frame");
    const auto drawing = std::make_shared<Drawing>(Drawing{width, height, options, time, nodeTransforms(scene_, time)});
    std::function<CompositedFrame()> composited = drawAll(*drawing, &crew);
    return std::async(std::launch::async, [drawing, composited = std::move(composited)] {
        const auto start = PipeClock::now();
        const CompositedFrame frame = composited();
        const double seconds = secondsSince(start);
        for (PassTime& stage : drawing->report.stages)
            if (stage.name == "composite") stage.wallSeconds += seconds;
        return finish(*drawing, frame);
    });
}

void HybridRenderer::drawShare(int width, int height, const HybridOptions& options, double time, PipeCrew& crew) {
    require(!crew.leads(), "hybrid: expected another than the first pipe");
    Drawing drawing{width, height, options, time, nodeTransforms(scene_, time)};
    drawAll(drawing, &crew);
}

}  // namespace nacre
