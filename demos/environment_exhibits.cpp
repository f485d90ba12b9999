#include <fmt/format.h>

#include "core/error.hpp"
#include "demos/exhibit_task.hpp"
#include "demos/orientation_chart.hpp"
#include "demos/recipe.hpp"
#include "envmaps/convert.hpp"
#include "envmaps/fresnel_table.hpp"
#include "envmaps/prefilter.hpp"
#include "reference/environment_error.hpp"

namespace nacre {
namespace {

constexpr const char* kFigure5 = "Environment maps (HSE figure 5)";

/// A cube's faces, three beside each other: the strip is too tall for a page.
Image inTwoRows(const EnvMap& cube) {
    const int n = cube.size();
    Image out(3 * n, 2 * n, 3);
    for (int face = 0; face < 6; ++face)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) out.setRgb(face % 3 * n + x, face / 3 * n + y, cube.image.rgb(x, face * n + y));
    return out;
}

Exhibit chart(const Task& task) {
    const Body sphere = nearSphereBody(task.size(320));
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    std::vector<EnvMap> maps;
    std::vector<GpuEnvironment> gpu;
    for (const EnvLayout layout :
         {EnvLayout::Cube, EnvLayout::DualParaboloid, EnvLayout::Octahedral, EnvLayout::LatLong})
        maps.push_back(orientationChartMap(layout, 256));
    for (const EnvMap& map : maps) gpu.emplace_back(map);
    builder.row("The maps as they are stored");
    for (const EnvMap& map : maps)
        if (map.layout == EnvLayout::Cube)
            builder.picture("cube: here in two rows, in the file one below the other", inTwoRows(map));
        else
            builder.picture(toString(map.layout), map.image);
    builder.row("A mirror ball seen from +z, the surrounding behind it");
    const std::vector<Rgb> truth = shadeSurrounded(sphere.traced, {.reflection = orientationChart}, orientationChart);
    for (std::size_t i = 0; i < maps.size(); ++i) {
        EnvironmentSurface surface;
        surface.reflection.map = &gpu[i];
        builder.panel(toString(maps[i].layout), sphere, surface, surface.reflection, truth);
    }
    Exhibit e;
    e.section = kFigure5;
    e.title = "Orientation: which way is which";
    e.caption =
        "The world is right-handed with y up. The cube's faces are stored +X −X +Y −Y +Z −Z, each as one sees it from "
        "inside (OpenEXR's orientation); the paraboloids show +z above and −z below; the octahedral map has +z in its "
        "middle; the latitude-longitude map has +z in its middle and +x to the left of it. The viewer stands at +z "
        "and looks along −z: behind the ball is −Z with +X to the right, in its middle the viewer's own side, +Z, "
        "mirrored, and +X still lies to the right. The reference evaluates the chart's formula for each ray.";
    e.scene = "A sphere without roughness or Fresnel; maps of size 256.";
    builder.finish(e, 1);
    return e;
}

Exhibit figure5(const Task& task) {
    constexpr int kMirrorSize = 512;  // texels half as wide as the source's: its lamps are single texels
    const Surrounding s = task.open("interior");
    const EnvMap coarse = convertEnv(s.map, EnvLayout::Cube, task.size(32));
    const Body torus = torusBody(task.size(224));
    const Lobe diffuse{LobeKind::Diffuse};
    const std::vector<PrefilterLevel> level{{diffuse, 32}};
    const GpuEnvironment mirrorMap(convertEnv(s.map, EnvLayout::Cube, kMirrorSize)),
        diffuseMap(prefilter(coarse, level, {}).levels);
    const Rgb albedo(0.6, 0.32, 0.16);
    const EnvironmentTruth truth(coarse);
    report(task.options.progress, task.id + ": reference", 0);
    SurroundedSurface mirrorOnly, diffuseOnly;
    mirrorOnly.reflection = [&](const Vec3& d) { return sampleEnv(s.map, d); };
    diffuseOnly.diffuse = [&](const Vec3& n) { return albedo * truth(diffuse, n); };
    const std::vector<Rgb> mirror = shade(torus, mirrorOnly, s.map), below = shade(torus, diffuseOnly, s.map);

    ExhibitBuilder builder(task.loader, task.id, task.builder());
    std::vector<GpuEnvironmentTable> tables;
    const std::vector<double> indices{1.5, 5, 200};
    for (const double n : indices) tables.emplace_back(bakeFresnelTable({Rgb(n), Rgb(0)}, 128));
    struct Row {
        const char* title;
        bool diffuse, blend;
    };
    for (const Row& row : {Row{"F·Lm: the mirror's reflection, weighted by Fresnel's factor", false, false},
                           Row{"F·Lm + Ld: diffuse light added", true, false},
                           Row{"F·Lm + (1 − F)·Ld: a clear coat over a diffuse ground", true, true}}) {
        builder.row(row.title);
        for (std::size_t i = 0; i < indices.size(); ++i) {
            EnvironmentSurface surface;
            surface.reflection.map = &mirrorMap;
            if (row.diffuse) surface.diffuse = {&diffuseMap, 0, albedo};
            surface.table = &tables[i];
            surface.combine = row.blend ? EnvironmentCombine::Blend : EnvironmentCombine::Add;
            std::vector<Rgb> expected = mirror;
            for (std::size_t k = 0; k < expected.size(); ++k) {
                const SurfacePoint& p = torus.traced.points[k];
                if (!TracedSurface::hit(p)) continue;
                const Rgb f = fresnelExact({Rgb(indices[i]), Rgb(0)}, glm::dot(p.normal, p.toEye));
                const Rgb ground = row.diffuse ? below[k] : Rgb(0);
                expected[k] = row.blend ? blendReflection(f, mirror[k], ground) : addReflection(f, mirror[k], ground);
            }
            builder.panel(fmt::format("n = {}", indices[i]), torus, surface, {&mirrorMap}, expected);
        }
    }
    Exhibit e;
    e.section = kFigure5;
    e.title = "Mirror and diffuse terms, joined by Fresnel";
    e.caption =
        "At n = 1.5, about glass, only grazing views reflect; at n = 200, as in metals, all do, and the coat hides its "
        "ground. Three lookups a pixel: mirror map, irradiance map, Fresnel table. The reference takes Fresnel's exact "
        "formula, the mirror's radiance from the map as it came, and sums the cosine lobe over every texel for each "
        "point. The relative errors are those of lamps of a texel or two, far brighter than white.";
    e.scene = fmt::format(
        "Torus; {}; mirror cube of {}² faces, irradiance from {}² to 32² faces, Fresnel tables of 128 texels.", s.words,
        kMirrorSize, coarse.size());
    e.commands =
        envmapCommands(s, coarse.size(), {"irradiance.exr --lobe diffuse --layout cube --size 32 --format half"});
    if (!s.file.empty())
        e.commands.push_back(
            fmt::format("nacre envmap {} -o mirror.exr --convert --layout cube --size {} --format half",
                        shellQuoted(s.file), kMirrorSize));
    builder.finish(e);
    return e;
}

Exhibit phong(const Task& task) {
    const Surrounding s = task.open("interior");
    const EnvMap coarse = convertEnv(s.map, EnvLayout::Cube, task.size(32));
    const Lobe lobe{LobeKind::Phong, 100};
    const std::vector<PrefilterLevel> level{{lobe, 64}};
    const std::vector<EnvMap> filtered = prefilter(coarse, level, {}).levels;
    const GpuEnvironment map(filtered), sky(convertEnv(s.map, EnvLayout::Cube, 256));
    const GpuEnvironmentTable table(bakeFresnelTable({Rgb(1.5), Rgb(0)}, 128));
    const EnvironmentTruth truth(coarse);
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    builder.row("The surrounding, and the same filtered with roughness r = 0.01 (Phong exponent 1/r = 100)");
    builder.picture("as it came", convertEnv(s.map, EnvLayout::LatLong, 192).image);
    builder.picture("filtered: what a glossy surface reflects, by the mirrored direction",
                    convertEnv(filtered[0], EnvLayout::LatLong, 192).image);
    const Body sphere = sphereBody(task.size(160)), torus = torusBody(task.size(160));
    for (const bool transmits : {false, true}) {
        builder.row(transmits ? "Reflection and transmission of rough glass, n = 1.5: F·Lr + (1 − F)·Lt"
                              : "Reflection alone");
        for (const Body* body : {&sphere, &torus}) {
            report(task.options.progress, task.id + ": reference", 0);
            EnvironmentSurface surface;
            surface.reflection.map = &map;
            SurroundedSurface exact;
            exact.reflection = [&](const Vec3& d) { return truth(lobe, d); };
            if (transmits) {
                surface.transmission.map = &map;
                surface.table = &table;
                surface.combine = EnvironmentCombine::Blend;
                surface.ior = exact.ior = 1.5;
                exact.transmission = exact.reflection;
                exact.weight = [](double c) { return fresnelExact({Rgb(1.5), Rgb(0)}, c); };
                exact.blend = true;
            }
            builder.panel(body == &sphere ? "sphere" : "torus", *body, surface, {&sky}, shade(*body, exact, s.map));
        }
    }
    Exhibit e;
    e.section = kFigure5;
    e.title = "Glossy reflection and transmission from a prefiltered map";
    e.caption =
        "Every texel of the filtered map already holds the sum over the whole surrounding that equation 6 asks for: "
        "one "
        "lookup with the mirrored direction is a glossy reflection, one with the refracted direction a glossy "
        "transmission. The reference evaluates equation 6 for each point.";
    e.scene = fmt::format("Sphere and torus; {}; filtered from {}² to 64² faces.", s.words, coarse.size());
    e.commands = envmapCommands(s, coarse.size(),
                                {"glossy.exr --lobe phong --exponent 100 --layout cube --size 64 --format half"});
    builder.finish(e);
    return e;
}

}  // namespace

const std::vector<NamedExhibit>& environmentExhibits() {
    static const std::vector<NamedExhibit> list{{"env-chart", chart},    {"env-figure5", figure5},
                                                {"env-phong", phong},    {"env-ggx", ggxSweepExhibit},
                                                {"env-sun", sunExhibit}, {"env-lamps", lampsExhibit}};
    return list;
}

}  // namespace nacre
