#include "bump/scattered_light.hpp"

#include <fmt/format.h>

#include "bump/scattered_relief.hpp"
#include "core/error.hpp"

namespace nacre {
namespace {

void validate(const HeightMap& map, const ScatteredLightOptions& options) {
    constexpr double kUnit = 1e-6;
    const auto unit = [](const Vec3& d) { return isFinite(d) && std::abs(glm::length(d) - 1) < kUnit; };
    require(unit(options.light) && unit(options.viewer), "scatterLight: expected unit directions of light and viewer");
    require(isFinite(options.irradiance) && isFinite(options.albedo), "scatterLight: expected finite colours");
    require(options.detail >= 1 && options.detail % 2 == 1,
            fmt::format("scatterLight: expected an odd detail >= 1, found {}", options.detail));
    const Image& albedo = options.albedoMap;
    require(albedo.empty() || (albedo.width() == map.width() && albedo.height() == map.height()),
            "scatterLight: expected an albedo of the relief's size");
}

ScatteredRelief makeRelief(const HeightMap& map, const ScatterMap& scatter, const ScatteredLightOptions& options,
                           const Image& normals) {
    ScatteredRelief out{map, scatter, options, litMask(map, options.light, options.threads)};
    for (int y = 0; y < map.height(); ++y)
        for (int x = 0; x < map.width(); ++x) {
            out.normals.push_back(normals.rgb(x, y));
            out.albedo.push_back(options.albedoMap.empty() ? options.albedo
                                                           : options.albedo * options.albedoMap.rgb(x, y));
        }
    for (const Vec3& d : scatter.directions) out.along.push_back(seenPoint(0, 0, d, 1) - Vec2(0.5));
    return out;
}

// ---- paths that are alone

/// Local frame at a texel: z the normal, x along the relief's x.
Mat3 frameOf(const Vec3& n) {
    Vec3 t = Vec3(1, 0, 0) - n * n.x;
    t = glm::dot(t, t) > 1e-12 ? glm::normalize(t) : Vec3(0, 1, 0);
    return {t, glm::cross(n, t), n};
}

/// A texel that is seen from behind its normal, which is smoother than its patches, is seen this cosine above it.
constexpr double kGrazing = 0.1;

/// f ⟨n, wi⟩ of a texel.
Rgb reflected(const ScatteredRelief& relief, std::size_t i, const Vec3& wi, const Vec3& wo) {
    const Vec3& n = relief.normals[i];
    const double cosI = glm::dot(n, wi);
    if (cosI <= 0) return Rgb(0);
    if (!relief.options.brdf) return relief.albedo[i] / kPi * cosI;
    const Mat3 frame = glm::transpose(frameOf(n));
    const double behind = std::max(0.0, kGrazing - glm::dot(n, wo));
    return relief.albedo[i] * relief.options.brdf(frame * wi, frame * glm::normalize(wo + n * behind)) * cosI;
}

Rgb directly(const ScatteredRelief& relief, std::size_t i, const Vec3& wo) {
    if (relief.lit.data()[i] <= 0) return Rgb(0);
    return reflected(relief, i, relief.options.light, wo) * relief.options.irradiance;
}

/// Directions of all paths, and what Lambert's weights of each bounce sum to, for each texel.
struct Paths {
    Paths(const ScatteredRelief& relief, int count, int segments) : depth(static_cast<std::size_t>(segments)) {
        indices = scatterPaths(relief.scatter.count(), count, segments);
        if (relief.options.brdf) return;
        sums.assign(depth, std::vector<double>(relief.normals.size(), 0));
        relief.eachTexel([&](int, int, std::size_t i) {
            for (std::size_t s = 0; s < indices.size(); ++s) {
                const auto k = static_cast<std::size_t>(indices[s]);
                sums[s % depth][i] +=
                    lambertWeight(relief.normals[i], relief.scatter.directions[k], relief.scatter.weights[k]) / count;
            }
        });
    }
    std::size_t at(int p, int b) const {
        return static_cast<std::size_t>(indices[static_cast<std::size_t>(p) * depth + static_cast<std::size_t>(b)]);
    }
    /// 1/density of a direction as a path's segment, of the map's weight 1.
    double factor(const ScatteredRelief& relief, int b, std::size_t i) const {
        if (sums.empty()) return relief.scatter.count();
        const double sum = sums[static_cast<std::size_t>(b)][i];
        return sum > 0 ? 1 / sum : 0;
    }
    std::size_t depth;
    std::vector<int> indices = {};
    std::vector<std::vector<double>> sums = {};
};

/// One segment more than bounces: the deepest sees the sky alone.
void follow(const ScatteredRelief& relief, ScatteredLight& out) {
    const ScatteredLightOptions& options = relief.options;
    const std::size_t texels = relief.normals.size();
    const Paths paths(relief, options.paths, options.bounces + 1);
    std::vector<Rgb> sky(texels, Rgb(0)), indirect(texels, Rgb(0));
    RadianceTexture before(texels, glm::vec4(0)), after(texels, glm::vec4(0));
    for (int p = 0; p < options.paths; ++p)
        for (int b = options.bounces; b >= 0;
             --b) {  // what leaves towards segment b − 1, of what comes along segment b
            const std::size_t k = paths.at(p, b);
            const Vec3 d = relief.scatter.directions[k];
            const Vec3 to = b > 0 ? -relief.scatter.directions[paths.at(p, b - 1)] : options.viewer;
            const Rgb skyRadiance = relief.skyOf(k);
            const RadianceLookup passedOn = relief.lookup(before);
            relief.eachTexel([&](int x, int y, std::size_t i) {
                const float distance = relief.distance(k, i);
                const bool hit = distance >= 0;
                Rgb light = reflected(relief, i, d, to) * (relief.scatter.weights[k] * paths.factor(relief, b, i));
                if (light != Rgb(0))
                    light *= !hit                  ? skyRadiance
                             : b < options.bounces ? passedOn(relief.seen(x, y, k, distance))
                                                   : Rgb(0);
                if (b == 0)
                    (hit ? indirect : sky)[i] += light / static_cast<double>(options.paths);
                else
                    after[i] = glm::vec4(light + directly(relief, i, to), 1);
            });
            std::swap(before, after);
        }
    out.sky = imageOf(relief, sky);
    out.indirect = imageOf(relief, indirect);
}

}  // namespace

Image ScatteredLight::total() const {
    Image out = direct;
    for (std::size_t i = 0; i < out.data().size(); ++i) out.data()[i] += sky.data()[i] + indirect.data()[i];
    return out;
}

ScatteredLight scatterLight(const HeightMap& map, const ScatterMap& scatter, const ScatteredLightOptions& options) {
    const ScatterPlan plan = planScatter(
        map, scatter,
        {.bounces = options.bounces, .paths = options.paths, .normals = options.normals, .threads = options.threads});
    validate(map, options);
    const ScatteredRelief relief = makeRelief(map, scatter, options, plan.normals);
    ScatteredLight out;
    std::vector<Rgb> direct(relief.normals.size(), Rgb(0));
    relief.eachTexel([&](int, int, std::size_t i) { direct[i] = directly(relief, i, options.viewer); });
    out.direct = imageOf(relief, direct);
    if (options.pathsMeet && !options.brdf)
        meetPaths(relief, plan, out);
    else
        follow(relief, out);
    return out;
}

}  // namespace nacre
