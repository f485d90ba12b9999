// Roughness: the GGX sweep, the sun that other tools scatter, lamps and surrounding together.
#include <fmt/format.h>

#include "core/parallel.hpp"
#include "core/sampling.hpp"
#include "demos/exhibit_task.hpp"
#include "demos/stage.hpp"
#include "envmaps/convert.hpp"
#include "envmaps/fresnel_table.hpp"
#include "envmaps/level_mapping.hpp"
#include "envmaps/prefilter.hpp"
#include "factorize/factorize.hpp"
#include "reference/environment_error.hpp"

namespace nacre {
namespace {

constexpr const char* kSweeps = "Environment maps: roughness";

/// Levels of a GGX chain by perceptual roughness, and their sizes.
constexpr double kPerceptual[] = {0.2, 0.28, 0.38, 0.53, 0.73, 1.0};
constexpr int kFinest = 256;

struct Chain {
    std::vector<EnvMap> levels;
    LevelMapping mapping{"sqrt", "alpha", {}};
};

Chain ggxChain(const EnvMap& source) {
    Chain out;
    std::vector<PrefilterLevel> levels;
    for (std::size_t i = 0; i < std::size(kPerceptual); ++i) {
        const double alpha = sqr(kPerceptual[i]);
        levels.push_back({{LobeKind::Ggx, 0, alpha}, kFinest >> i});
        out.mapping.values.push_back(alpha);
    }
    out.levels = prefilter(source, levels, {}).levels;
    return out;
}

const FresnelIndex kGold{{0.18, 0.42, 1.37}, {3.42, 2.35, 1.77}};  // near 610, 550 and 465 nm, Johnson & Christy 1972

/// A GGX lobe by importance sampling: the same few Hammersley points for each texel, each looked up in the source as it
/// is. What many tools do; here to be compared with.
EnvMap sampledGgx(const EnvMap& source, double alpha, int size, int samples) {
    EnvMap out(EnvLayout::Cube, size);
    parallelFor(static_cast<std::size_t>(out.image.height()), 0, [&](std::size_t row) {
        for (int x = 0; x < size; ++x) {
            const Vec3 r = envTexelDirection(out.layout, size, x, static_cast<int>(row));
            const Vec3 t = glm::normalize(glm::cross(std::abs(r.y) < 0.9 ? Vec3(0, 1, 0) : Vec3(1, 0, 0), r));
            const Vec3 b = glm::cross(r, t);
            Rgb sum(0);
            double weights = 0;
            for (int i = 0; i < samples; ++i) {
                const double u = (i + 0.5) / samples, phi = 2 * kPi * radicalInverse(static_cast<std::uint64_t>(i), 2);
                const double c = std::sqrt((1 - u) / (1 + (alpha * alpha - 1) * u)), s = std::sqrt(1 - c * c);
                const Vec3 h = s * std::cos(phi) * t + s * std::sin(phi) * b + c * r, l = 2 * c * h - r;
                const double weight = glm::dot(l, r);
                if (weight <= 0) continue;
                sum += weight * sampleEnv(source, l);
                weights += weight;
            }
            out.image.setRgb(x, static_cast<int>(row), sum / weights);
        }
    });
    return out;
}

}  // namespace

Exhibit ggxSweepExhibit(const Task& task) {
    const Surrounding s = task.open("studio");
    const EnvMap coarse = convertEnv(s.map, EnvLayout::Cube, task.size(48));
    const Chain chain = ggxChain(coarse);
    const GpuEnvironment map(chain.levels), sky(convertEnv(s.map, EnvLayout::Cube, 256));
    const GpuEnvironmentTable table(bakeFresnelTable(kGold, 128));
    const EnvironmentTruth truth(coarse);
    const Body sphere = sphereBody(task.size(144));
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    builder.row("Perceptual roughness √alpha; 0.33 and 0.63 lie between two levels");
    for (const double perceptual : {0.2, 0.33, 0.53, 0.63, 1.0}) {
        const Lobe lobe{LobeKind::Ggx, 0, sqr(perceptual)};
        EnvironmentSurface surface;
        surface.reflection = {&map, lodOf(chain.mapping, lobe.alpha)};
        surface.table = &table;
        SurroundedSurface exact;
        exact.reflection = [&](const Vec3& d) { return truth(lobe, d); };
        exact.weight = [](double c) { return fresnelExact(kGold, c); };
        report(task.options.progress, task.id + ": reference", 0);
        builder.panel(fmt::format("√alpha = {}", perceptual), sphere, surface, {&sky}, shade(sphere, exact, s.map));
    }
    Exhibit e;
    e.section = kSweeps;
    e.title = "GGX from mirror-like to matt, gold in a studio";
    e.caption =
        "One chain of six levels serves all roughnesses: the lod blends two neighbours. The reference sums the GGX "
        "lobe "
        "(n = v = r, weight D(n·h) n·l) over every texel of the surrounding for each point, at the roughness asked "
        "for, "
        "with gold's exact Fresnel factor.";
    e.scene = fmt::format("Sphere; {}; chain from {}² to faces of 256² down to 8².", s.words, coarse.size());
    e.commands =
        envmapCommands(s, coarse.size(),
                       {"ggx.exr --lobe ggx --chain 6 --values 0.04,0.0784,0.1444,0.2809,0.5329,1 --layout cube "
                        "--size 256 --format half"});
    builder.finish(e);
    return e;
}

Exhibit sunExhibit(const Task& task) {
    constexpr int kSize = 64, kSamples = 64;
    const Surrounding s = task.open("city");
    const EnvMap coarse = convertEnv(s.map, EnvLayout::Cube, task.size(48));
    const GpuEnvironment sky(convertEnv(s.map, EnvLayout::Cube, 256));
    const EnvironmentTruth truth(coarse);
    const Body sphere = sphereBody(task.size(144));
    const std::vector<double> roughness{0.4, 0.65};
    std::vector<PrefilterLevel> levels;
    for (const double p : roughness) levels.push_back({{LobeKind::Ggx, 0, p * p}, kSize});
    const std::vector<EnvMap> filtered = prefilter(coarse, levels, {}).levels;
    std::vector<GpuEnvironment> maps;
    std::vector<std::vector<Rgb>> expected;
    for (std::size_t i = 0; i < roughness.size(); ++i) {
        report(task.options.progress, task.id + ": reference", 0);
        const Lobe lobe = levels[i].lobe;
        SurroundedSurface exact;
        exact.reflection = [&](const Vec3& d) { return truth(lobe, d); };
        expected.push_back(shade(sphere, exact, s.map));
        maps.emplace_back(filtered[i]);
    }
    for (const double p : roughness) maps.emplace_back(sampledGgx(coarse, p * p, kSize, kSamples));
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    for (const bool sampled : {false, true}) {
        builder.row(
            sampled ? fmt::format("{} samples of the lobe a texel, as is usual", kSamples) : "Filtered by nacre",
            !sampled);
        for (std::size_t i = 0; i < roughness.size(); ++i) {
            EnvironmentSurface surface;
            surface.reflection.map = &maps[i + (sampled ? roughness.size() : 0)];
            builder.panel(fmt::format("√alpha = {}", roughness[i]), sphere, surface, {&sky}, expected[i]);
        }
    }
    Exhibit e;
    e.section = kSweeps;
    e.title = "A sun that must not sparkle";
    e.caption =
        "One texel of this surrounding outshines all others. Samples hit it or miss it, and each hit becomes a copy of "
        "the sun; sums over all texels have no such luck to depend on. Both rows stand against the same reference, "
        "which sums the lobe over every texel for each point.";
    e.scene = fmt::format("Sphere that reflects without loss; {}; filtered from {}² to {}² faces.", s.words,
                          coarse.size(), kSize);
    e.commands = envmapCommands(s, coarse.size(),
                                {"sun40.exr --lobe ggx --alpha 0.16 --layout cube --size 64 --format half",
                                 "sun65.exr --lobe ggx --alpha 0.4225 --layout cube --size 64 --format half"});
    builder.finish(e);
    return e;
}

Exhibit lampsExhibit(const Task& task) {
    constexpr double kAlpha = 0.2;
    const Surrounding s = task.open("studio");
    const EnvMap coarse = convertEnv(s.map, EnvLayout::Cube, task.size(48));
    const Lobe lobe{LobeKind::Ggx, 0, kAlpha};
    const std::vector<PrefilterLevel> level{{lobe, 64}};
    const GpuEnvironment map(prefilter(coarse, level, {}).levels), sky(convertEnv(s.map, EnvLayout::Cube, 256));
    const FresnelIndex copper{{0.27, 0.95, 1.17},
                              {3.4, 2.58, 2.4}};  // near 610, 550 and 465 nm, Johnson & Christy 1972
    const GpuEnvironmentTable table(bakeFresnelTable(copper, 128));
    const Reflectance brdf =
        openReflectance("torrance-sparrow:d=ggx,alpha=0.2,f=conductor,eta=0.27/0.95/1.17,k=3.4/2.58/2.4,ks=1,kd=0");
    const GpuFactoredBrdf factored(factorize(brdf, {}));
    const Body torus = torusBody(task.size(144));
    const LitView view{
        torus.camera,
        {{true, directionFromDeg(-35, 50), {1.6, 0.5, 0.2}}, {true, directionFromDeg(60, 25), {0.2, 0.5, 1.6}}},
        Rgb(0)};
    EnvironmentSurface surface;
    surface.reflection.map = &map;
    surface.table = &table;
    const EnvironmentTruth truth(coarse);
    SurroundedSurface exact;
    exact.reflection = [&](const Vec3& d) { return truth(lobe, d); };
    exact.weight = [&](double c) { return fresnelExact(copper, c); };
    report(task.options.progress, task.id + ": reference", 0);
    std::vector<Rgb> lamps(torus.traced.points.size()), both = shade(torus, exact, s.map);
    const std::vector<Rgb> surrounding = both;
    for (std::size_t i = 0; i < both.size(); ++i) {
        const SurfacePoint& p = torus.traced.points[i];
        if (!TracedSurface::hit(p)) {
            lamps[i] = both[i];
            continue;
        }
        const auto local = [&](const Vec3& v) {
            return Vec3(glm::dot(v, p.tangent), glm::dot(v, p.bitangent), glm::dot(v, p.normal));
        };
        const Vec3 wo = local(p.toEye);
        for (const Light& light : view.lights) {
            const Vec3 wi = local(light.position);
            if (wi.z > 0 && wo.z > 0) lamps[i] += brdf.f(wi, wo) * light.color * wi.z;
        }
        both[i] += lamps[i];
    }
    ExhibitBuilder builder(task.loader, task.id, task.builder());
    builder.row("");
    builder.panel(
        "two lamps, by the factored BRDF", torus,
        [&](const RenderTarget& target) { renderFactored(task.loader, target, torus.gpu, view, factored); }, {&sky},
        lamps);
    builder.panel("the surrounding, by its prefiltered map", torus, surface, {&sky}, surrounding);
    builder.panel(
        "both in one shader", torus,
        [&](const RenderTarget& target) { renderFactored(task.loader, target, torus.gpu, view, factored, surface); },
        {&sky}, both);
    Exhibit e;
    e.section = kSweeps;
    e.title = "Lamps and surrounding on one material";
    e.caption =
        "Copper of alpha = 0.2: a warm and a cool lamp through the factored BRDF, the studio through a GGX map and a "
        "Fresnel table. The reference takes the unfactored BRDF and sums the lobe over every texel.";
    e.scene = fmt::format("Torus; {}; filtered from {}² to 64² faces.", s.words, coarse.size());
    e.commands =
        envmapCommands(s, coarse.size(), {"copper.exr --lobe ggx --alpha 0.2 --layout cube --size 64 --format half"});
    builder.finish(e);
    return e;
}

}  // namespace nacre
