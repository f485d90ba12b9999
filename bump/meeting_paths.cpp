// Lambert's paths that meet: each step makes a texture of what leaves the relief out of the one before.
#include <array>

#include "bump/patch_samples.hpp"
#include "bump/scattered_relief.hpp"

namespace nacre {
namespace {

/// body(x, y, i) of all texels of a map that are no holes.
template <typename Body>
void eachSolid(const HeightMap& map, unsigned threads, const Body& body) {
    parallelFor(static_cast<std::size_t>(map.height()), threads, [&](std::size_t row) {
        for (int x = 0; x < map.width(); ++x) {
            const std::size_t i = row * static_cast<std::size_t>(map.width()) + static_cast<std::size_t>(x);
            if (!std::isnan(map.heights.data()[i])) body(x, static_cast<int>(row), i);
        }
    });
}

/// A texel of the period as one of the map.
struct Twin {
    std::size_t i;
    Vec2 side;             ///< −1: the relief is turned over in that axis
    std::size_t turnOver;  ///< the same, of a patch's number q: bit 0 for x, bit 1 for y
};

/// Where light is, one period of the relief: beyond, all repeats, or goes on as the border.
struct Period {
    explicit Period(const ScatteredRelief& r) : relief(r), map(reliefPeriod(r.map)) {}

    Twin twin(int x, int y) const {
        const int w = relief.map.width(), h = relief.map.height();
        const bool overX = x >= w, overY = y >= h;
        const int ownX = overX ? 2 * w - 1 - x : x, ownY = overY ? 2 * h - 1 - y : y;
        return {static_cast<std::size_t>(ownY) * static_cast<std::size_t>(w) + static_cast<std::size_t>(ownX),
                {overX ? -1 : 1, overY ? -1 : 1},
                (overX ? 1u : 0u) + (overY ? 2u : 0u)};
    }
    /// Of patch q in a texture with twice the texels both ways: (2x + a, 2y + b), towards +x when a, +y when b.
    std::size_t patch(int x, int y, std::size_t q) const {
        return (2 * static_cast<std::size_t>(y) + q / 2) * 2 * static_cast<std::size_t>(map.width()) +
               2 * static_cast<std::size_t>(x) + q % 2;
    }
    template <typename Body>
    void eachTexel(const Body& body) const {
        eachSolid(map, relief.options.threads, body);
    }

    const ScatteredRelief& relief;
    HeightMap map;
};

/// Radiance of direct light, (k + 1)² samples a patch (PatchSamples).
RadianceTexture directTexture(const Period& period, const PatchSamples& samples) {
    const ScatteredRelief& relief = period.relief;
    const ScatteredLightOptions& options = relief.options;
    const RadianceTexture albedo = textureOf(relief, relief.albedo);
    const Image normals = samples.normals(period.map), lit = samples.lit(period.map, options.light, options.threads);
    RadianceTexture out(lit.texelCount(), glm::vec4(0));
    parallelFor(static_cast<std::size_t>(lit.height()), options.threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < lit.width(); ++x) {
            const Vec3 normal = normals.rgb(x, y);
            if (normal.z <= 0) continue;
            const double cosine = std::max(0.0, glm::dot(normal, options.light));
            const Rgb light = options.irradiance * (cosine / kPi * static_cast<double>(lit.at(x, y, 0)));
            const Vec2 p(PatchSamples::position(samples.of(x)), PatchSamples::position(samples.of(y)));
            out[row * static_cast<std::size_t>(lit.width()) + static_cast<std::size_t>(x)] =
                glm::vec4(relief.lookup(albedo)(p) * light, 1);
        }
    });
    return out;
}

/// Radiance of direct light that leaves the own patches at the texels' centres.
std::vector<std::array<Rgb, 4>> ownDirect(const Period& period) {
    const ScatteredLightOptions& options = period.relief.options;
    const Image lit = litMask(period.map, options.light, options.threads);
    std::vector<std::array<Rgb, 4>> out(period.map.heights.texelCount());
    period.eachTexel([&](int x, int y, std::size_t i) {
        const std::array<Vec3, 4> normals = ownNormals(ownSlopes(period.map, x, y));
        for (std::size_t q = 0; q < 4; ++q)
            out[i][q] = period.relief.albedo[period.twin(x, y).i] * options.irradiance *
                        (std::max(0.0, glm::dot(normals[q], options.light)) / kPi * static_cast<double>(lit.data()[i]));
    });
    return out;
}

/// Light that leaves about a normal of the map's texel i, straight from the sky.
/// \param radiance  of the map's directions; none: black
Rgb skyAt(const ScatteredRelief& relief, const std::vector<Rgb>& radiance, const Vec3& normal, std::size_t i) {
    double all = 0;
    Rgb sum(0);
    for (std::size_t k = 0; k < radiance.size(); ++k) {
        const double w = lambertWeight(normal, relief.scatter.directions[k], relief.scatter.weights[k]);
        all += w;
        if (relief.distance(k, i) < 0) sum += w * radiance[k];
    }
    return all > 0 ? relief.albedo[i] * sum / all : Rgb(0);
}

/// What the directions of a turned-over texel see of the sky.
std::vector<Rgb> skyRadiance(const ScatteredRelief& relief, const Vec2& side) {
    std::vector<Rgb> out;
    if (relief.options.sky)
        for (const Vec3& d : relief.scatter.directions)
            out.push_back(relief.options.sky({d.x * side.x, d.y * side.y, d.z}));
    return out;
}

/// Straight from the sky, of the patches.
RadianceTexture patchSky(const Period& period) {
    const ScatteredRelief& relief = period.relief;
    std::array<std::vector<Rgb>, 4> radiance;
    for (std::size_t t = 0; t < 4; ++t) radiance[t] = skyRadiance(relief, {t % 2 ? -1 : 1, t / 2 ? -1 : 1});
    RadianceTexture out(4 * period.map.heights.texelCount(), glm::vec4(0));
    period.eachTexel([&](int x, int y, std::size_t) {
        const Twin twin = period.twin(x, y);
        glm::vec4 slopes = ownSlopes(period.map, x, y);
        for (std::size_t q = 0; q < 4; ++q) {
            const Vec3 turned = ownNormals(slopes)[q], normal(turned.x * twin.side.x, turned.y * twin.side.y, turned.z);
            out[period.patch(x, y, q)] = glm::vec4(skyAt(relief, radiance[twin.turnOver], normal, twin.i), 1);
        }
    });
    return out;
}

/// Of a texture of PatchSamples, in its own texels.
RadianceLookup lookupOf(const Period& period, const RadianceTexture& texture, const PatchSamples& samples) {
    const int each = samples.k + 1;
    return {texture, each * period.map.width(), each * period.map.height(), 1, period.map.wrap};
}

struct Step {
    const Period& period;
    const RadianceLookup& leaves;
    const PatchSamples& samples;
    const RadianceTexture& passedOn;
    const std::vector<std::array<Rgb, 4>>& own;

    /// Light that comes from the points seen and from the own patches, and is reflected.
    Rgb gathered(const SeenPoints& points, int x, int y) const {
        const Twin twin = period.twin(x, y);
        const std::size_t here = static_cast<std::size_t>(y) * static_cast<std::size_t>(period.map.width()) + x;
        Rgb sum(0);
        if (points.share[twin.i] > 0) {
            for (int n = 0; n < points.count; ++n)
                sum += leaves(samples.coordinates(Vec2(x + 0.5, y + 0.5) + twin.side * Vec2(points.offset(twin.i, n))));
            sum *= static_cast<double>(points.share[twin.i]) / points.count;
        }
        for (std::size_t q = 0; q < 4; ++q) {
            const double share = points.own[twin.i][static_cast<int>(q ^ twin.turnOver)];
            sum += share * (own[here][q] + Rgb(passedOn[period.patch(x, y, q)]));
        }
        return period.relief.albedo[twin.i] * sum;
    }
};

}  // namespace

void meetPaths(const ScatteredRelief& relief, const ScatterPlan& plan, ScatteredLight& out) {
    const Period period(relief);
    const PatchSamples corners{1}, samples{relief.options.detail};
    const RadianceTexture direct = directTexture(period, samples), sky = patchSky(period);
    const std::vector<std::array<Rgb, 4>> own = ownDirect(period);
    std::vector<Rgb> viewedSky(relief.normals.size(), Rgb(0)), light(relief.normals.size(), Rgb(0));
    const std::vector<Rgb> radiance = skyRadiance(relief, {1, 1});
    relief.eachTexel([&](int, int, std::size_t i) { viewedSky[i] = skyAt(relief, radiance, relief.normals[i], i); });
    RadianceTexture passedOn = sky;
    for (int b = relief.options.bounces; b-- > 0;) {  // from the deepest texture to the viewer's
        RadianceTexture all = direct;
        const RadianceLookup between = lookupOf(period, passedOn, corners), leaves = lookupOf(period, all, samples);
        parallelFor(static_cast<std::size_t>(leaves.height), relief.options.threads, [&](std::size_t row) {
            for (int x = 0; x < leaves.width; ++x) {
                glm::vec4& texel = all[row * static_cast<std::size_t>(leaves.width) + static_cast<std::size_t>(x)];
                const Vec2 p(corners.coordinate(samples.of(x)), corners.coordinate(samples.of(static_cast<int>(row))));
                if (texel.a > 0) texel += glm::vec4(between(p), 0);
            }
        });
        const Step step{period, leaves, samples, passedOn, own};
        if (b == 0) {
            relief.eachTexel([&](int x, int y, std::size_t i) { light[i] = step.gathered(plan.viewed, x, y); });
            break;
        }
        RadianceTexture next = sky;
        period.eachTexel([&](int x, int y, std::size_t) {
            for (std::size_t q = 0; q < 4; ++q)
                next[period.patch(x, y, q)] +=
                    glm::vec4(step.gathered(plan.patches[q ^ period.twin(x, y).turnOver], x, y), 0);
        });
        passedOn = std::move(next);
    }
    out.sky = imageOf(relief, viewedSky);
    out.indirect = imageOf(relief, light);
}

}  // namespace nacre
