#include "shading/hybrid/hybrid_renderer.hpp"

#include <epoxy/gl.h>

#include <chrono>
#include <future>
#include <limits>

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
}

void HybridRenderer::stage(const char* name, const std::function<void()>& work) {
    glFinish();
    const auto start = std::chrono::steady_clock::now();
    work();
    glFinish();
    report_.stages.push_back({name, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
                              std::numeric_limits<double>::quiet_NaN()});
}

void HybridRenderer::placeVirtualLights(const VirtualLightOptions& options, const std::vector<glm::dmat4>& nodes) {
    SceneElements elements;
    std::vector<Rgb> power;
    std::optional<GpuElements> gpu;
    stage("elements", [&] {
        elements = sceneElements(scene_, nodes, materials_.albedos, options.elements);
        gpu.emplace(elements);
    });
    stage("item buffers", [&] { power = reflectedPower(loader_, *gpu, elements, scene_, nodes, options.power); });
    stage("choice", [&] { lights_ = chooseVirtualLights(elements, power, options.count, options.choice); });
    if (options.shadows && !lights_.lights.empty())
        stage("shadow maps", [&] {
            const SceneElements coarse =
                sceneElements(scene_, nodes, materials_.albedos, {options.shadowElements, options.elements.bits});
            shadows_.emplace(options.shadowSize).draw(loader_, GpuElements(coarse), coarse.bounds, lights_.lights);
        });
    report_.elements = elements.elements.size();
    report_.lights = lights_.lights.size();
    report_.leftOut = lights_.leftOut;
}

Image HybridRenderer::drawIndirect(const GeometryBuffer& geometry, const VirtualLightOptions& options) {
    const RenderTarget target({.width = geometry.width(), .height = geometry.height(), .depth = false});
    stage("virtual lights", [&] {
        target.clear();
        addVirtualLights(loader_, target, geometry, lights_.lights, shadows_ ? &*shadows_ : nullptr, options.near);
    });
    const Image light = target.read(4);
    report_.clamped = clampedShare(light);
    Image out(light.width(), light.height(), 3);
    for (int y = 0; y < light.height(); ++y)
        for (int x = 0; x < light.width(); ++x) out.setRgb(x, y, light.rgb(x, y));
    return out;
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

HybridPicture HybridRenderer::draw(int width, int height, const HybridOptions& options, double time) {
    const std::vector<glm::dmat4> nodes = nodeTransforms(scene_, time);
    const Image black(width, height, 3);
    HybridPicture out{black, black, black, black};
    report_ = {};
    lights_ = {};
    shadows_.reset();
    GeometryBuffer geometry(width, height);
    stage("geometry", [&] { geometry.draw(loader_, scene_, nodes, materials_.albedos, meshes_); });
    std::vector<SeenPoint> seen;
    std::optional<SpecularTracer> tracer;
    std::future<std::vector<TracedEnd>> ends;  // joins when it goes: after all it needs
    if (options.traced) {
        stage("tags", [&] { seen = geometry.read(); });
        tracer.emplace(scene_, nodes, materials_.brdfs);
        const int depth = direct_.switches.specular.depth;
        ends = std::async(std::launch::async,
                          [&tracer, &seen, width, depth] { return tracer->follow(seen, width, depth); });
    }
    if (options.shadows)
        stage("shadows", [&] {
            direct_.switches.lightLevels = sampled_.draw(geometry, scene_.camera, nodes, *options.shadows);
            direct_.switches.shadowMethod = ShadowMethod::Levels;
        });
    report_.shadows = sampled_.choice();
    const RenderTarget target({.width = width, .height = height});
    stage("direct", [&] { direct_.render(target, time); });
    out.direct = target.read();
    if (options.virtualLights) {
        placeVirtualLights(*options.virtualLights, nodes);
        out.indirect = drawIndirect(geometry, *options.virtualLights);
    }
    out.blended = sum(out.direct, out.indirect);
    if (options.traced) {
        stage("traced", [&] {
            out.traced = tracer->shade(ends.get(), seen, out.blended, lightOfEnds(options, nodes), &report_.traced);
        });
        out.blended = sum(out.blended, out.traced);
    }
    return out;
}

}  // namespace nacre
