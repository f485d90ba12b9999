// Bump maps: shadows by one ellipse a texel (HSE figure 9), a light that goes round, reliefs on curved objects.
#include <fmt/format.h>

#include "demos/bump_parts.hpp"
#include "demos/stage.hpp"
#include "factorize/factorize.hpp"
#include "shading/gpu_direct_brdf.hpp"
#include "shading/lit_pass.hpp"
#include "shading/primitives.hpp"

namespace nacre {

BumpMaps bumpMapsOf(const HeightMap& map) {
    BumpMaps out{map.width(), map.height(), map.wrap, {}, {}, {}, {}, {}, {}};
    out.normals = makeNormals(map);
    out.ellipses = fitEllipses(map);
    out.horizons = makeHorizonMap(map, 16);
    return out;
}

Body planeBody(int size) {
    Camera camera;
    camera.orthographic = true;
    camera.height = 2;
    return {makeQuad(2, 1), camera, size};
}

Light lampFromDeg(double azimuthDeg, double elevationDeg) {
    const double a = azimuthDeg * kPi / 180, e = elevationDeg * kPi / 180;
    return {true, {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)}, Rgb(kPi)};
}

namespace {

constexpr const char* kSection = "Bump maps that shadow themselves (HSE figure 9)";
constexpr double kAlbedo = 0.7;
constexpr const char* kLambert = "lambert:kd=0.7";

Rgb lambert(const Vec3&, const Vec3&) { return Rgb(kAlbedo / kPi); }

const char* words(BumpShadow shadow) {
    switch (shadow) {
        case BumpShadow::None:
            return "plain bump mapping";
        case BumpShadow::HardEllipse:
            return "ellipses, hard edge";
        case BumpShadow::Ellipse:
            return "ellipses, soft edge";
        case BumpShadow::HardHorizon:
            return "horizon map of 16 azimuths, hard edge";
        case BumpShadow::Horizon:
            return "horizon map of 16 azimuths, soft edge";
    }
    return "?";
}

std::vector<std::string> bumpCommands(const ReliefSource& source) {
    if (source.file.empty()) return {};
    return {fmt::format("nacre bump {} -o relief.exr --scale {:g} --normals --ellipses --horizon 16", source.file,
                        kReliefRise)};
}

/// A matt wall seen from above, in the light of one lamp. Must outlive the builders that its panels go to.
struct Wall {
    const Task& task;
    ReliefSource source = task.openHeights("rockwall_height", kReliefRise);
    GpuBump map{bumpMapsOf(source.map)};
    GpuDirectBrdf brdf = *directBrdf(openReflectance(kLambert));
    Body plane;

    Wall(const Task& forTask, int size) : task(forTask), plane(planeBody(task.size(size))) {}

    std::vector<Rgb> truth(const Light& lamp) const {
        return shadeRelief(plane.traced, source.map, {.lights = {lamp}, .brdf = lambert});
    }
    void panel(ExhibitBuilder& builder, const std::string& label, const Light& lamp, BumpShadow shadow,
               const std::vector<Rgb>& expected) const {
        const LitView view{plane.camera, {lamp}, Rgb(0)};
        const auto draw = [this, view, shadow](const RenderTarget& target) {
            renderDirect(task.loader, target, plane.gpu, view, brdf, BumpSurface{.map = &map, .shadow = shadow});
        };
        builder.panel(label, plane, draw, {}, expected);
    }
};

Exhibit shadows(const Task& task) {
    const Wall wall(task, 288);
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    for (const double elevation : {40.0, 15.0}) {
        const Light lamp = lampFromDeg(150, elevation);
        report(task.options.progress, task.id + ": reference", 0);
        const std::vector<Rgb> truth = wall.truth(lamp);
        builder.row(fmt::format("Light from the upper left, {} degrees above the plane", elevation));
        for (const BumpShadow shadow :
             {BumpShadow::None, BumpShadow::HardEllipse, BumpShadow::Ellipse, BumpShadow::Horizon}) {
            wall.panel(builder, words(shadow), lamp, shadow, truth);
            if (shadow == BumpShadow::None) builder.forComparison();
        }
    }
    Exhibit e;
    e.section = kSection;
    e.title = "A wall with and without the shadows of its bumps";
    e.caption =
        "Plain bump mapping turns the normals and no more, so low light reaches the bottom of every gap. An ellipse a "
        "texel, six numbers in two textures, says which directions see the sky; one test a light gives the shadows "
        "back. Where the sky a texel sees is no ellipse, some light is misjudged: the difference shows where. A "
        "horizon "
        "map costs 16 numbers a texel here. The reference follows a ray from each point over the relief's own surface.";
    e.scene =
        fmt::format("Square seen from above, u to the right and v upwards, albedo {}; {}.", kAlbedo, wall.source.words);
    e.commands = bumpCommands(wall.source);
    builder.finish(e, 1);
    return e;
}

Exhibit lightRound(const Task& task) {
    const Wall wall(task, 160);
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    for (int k = 0; k < 8; ++k) {
        if (k % 4 == 0)
            builder.row(k == 0 ? "Light 20 degrees above the plane, from the right (u) and on towards v" : "");
        const Light lamp = lampFromDeg(45 * k, 20);
        wall.panel(builder, fmt::format("azimuth {}°", 45 * k), lamp, BumpShadow::Ellipse, wall.truth(lamp));
    }
    Exhibit e;
    e.section = kSection;
    e.title = "A light going round the horizon";
    e.caption = "Frames of one turn, ellipses with a soft edge: shadows fall away from the light on every side.";
    e.scene = fmt::format("Square seen from above, albedo {}; {}.", kAlbedo, wall.source.words);
    e.commands = bumpCommands(wall.source);
    builder.finish(e, 1);
    return e;
}

Exhibit onObjects(const Task& task) {
    const ReliefSource source = task.openHeights("rockwall_height", kReliefRise);
    const GpuBump map(bumpMapsOf(source.map));
    const std::string copper =
        "torrance-sparrow:d=ggx,alpha=0.3,f=conductor,eta=0.27/0.95/1.17,k=3.4/2.58/2.4,ks=1,kd=0";
    const Reflectance metal = openReflectance(copper), stone = openReflectance(kLambert);
    const GpuFactoredBrdf factored(factorize(metal, {}));
    const GpuDirectBrdf matt = *directBrdf(stone);
    const Body torus = torusBody(task.size(288));
    const Vec2 tiles(6, 3);
    const LitView view{torus.camera, {{true, directionFromDeg(-50, 35), Rgb(kPi)}}, Rgb(0)};
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    for (const bool shiny : {false, true}) {
        builder.row(shiny ? "Copper, by a factored BRDF" : "Matt stone");
        ReliefShading exact{.lights = view.lights, .brdf = shiny ? metal.f : stone.f, .tiles = tiles};
        report(task.options.progress, task.id + ": reference", 0);
        const std::vector<Rgb> truth = shadeRelief(torus.traced, source.map, exact);
        for (const BumpShadow shadow : {BumpShadow::None, BumpShadow::Ellipse}) {
            const BumpSurface relief{.map = &map, .shadow = shadow, .tiles = tiles};
            builder.panel(
                words(shadow), torus,
                [&, shiny, relief](const RenderTarget& target) {
                    if (shiny) return renderFactored(task.loader, target, torus.gpu, view, factored, relief);
                    renderDirect(task.loader, target, torus.gpu, view, matt, relief);
                },
                {}, truth);
            if (shadow == BumpShadow::None) builder.forComparison();
        }
    }
    Exhibit e;
    e.section = kSection;
    e.title = "The same on a curved object";
    e.caption =
        "Tangent-space bump mapping: light and viewer are turned into each point's frame, where the ellipses are. The "
        "reference takes each point's relief for a plane, as the method does, and asks exact rays.";
    e.scene = fmt::format("Torus, {} × {} tiles; {}.", tiles.x, tiles.y, source.words);
    e.commands = bumpCommands(source);
    builder.finish(e);
    return e;
}

}  // namespace

const std::vector<NamedExhibit>& bumpExhibits() {
    static const std::vector<NamedExhibit> list{{"bump-shadows", shadows},
                                                {"bump-round", lightRound},
                                                {"bump-objects", onObjects},
                                                {"bump-indirect", indirectExhibit}};
    return list;
}

}  // namespace nacre
