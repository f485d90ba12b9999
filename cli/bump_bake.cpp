#include "cli/bump_bake.hpp"

#include <fmt/format.h>

#include "cli/output_file.hpp"
#include "core/asset_exr.hpp"
#include "core/error.hpp"

namespace nacre::cli {

using nlohmann::json;

namespace {

constexpr int kFewestDirections = 32, kFewestAzimuths = 8, kMostAzimuths = 256;

/// One object of times. \param things  how many texels, horizons or rays there were; 0 = not told
json timesOf(const Stopwatch& watch, const char* rate, double things) {
    json out = {{"seconds", watch.seconds()}, {"cpu_seconds", watch.cpuSeconds()}};
    if (things > 0) out[rate] = things / std::max(watch.seconds(), 1e-9);
    return out;
}

double texels(const HeightMap& map) { return static_cast<double>(map.heights.texelCount()); }

/// Ellipses of some directions, or horizons of some azimuths.
struct Shadows {
    int directions = 0, azimuths = 0;
    std::string text() const {
        return azimuths ? fmt::format("a horizon map of {} azimuths", azimuths)
                        : fmt::format("ellipses of {} directions", directions);
    }
};

void bakeShadows(const HeightMap& map, const BumpRequest& request, const Shadows& shadows, BumpBake& out) {
    if (shadows.directions > 0) {
        const Stopwatch watch;
        out.fit = request.fit;
        out.fit.directions = shadows.directions;
        out.maps.ellipses = fitEllipses(map, out.fit);
        out.times["ellipses"] = timesOf(watch, "texels_per_second", texels(map));
    }
    if (shadows.azimuths > 0) {
        const Stopwatch watch;
        out.maps.horizons = makeHorizonMap(map, shadows.azimuths, request.threads);
        out.times["horizon"] = timesOf(watch, "horizons_per_second", texels(map) * shadows.azimuths);
    }
}

std::vector<Shadows> candidates(const BumpRequest& request) {
    std::vector<Shadows> out;
    if (request.ellipses) {
        for (int n = kFewestDirections; n < request.fit.directions; n *= 2) out.push_back({n, 0});
        out.push_back({request.fit.directions, 0});
    }
    const int most = request.horizon ? request.horizon : kMostAzimuths;
    for (int k = kFewestAzimuths; k < most; k *= 2) out.push_back({0, k});
    out.push_back({0, most});
    return out;
}

std::size_t bytesOf(const BumpMaps& maps, TexelFormat format) { return toAsset(maps, format).bytes(); }

/// An asset file has room for it, beside the rest.
bool isStorable(const BumpMaps& maps, TexelFormat format) {
    try {
        toAsset(maps, format);
        return true;
    } catch (const StorageError&) {
        return false;
    }
}

/// The first candidate within both budgets joins `bake`.
void searchShadows(const HeightMap& map, const BumpRequest& request, const std::string& output,
                   const Progress& progress, BumpBake& bake) {
    const Stopwatch searching;
    const LitSamples samples = drawLitSamples(map, kBumpSamples, kBumpSeed, request.threads);
    std::string nearest = "none";
    double least = 2;
    for (const Shadows& candidate : candidates(request)) {
        report(progress, candidate.text(), 0);
        BumpBake one;
        one.maps = bake.maps;
        const Stopwatch baking;
        bakeShadows(map, request, candidate, one);
        one.seconds = bake.seconds + baking.seconds();
        one.cpuSeconds = bake.cpuSeconds + baking.cpuSeconds();
        if (!isStorable(one.maps, request.format)) continue;
        const std::size_t bytes = bytesOf(one.maps, request.format);
        if (request.maxBytes && bytes > *request.maxBytes) continue;
        const double misjudged = measureShadows(samples, asStored(one.maps, request.format, output)).misjudged;
        if (misjudged < least) {
            least = misjudged;
            nearest = fmt::format("{:.3g} by {}, {} bytes", misjudged, candidate.text(), bytes);
        }
        if (misjudged > *request.maxError) continue;
        one.times.update(bake.times);
        one.searchSeconds = searching.seconds() - baking.seconds();
        bake = std::move(one);
        return;
    }
    throw Error(fmt::format("{}: expected at most {:.3g} of shadows misjudged{}, found {}", output, *request.maxError,
                            request.maxBytes ? fmt::format(" in {} bytes", *request.maxBytes) : "", nearest));
}

void bakeTheRest(const HeightMap& map, const BumpRequest& request, const Progress& progress, BumpBake& out) {
    if (request.normals) {
        report(progress, "normals", 0);
        const Stopwatch watch;
        out.maps.normals = makeNormals(map, {true, request.roughness, request.threads});
        out.times["normals"] = timesOf(watch, "", 0);
    }
    if (request.scatter > 0) {
        report(progress, "scatter map", 0);
        const Stopwatch watch;
        out.maps.scatter = makeScatterMap(map, {request.scatter, request.threads});
        out.times["scatter"] = timesOf(watch, "rays_per_second", texels(map) * request.scatter);
    }
    if (request.indirect) {
        report(progress, "indirect light", 0);
        const Stopwatch watch;
        constexpr int kDirections = 256;  // where no scatter map is asked for
        const ScatterMap scatter =
            out.maps.scatter ? *out.maps.scatter : makeScatterMap(map, {kDirections, request.threads});
        out.light = scatterLight(map, scatter, request.light);
        out.maps.indirect = out.light.indirect;
        out.times["indirect"] = timesOf(watch, "", 0);
    }
    if (request.heights) out.maps.heights = map.heights;
}

/// What an asset file holds at most, before the work rather than after it.
void requireFits(const HeightMap& map, const BumpRequest& request, const std::string& output) {
    std::size_t textures = (request.horizon + 3) / 4 + (request.scatter + 3) / 4 + (request.ellipses ? 2 : 0) +
                           (request.indirect ? 1 : 0) + (request.heights ? 1 : 0);
    if (request.normals)
        for (int edge = std::max(map.width(), map.height()); edge > 0; edge /= 2) ++textures;
    const double layers = request.horizon + request.scatter + (request.ellipses ? 6 : 0) + (request.indirect ? 3 : 0) +
                          (request.heights ? 1 : 0) + (request.normals ? (request.roughness ? 4 : 3) * 4 / 3.0 : 0);
    const double values = layers * texels(map);
    if (textures > exr::kMaxParts || values > static_cast<double>(exr::kMaxValues))
        throw Error(
            fmt::format("{}: expected at most {} textures of {} values together, found {} of {:.0f} (fewer "
                        "outputs, azimuths or directions take less)",
                        output, exr::kMaxParts, exr::kMaxValues, textures, values));
}

}  // namespace

BumpMaps asStored(const BumpMaps& maps, TexelFormat format, const std::string& output) {
    return bumpFromAsset(toAsset(maps, format), output);
}

BumpBake bakeBump(const HeightMap& map, const BumpRequest& request, const std::string& output,
                  const Progress& progress) {
    requireFits(map, request, output);
    BumpBake out;
    out.fit = request.fit;
    out.maps.width = map.width();
    out.maps.height = map.height();
    out.maps.wrap = map.wrap;
    const Stopwatch watch;
    bakeTheRest(map, request, progress, out);
    if (!request.maxError) {
        report(progress, "shadows", 0);
        bakeShadows(map, request, {request.ellipses ? request.fit.directions : 0, request.horizon}, out);
    }
    out.seconds = watch.seconds();
    out.cpuSeconds = watch.cpuSeconds();
    if (request.maxError) searchShadows(map, request, output, progress, out);
    if (const std::size_t bytes = bytesOf(out.maps, request.format); request.maxBytes && bytes > *request.maxBytes)
        throw Error(
            fmt::format("{}: expected at most {} bytes, found {} for what is asked (fewer outputs, azimuths or "
                        "directions, or --format unorm8, take less)",
                        output, *request.maxBytes, bytes));
    return out;
}

}  // namespace nacre::cli
