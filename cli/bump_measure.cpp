#include "cli/bump_measure.hpp"

#include "reference/scattered_light_error.hpp"

#include "bump/bump_lookup.hpp"

namespace nacre::cli {

using nlohmann::json;

LitError measureShadows(const LitSamples& samples, const BumpMaps& stored) {
    return measureLit(samples, [&](int x, int y, const Vec3& light) {
        return litMargin(stored, (x + 0.5) / stored.width, (y + 0.5) / stored.height, light) >= 0;
    });
}

/// `stored` with nothing but ellipses or horizons.
static BumpMaps frameOf(const BumpMaps& stored) {
    BumpMaps out;
    out.width = stored.width;
    out.height = stored.height;
    out.wrap = stored.wrap;
    return out;
}

static json ellipsesError(const HeightMap& map, const BumpMaps& stored, const EllipseOptions& options,
                          TexelFormat format, const LitSamples& samples) {
    BumpMaps maps = frameOf(stored);
    maps.ellipses = stored.ellipses;
    const LitError error = measureShadows(samples, maps);
    double radiiOnly = error.misjudged;
    if (options.fit != EllipseFit::Radii) {
        EllipseOptions paper = options;
        paper.fit = EllipseFit::Radii;
        maps.ellipses = fitEllipses(map, paper);
        radiiOnly = measureShadows(samples, bumpFromAsset(toAsset(maps, format), "the paper's ellipses")).misjudged;
    }
    return {{"misjudged", error.misjudged},
            {"misjudged_radii_only", radiiOnly},
            {"dark", error.dark},
            {"samples", error.samples}};
}

static json horizonError(const HeightMap& map, const BumpMaps& stored, unsigned threads, const LitSamples& samples) {
    const HorizonError e = measureHorizons(
        drawHorizonSamples(map, stored.horizons->azimuths(), kBumpSamples, kBumpSeed, threads), *stored.horizons);
    BumpMaps maps = frameOf(stored);
    maps.horizons = stored.horizons;
    return {{"max_rad", e.maxRad},
            {"share_within_1e-3", e.shareWithinMilliRad},
            {"rmse_deg", e.rmseDeg},
            {"rmse_deg_along_axes", e.rmseDegAlongAxes},
            {"rmse_deg_worst_azimuth", e.rmseDegWorst},
            {"misjudged", measureShadows(samples, maps).misjudged},
            {"samples", e.samples}};
}

static json scatterError(const HeightMap& map, const ScatterMap& stored, unsigned threads) {
    const SeenError e = measureSeen(drawSeenSamples(map, stored.directions, kBumpSamples, kBumpSeed, threads), stored);
    return {{"hit_mismatch", e.hitMismatch},
            {"beyond_one_texel", e.beyondOneTexel},
            {"hits", e.hits},
            {"samples", e.samples}};
}

json measureIndirect(const HeightMap& map, const ScatteredLight& light, const ScatteredLightOptions& options,
                     const Progress& progress) {
    report(progress, "tracing paths", 0);
    constexpr int kTexels = 300, kPaths = 1500;
    ReliefLightOptions truth;
    truth.light = options.light;
    truth.irradiance = options.irradiance;
    truth.albedo = [albedo = options.albedo](const Vec2&) { return albedo; };
    truth.bounces = options.bounces;
    truth.paths = kPaths;
    truth.threads = options.threads;
    const ScatteredLightError e = measureScatteredLight(drawReliefLightSamples(map, truth, kTexels, kBumpSeed), light);
    return {{"relative_rmse", e.indirect},
            {"relative_rmse_total", e.total},
            {"noise", e.noise},
            {"bias", e.bias},
            {"share_of_total", e.share},
            {"samples", e.samples}};
}

json measureBump(const HeightMap& map, const BumpMaps& stored, const EllipseOptions& options, TexelFormat format,
                 const Progress& progress) {
    report(progress, "measuring", 0);
    json out = json::object();
    if (stored.ellipses || stored.horizons) {
        const LitSamples samples = drawLitSamples(map, kBumpSamples, kBumpSeed, options.threads);
        if (stored.ellipses) out["ellipses"] = ellipsesError(map, stored, options, format, samples);
        if (stored.horizons) out["horizon"] = horizonError(map, stored, options.threads, samples);
    }
    if (stored.scatter) out["scatter"] = scatterError(map, *stored.scatter, options.threads);
    return out;
}

}  // namespace nacre::cli
