// Light that bounces in a relief (HSE figure 13).
#include <fmt/format.h>

#include <memory>

#include "bump/bump_asset.hpp"
#include "demos/bump_parts.hpp"
#include "reference/relief_light.hpp"
#include "shading/gpu_direct_brdf.hpp"
#include "shading/gpu_relief_light.hpp"

namespace nacre {
namespace {

constexpr int kBounces = 3, kPaths = 100, kDirections = 256;

/// Half as many texels either way, the slopes the same.
HeightMap halved(const HeightMap& map) {
    HeightMap out{Image(std::max(1, map.width() / 2), std::max(1, map.height() / 2), 1), map.wrap};
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x)
            out.heights.at(x, y, 0) = (map.at(2 * x, 2 * y) + map.at(2 * x + 1, 2 * y) + map.at(2 * x, 2 * y + 1) +
                                       map.at(2 * x + 1, 2 * y + 1)) /
                                      8;
    return out;
}

/// What has bounced, traced at every texel.
Image tracedIndirect(const HeightMap& map, const Light& lamp, const Rgb& albedo, int paths) {
    std::vector<glm::ivec2> texels;
    for (int y = 0; y < map.height(); ++y)
        for (int x = 0; x < map.width(); ++x) texels.emplace_back(x, y);
    ReliefLightOptions options;
    options.light = lamp.position;
    options.irradiance = lamp.color;
    options.albedo = [albedo](const Vec2&) { return albedo; };
    options.bounces = kBounces;
    options.paths = paths;
    const std::vector<TexelLight> light = traceReliefLight(map, texels, options);
    Image out(map.width(), map.height(), 3);
    for (std::size_t i = 0; i < light.size(); ++i) out.setRgb(texels[i].x, texels[i].y, light[i].indirect);
    return out;
}

}  // namespace

Exhibit indirectExhibit(const Task& task) {
    const ReliefSource source = task.openHeights("rockwall_height", kReliefRise);
    const HeightMap relief = halved(source.map);
    const GpuBump map(bumpMapsOf(relief));
    const ScatterMap scatter = makeScatterMap(relief, {.directions = kDirections});
    const Body plane = planeBody(task.size(288));
    const Light lamp = lampFromDeg(150, 30);
    const LitView view{plane.camera, {lamp}, Rgb(0)};
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    std::vector<std::unique_ptr<GpuReliefLight>> bounced;  // textures that panels draw with until the end
    for (const Rgb& albedo : {Rgb(0.7), Rgb(0.9, 0.55, 0.3)}) {
        const bool grey = albedo.r == albedo.g;
        const GpuDirectBrdf brdf =
            *directBrdf(openReflectance(fmt::format("lambert:kd={}/{}/{}", albedo.r, albedo.g, albedo.b)));
        bounced.push_back(std::make_unique<GpuReliefLight>(
            task.loader, relief, scatter,
            GpuReliefLightOptions{.albedo = albedo, .bounces = kBounces, .paths = kPaths}));
        bounced.back()->update({.light = lamp.position});
        report(task.options.progress, task.id + ": tracing paths", 0);
        const Image traced = tracedIndirect(relief, lamp, albedo, task.options.quick ? 32 : 256);
        const std::function<Rgb(const Vec2&)> extra = bilinearAlbedo(traced, Wrap::Repeat);
        const std::vector<Rgb> truth = shadeRelief(plane.traced, relief,
                                                   {.lights = view.lights,
                                                    .brdf = [albedo](const Vec3&, const Vec3&) { return albedo / kPi; },
                                                    .extra = extra});
        builder.row(grey ? "Albedo 0.7" : "Sandstone, albedo (0.9, 0.55, 0.3)");
        for (const bool bounces : {false, true}) {
            BumpSurface surface{.map = &map, .shadow = BumpShadow::Ellipse};
            if (bounces) surface.indirect = bounced.back()->scattered();
            builder.panel(
                bounces ? "direct light and three bounces" : "direct light alone", plane,
                [&, view, surface, brdf](const RenderTarget& target) {
                    renderDirect(task.loader, target, plane.gpu, view, brdf, surface);
                },
                {}, truth);
            if (!bounces) builder.forComparison();
        }
    }
    Exhibit e;
    e.section = "Bump maps that light themselves (HSE figure 13)";
    e.title = "Light that bounces between the stones";
    e.caption =
        "Each texel knows what it sees in a set of directions (scatter maps), so light can be passed on over the whole "
        "relief at once: bump-map it, look that picture up at the points seen, bump-map again. The result is a texture "
        "for one light. The reference traces paths over the relief's own surface.";
    e.scene = fmt::format("Square seen from above; {}, halved to {} × {}; {} directions, {} paths, {} bounces.",
                          source.words, relief.width(), relief.height(), kDirections, kPaths, kBounces);
    if (!source.file.empty())
        e.commands = {fmt::format("nacre bump {} -o bounced.exr --scale {:g} --indirect --light {:.4f},{:.4f},{:.4f}",
                                  source.file, kReliefRise, lamp.position.x, lamp.position.y, lamp.position.z)};
    builder.finish(e, 1);
    return e;
}

}  // namespace nacre
