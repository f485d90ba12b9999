// Multi-pass rendering: hard and soft shadows by volumes, Phong fitted to Ward, light between surfaces (MPR
// sections 4.1, 4.4, 5 and 6).
#include <fmt/format.h>

#include "demos/curve_picture.hpp"
#include "demos/exhibit_task.hpp"
#include "factorize/models/models.hpp"
#include "factorize/ward_phong.hpp"
#include "reference/albedo.hpp"
#include "reference/image_compare.hpp"
#include "reference/raytrace.hpp"
#include "reference/scene_rays.hpp"
#include "reference/scene_trace.hpp"
#include "shading/multipass/radiosity.hpp"
#include "shading/primitives.hpp"
#include "shading/scene_file.hpp"
#include "shading/scene_renderer.hpp"

namespace nacre {
namespace {

Image everywhere(int width, int height) {
    Image out(width, height, 1);
    for (float& v : out.data()) v = 1;
    return out;
}

/// A scene's renderer and its truths, drawn as panels: without light that faces send on (light_path_exhibits.cpp).
class ScenePanels {
public:
    ScenePanels(const Task& task, SceneDescription scene, int width, int height)
        : builder(task.loader, task.id, task.builder()),
          renderer_(task.loader, std::move(scene)),
          width_(width),
          height_(height) {}

    Image truth(const SceneParts& parts, int lightPoints) const {
        SceneTraceOptions options{.width = width_, .height = height_, .supersample = kSupersample};
        options.lightPoints = lightPoints;
        options.interreflectionPaths = 24;
        options.lightDepth = 0;
        const SceneDescription& scene = renderer_.scene();
        return traceScene(scene, scene.camera, openTruths(scene), {parts}, options).front();
    }
    /// \param before  edits the renderer; may be empty
    void panel(const std::string& label, const SceneSwitches& on, const Image& truth,
               std::function<void(SceneRenderer&)> before = {}) {
        builder.panel(label,
                      [this, on, before](const RenderTarget& target) {
                          if (before) before(renderer_);
                          renderer_.switches = on;
                          renderer_.switches.specular.lightDepth = 0;
                          renderer_.render(target);
                      },
                      {truth, everywhere(width_, height_)});
    }
    ShadowVolumeCounts counts(const SceneSwitches& on) {
        const RenderTarget target({.width = 16, .height = 16});
        renderer_.switches = on;
        renderer_.switches.specular.lightDepth = 0;
        renderer_.render(target);
        return renderer_.shadowVolumes();
    }
    SceneRenderer& renderer() { return renderer_; }

    ExhibitBuilder builder;

private:
    SceneRenderer renderer_;
    int width_, height_;
};

SceneSwitches volumes(SoftShadows soft = SoftShadows::Regenerated, int points = 16) {
    SceneSwitches out;
    out.shadowMethod = ShadowMethod::Volumes;
    out.softShadows = soft;
    out.lightPoints = points;
    return out;
}

std::string kilobytes(std::size_t bytes) { return fmt::format("{:.0f} kB", static_cast<double>(bytes) / 1e3); }

Exhibit hardShadows(const Task& task) {
    SceneDescription scene = readScene(task.options.sceneFolder / "soft.json");
    for (SceneLight& light : scene.lights) light.area.reset();
    ScenePanels panels(task, std::move(scene), task.size(400), task.size(300));
    const Image truth = panels.truth({}, 1);
    panels.builder.row("Against rays");
    panels.panel("shadow volumes", volumes(), truth);
    panels.builder.row("The same with a shadow map of 1024 texels a face, filtered", false);
    panels.panel("shadow map", {}, truth);
    const ShadowVolumeCounts counts = panels.counts(volumes());
    Exhibit e;
    e.section = "Multi-pass rendering";
    e.title = "Hard shadows by volumes";
    e.caption = fmt::format(
        "The light is added where no shadow volume contains the visible point, counted in the stencil buffer (MPR "
        "section 4.1): exact to the sample, where a map has texels and a filter. Volumes are silhouettes and caps, "
        "stored with each object as {}; one volume a polygon would take {:.1f} times as much.",
        kilobytes(counts.bytes), static_cast<double>(counts.bytesAPolygon) / static_cast<double>(counts.bytes));
    e.scene = "demos/scenes/soft.json with its lamp as a point.";
    panels.builder.finish(e);
    return e;
}

Exhibit softShadowsExhibit(const Task& task) {
    ScenePanels panels(task, readScene(task.options.sceneFolder / "soft.json"), task.size(400), task.size(300));
    const Image truth = panels.truth({}, 64);
    Exhibit e;
    e.table.head = {"way", "points", "volumes stored", "bytes"};
    const auto add = [&](const char* way, SoftShadows soft, int points) {
        panels.panel(fmt::format("{}, {} points", way, points), volumes(soft, points), truth);
        if (points < SceneSwitches().lightPoints) panels.builder.forComparison();
        const ShadowVolumeCounts c = panels.counts(volumes(soft, points));
        e.table.rows.push_back({way, std::to_string(points), std::to_string(c.made + c.kept), kilobytes(c.bytes)});
    };
    panels.builder.row("Volumes made for each point of the lamp");
    for (const int points : {4, 16, 63}) add("regenerated", SoftShadows::Regenerated, points);
    panels.builder.row("MPR's approximation: the middle's silhouettes are the pivots of each point's volumes");
    for (const int points : {4, 16, 63}) add("pivot", SoftShadows::Pivot, points);
    panels.builder.row("PR94's darkness levels: all points counted at once, the middle's light dimmed by the count");
    for (const int points : {4, 16, 63}) add("levels", SoftShadows::Levels, points);
    e.section = "Multi-pass rendering";
    e.title = "Soft shadows: points of an area, their pivots, and levels of darkness";
    e.caption =
        "A square lamp as points, whose light is added in floating point (MPR section 4.4). With the pivot "
        "approximation one volume is stored for all of them; it errs where the silhouette seen from a point is another "
        "than that seen from the middle. Levels shade each pixel once, and err where volumes of one point overlap: "
        "under a torus seen through its hole.";
    e.scene = "demos/scenes/soft.json; truth with 64 points of the lamp for each of 2 × 2 rays.";
    e.commands = {"nacre render demos/scenes/soft.json -o soft.png --shadows volumes --soft pivot --reference"};
    panels.builder.finish(e);
    return e;
}

std::vector<Rgb> albedosOf(const SceneDescription& scene) {
    std::vector<Rgb> out;
    for (const MaterialTruth& m : openTruths(scene).materials)
        out.push_back(m.brdf ? directionalAlbedo(m.brdf, {std::sqrt(0.5), 0, std::sqrt(0.5)}) : Rgb(0));
    return out;
}

Exhibit radiosity(const Task& task) {
    ScenePanels panels(task, readScene(task.options.sceneFolder / "cornell-box.json"), task.size(200), task.size(200));
    SceneParts all, direct;
    all.interreflection = true;
    report(task.options.progress, task.id + ": reference", 0);
    const Image truth = panels.truth(all, 4), first = panels.truth(direct, 16);
    const SceneDescription& scene = panels.renderer().scene();
    const SceneRays rays(scene, nodeTransforms(scene, 0));
    const IndirectLight light = sceneIndirectLight(scene, 0, albedosOf(scene), [&](const Vec3& a, const Vec3& b) {
        return !rays.shadowed(a, glm::normalize(b - a), glm::length(b - a));
    });
    const auto with = [&light](SceneRenderer& r) { r.setIndirectLight(light.radiance); };
    const auto without = [&light](SceneRenderer& r) {
        r.setIndirectLight(std::vector<std::vector<glm::vec3>>(light.radiance.size()));
    };
    panels.builder.row("All light");
    panels.panel("direct light and radiosity without its first bounce", volumes(), truth, with);
    panels.builder.row("Direct light alone, against all light and against itself", false);
    panels.panel("direct", volumes(), truth, without);
    panels.panel("direct, truth without light between surfaces", volumes(), first, without);
    SceneSwitches dark = volumes();
    dark.lamps = false;
    panels.builder.row("What the vertices bring", false);
    panels.panel("radiosity alone, beside all light", dark, truth, with);
    Exhibit e;
    e.section = "Multi-pass rendering";
    e.title = "Light between surfaces, as vertex colours of the ambient pass";
    e.caption = fmt::format(
        "A progressive radiosity whose first bounce is dropped, since the lamps' passes bring it with their shadows "
        "(MPR section 6, figure 14): {} shots leave {:.1f} % of the power unshot. The truth follows paths of up to "
        "eight bounces.",
        light.shots, 100 * light.left);
    e.scene = "demos/scenes/cornell-box.json; square lamp of 16 points.";
    e.commands = {"nacre render demos/scenes/cornell-box.json -o box.png --shadows volumes --radiosity --reference"};
    panels.builder.finish(e);
    return e;
}

Vec3 inPlane(double theta) { return {std::sin(theta), 0, std::cos(theta)}; }

/// MPR figure 13: both terms over the outgoing angle for some incident ones.
Image curvesOf(double alpha, const CosinePower& p, int size) {
    std::vector<Curve> curves;
    const Rgb colors[] = {Rgb(1, 0.2, 0.1), Rgb(0.2, 0.9, 0.2), Rgb(0.2, 0.5, 1), Rgb(1, 0.8, 0.1)};
    for (int k = 0; k < 4; ++k) {
        Curve ward{{}, {}, colors[k]}, power{{}, {}, colors[k], true};
        const Vec3 wi = inPlane(-(0.1 + 0.35 * k));
        for (int i = 0; i <= 200; ++i) {
            const double theta = -1.4 + 2.8 * i / 200;
            ward.x.push_back(theta), ward.y.push_back(wardSpecular(wi, inPlane(theta), alpha));
            power.x.push_back(theta), power.y.push_back(p(wi, inPlane(theta)));
        }
        curves.push_back(std::move(ward)), curves.push_back(std::move(power));
    }
    return curvePicture(curves, size);
}

/// Errors over alpha, or over the incident angle at one alpha: ours and, dashed, the paper's.
Image errorsOver(bool angle, int size) {
    Curve ours{{}, {}, Rgb(0.2, 0.9, 0.2)}, paper{{}, {}, Rgb(1, 0.2, 0.1), true};
    for (int i = 0; i <= 16; ++i) {
        const double alpha = angle ? 0.13 : 0.03 * std::pow(10.0, i / 16.0), theta = 1.3 * i / 16;
        const CosinePower p = fitCosinePower(alpha), q = paperCosinePower(alpha);
        ours.x.push_back(angle ? theta : std::log(alpha)), paper.x.push_back(ours.x.back());
        ours.y.push_back(angle ? cosinePowerErrorAt(p, alpha, theta) : cosinePowerError(p, alpha));
        paper.y.push_back(angle ? cosinePowerErrorAt(q, alpha, theta) : cosinePowerError(q, alpha));
    }
    return curvePicture({ours, paper}, size);
}

BrdfFunction asBrdf(const WardMeasured& m, const CosinePower& p) {
    return [m, p](const Vec3& wi, const Vec3& wo) {
        return wi.z > 0 && wo.z > 0 ? Rgb(m.diffuse / kPi + m.specular * p(wi, wo) / wi.z) : Rgb(0);
    };
}

Exhibit phongForWard(const Task& task) {
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    const int size = task.size(240);
    builder.row(
        "Ward (full lines) and our cosine power (dashed) over the outgoing angle; one colour an incident angle");
    for (const double alpha : {0.071, 0.13, 0.3})
        builder.picture(fmt::format("alpha {}", alpha), curvesOf(alpha, fitCosinePower(alpha), size));
    builder.row("Relative error of our fit (green) and of the paper's (red, dashed)");
    builder.picture("over alpha, 0.03 to 0.3, logarithmic", errorsOver(false, size));
    builder.picture("over the incident angle, 0 to 1.3, alpha 0.13", errorsOver(true, size));
    Camera camera;
    camera.eye = {0, 0, 4};
    camera.fovY = 0.56;
    const std::vector<Light> lights{{true, glm::normalize(Vec3(1, 1, 1)), Rgb(1.2), {}},
                                    {true, glm::normalize(Vec3(-1, 0.3, -0.4)), Rgb(0.8), {}}};
    const Mesh ball = makeSphere(1, 96, 48);
    Exhibit e;
    e.table.head = {
        "material (Ward 1992)", "diffuse",          "specular",  "alpha",         "our scale", "our exponent",
        "paper's scale",        "paper's exponent", "our error", "paper's error", "PSNR ours", "PSNR paper"};
    for (const WardMeasured& m : kWardMeasured) {
        const CosinePower ours = fitCosinePower(m.alpha), paper = paperCosinePower(m.alpha);
        const auto picture = [&](const BrdfFunction& f) {
            return raytrace(ball, camera, lights, f, {.width = size, .height = size, .supersample = 2}).radiance;
        };
        const Image truth =
            picture(makeModel(fmt::format("ward:alpha={},ks={},kd={}", m.alpha, m.specular, m.diffuse)).f);
        const Image a = picture(asBrdf(m, ours)), b = picture(asBrdf(m, paper));
        const double white = pictureWhite(truth);
        const auto decibels = [&](const Image& image) {
            return fmt::format("{:.1f} dB", compareImages(image, truth, white).psnrSrgb);
        };
        builder.row(fmt::format("{}: Ward, our power, the paper's", m.name));
        builder.picture("Ward", truth);
        builder.picture("ours, " + decibels(a), a);
        builder.picture("paper's, " + decibels(b), b);
        const auto number = [](double v) { return fmt::format("{:.4g}", v); };
        e.table.rows.push_back({m.name, number(m.diffuse), number(m.specular), number(m.alpha), number(ours.scale),
                                number(ours.exponent), number(paper.scale), number(paper.exponent),
                                number(cosinePowerError(ours, m.alpha)), number(cosinePowerError(paper, m.alpha)),
                                decibels(a), decibels(b)});
    }
    e.section = "Multi-pass rendering";
    e.title = "A cosine power fitted to Ward's Gaussian";
    e.caption =
        "MPR section 5, figures 12 and 13: what fixed shading hardware can do for Ward's measured materials. The "
        "paper's fit, .0398 n cos^n with n = 1.999/alpha², is the limit of perpendicular light; ours is the least "
        "squares over all pairs of directions up to 80°. Neither follows the growth towards grazing light.";
    e.scene = "A ball under two directional lights, one of them grazing; traced.";
    builder.finish(e, 1);
    return e;
}

}  // namespace

const std::vector<NamedExhibit>& multipassExhibits() {
    static const std::vector<NamedExhibit> all = {{"hard-volumes", hardShadows},
                                                  {"soft-volumes", softShadowsExhibit},
                                                  {"phong-ward", phongForWard},
                                                  {"radiosity", radiosity}};
    return all;
}

}  // namespace nacre
