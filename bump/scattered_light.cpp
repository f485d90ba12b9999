#include "bump/scattered_light.hpp"

#include <fmt/format.h>

#include <array>

#include "core/error.hpp"
#include "core/parallel.hpp"

namespace nacre {
namespace {

/// Radiance, and 1 for a surface or 0 for a hole: lookups divide by it, so that holes don't darken what is beside them.
using Texture = std::vector<glm::vec4>;

/// A texture of the relief, or with detail × detail texels for each of the relief's.
struct Lookup {
    const Texture& texels;
    int width, height, detail;
    Wrap wrap;

    /// \param p  in the relief's texels, not wrapped
    Rgb operator()(const Vec2& p) const {
        const double x = p.x * detail - 0.5, y = p.y * detail - 0.5, i = std::floor(x), j = std::floor(y);
        const auto s = static_cast<float>(x - i), t = static_cast<float>(y - j);
        const int i0 = wrapIndex(static_cast<int>(i), width, wrap),
                  i1 = wrapIndex(static_cast<int>(i) + 1, width, wrap);
        const std::size_t j0 = row(static_cast<int>(j)), j1 = row(static_cast<int>(j) + 1);
        const glm::vec4 v = (1 - t) * ((1 - s) * texels[j0 + i0] + s * texels[j0 + i1]) +
                            t * ((1 - s) * texels[j1 + i0] + s * texels[j1 + i1]);
        return v.a > 0 ? Rgb(v) / static_cast<double>(v.a) : Rgb(0);
    }
    std::size_t row(int j) const { return static_cast<std::size_t>(wrapIndex(j, height, wrap)) * width; }
};

/// What the steps share.
struct Relief {
    const HeightMap& map;
    const ScatterMap& scatter;
    const ScatteredLightOptions& options;
    Image lit;
    std::vector<Vec3> normals = {};
    std::vector<Rgb> albedo = {};
    std::vector<Vec2> along = {};  ///< of each direction, unit in the plane; 0 for vertical ones

    bool hole(std::size_t i) const { return std::isnan(map.heights.data()[i]); }
    float distance(std::size_t k, std::size_t i) const { return scatter.distance[k].data()[i]; }
    Vec2 seen(int x, int y, std::size_t k, float distance) const {
        return Vec2(x + 0.5, y + 0.5) + along[k] * static_cast<double>(distance);
    }
    Rgb skyOf(std::size_t k) const { return options.sky ? options.sky(scatter.directions[k]) : Rgb(0); }
    Lookup lookup(const Texture& texels) const { return {texels, map.width(), map.height(), 1, map.wrap}; }
    template <typename Body>  // body(x, y, i) of all texels that are no holes
    void eachTexel(const Body& body) const {
        parallelFor(static_cast<std::size_t>(map.height()), options.threads, [&](std::size_t y) {
            for (int x = 0; x < map.width(); ++x) {
                const std::size_t i = y * static_cast<std::size_t>(map.width()) + static_cast<std::size_t>(x);
                if (!hole(i)) body(x, static_cast<int>(y), i);
            }
        });
    }
};

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

Relief makeRelief(const HeightMap& map, const ScatterMap& scatter, const ScatteredLightOptions& options,
                  const Image& normals) {
    Relief out{map, scatter, options, litMask(map, options.light, options.threads)};
    for (int y = 0; y < map.height(); ++y)
        for (int x = 0; x < map.width(); ++x) {
            out.normals.push_back(normals.rgb(x, y));
            out.albedo.push_back(options.albedoMap.empty() ? options.albedo
                                                           : options.albedo * options.albedoMap.rgb(x, y));
        }
    for (const Vec3& d : scatter.directions) out.along.push_back(seenPoint(0, 0, d, 1) - Vec2(0.5));
    return out;
}

Image imageOf(const Relief& relief, const std::vector<Rgb>& values) {
    Image out(relief.map.width(), relief.map.height(), 3);
    for (std::size_t i = 0; i < values.size(); ++i)
        for (int c = 0; c < 3; ++c) out.data()[3 * i + static_cast<std::size_t>(c)] = static_cast<float>(values[i][c]);
    return out;
}

Texture textureOf(const Relief& relief, const std::vector<Rgb>& values) {
    Texture out(values.size(), glm::vec4(0));
    relief.eachTexel([&](int, int, std::size_t i) { out[i] = glm::vec4(values[i], 1); });
    return out;
}

// ---- Lambert's paths that meet

/// body(x, y, i, p) of all texels of the refined relief that are no holes, p the place in the relief.
template <typename Body>
void eachFineTexel(const Relief& relief, const HeightMap& fine, const Body& body) {
    const double k = relief.options.detail;
    parallelFor(static_cast<std::size_t>(fine.height()), relief.options.threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < fine.width(); ++x)
            if (!std::isnan(fine.heights.at(x, y, 0)))
                body(x, y, row * static_cast<std::size_t>(fine.width()) + static_cast<std::size_t>(x),
                     Vec2((x + 0.5) / k, (y + 0.5) / k));
    });
}

/// Radiance of direct light, k × k samples a texel.
Texture directTexture(const Relief& relief, const HeightMap& fine) {
    const ScatteredLightOptions& options = relief.options;
    const Image lit = litMask(fine, options.light, options.threads);
    const Texture albedo = textureOf(relief, relief.albedo);
    Texture out(fine.heights.texelCount(), glm::vec4(0));
    eachFineTexel(relief, fine, [&](int x, int y, std::size_t i, const Vec2& p) {
        const double cosine = std::max(0.0, glm::dot(reliefNormal(fine, x, y), options.light));
        const Rgb light = options.irradiance * (cosine / kPi * static_cast<double>(lit.data()[i]));
        out[i] = glm::vec4(relief.lookup(albedo)(p) * light, 1);
    });
    return out;
}

/// ⟨n, l⟩/π where lit, of the patches at the texels' centres: towards −x −y, +x −y, −x +y, +x +y.
std::vector<std::array<double, 4>> ownPatches(const Relief& relief) {
    std::vector<std::array<double, 4>> out(relief.normals.size());
    relief.eachTexel([&](int x, int y, std::size_t i) {
        const glm::vec4 slopes = ownSlopes(relief.map, x, y);
        for (int q = 0; q < 4; ++q) {
            const Vec3 n = glm::normalize(Vec3(-slopes[q % 2], -slopes[2 + q / 2], 1));
            out[i][static_cast<std::size_t>(q)] =
                std::max(0.0, glm::dot(n, relief.options.light)) / kPi * static_cast<double>(relief.lit.data()[i]);
        }
    });
    return out;
}

/// Light from the sky, straight.
std::vector<Rgb> skyLight(const Relief& relief) {
    std::vector<Rgb> out(relief.normals.size(), Rgb(0)), radiance;
    for (std::size_t k = 0; k < relief.along.size(); ++k) radiance.push_back(relief.skyOf(k));
    if (!relief.options.sky) return out;
    relief.eachTexel([&](int, int, std::size_t i) {
        double all = 0;
        for (std::size_t k = 0; k < radiance.size(); ++k) {
            const double w = lambertWeight(relief.normals[i], relief.scatter.directions[k], relief.scatter.weights[k]);
            all += w;
            if (relief.distance(k, i) < 0) out[i] += w * radiance[k];
        }
        out[i] *= all > 0 ? relief.albedo[i] / all : Rgb(0);
    });
    return out;
}

/// Light that comes to a texel along a bounce's directions and is reflected.
/// \param leaves  radiance of all light, k × k samples a texel. \param passedOn  without direct light, one a texel
Rgb gathered(const Relief& relief, const ScatterBounce& bounce, int x, int y, std::size_t i, const Lookup& leaves,
             const std::vector<Rgb>& passedOn, const std::array<double, 4>& own) {
    double weights = 0;
    Rgb sum(0);
    for (std::size_t j = 0; j < bounce.directions.size(); ++j) {
        const auto k = static_cast<std::size_t>(bounce.directions[j]);
        const double w = lambertWeight(relief.normals[i], relief.scatter.directions[k], bounce.weights[j]);
        const float distance = relief.distance(k, i);
        if (w <= 0 || distance < 0) continue;
        weights += w;
        const Vec2 towards = relief.along[k];
        const double patch = own[(towards.x > 0 ? 1u : 0u) + (towards.y > 0 ? 2u : 0u)];
        sum += w * (distance > 0 ? leaves(relief.seen(x, y, k, distance))
                                 : relief.albedo[i] * relief.options.irradiance * patch + passedOn[i]);
    }
    // Some direction of the map may hit though none of these does: what lies there passes for the own texel.
    return relief.albedo[i] * (weights > 0 ? sum / weights : leaves({x + 0.5, y + 0.5}));
}

void meet(const Relief& relief, const ScatterPlan& plan, ScatteredLight& out) {
    const HeightMap fine = refinedRelief(relief.map, relief.options.detail);
    const Texture direct = directTexture(relief, fine);
    const std::vector<std::array<double, 4>> own = ownPatches(relief);
    const std::vector<Rgb> sky = skyLight(relief);
    std::vector<Rgb> light(relief.normals.size(), Rgb(0));
    for (std::size_t b = plan.bounces.size(); b-- > 0;) {  // from the deepest texture to the viewer's
        std::vector<Rgb> passedOn = sky;
        for (std::size_t i = 0; i < passedOn.size(); ++i) passedOn[i] += light[i];
        const Texture coarse = textureOf(relief, passedOn);
        Texture leaves = direct;
        eachFineTexel(relief, fine, [&](int, int, std::size_t i, const Vec2& p) {
            leaves[i] += glm::vec4(relief.lookup(coarse)(p), 0);
        });
        const Lookup lookup{leaves, fine.width(), fine.height(), relief.options.detail, relief.map.wrap};
        relief.eachTexel([&](int x, int y, std::size_t i) {
            const double hits = plan.hits.data()[i];
            light[i] = hits > 0 ? hits * gathered(relief, plan.bounces[b], x, y, i, lookup, passedOn, own[i]) : Rgb(0);
        });
    }
    out.sky = imageOf(relief, sky);
    out.indirect = imageOf(relief, light);
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
Rgb reflected(const Relief& relief, std::size_t i, const Vec3& wi, const Vec3& wo) {
    const Vec3& n = relief.normals[i];
    const double cosI = glm::dot(n, wi);
    if (cosI <= 0) return Rgb(0);
    if (!relief.options.brdf) return relief.albedo[i] / kPi * cosI;
    const Mat3 frame = glm::transpose(frameOf(n));
    const double behind = std::max(0.0, kGrazing - glm::dot(n, wo));
    return relief.albedo[i] * relief.options.brdf(frame * wi, frame * glm::normalize(wo + n * behind)) * cosI;
}

Rgb directly(const Relief& relief, std::size_t i, const Vec3& wo) {
    if (relief.lit.data()[i] <= 0) return Rgb(0);
    return reflected(relief, i, relief.options.light, wo) * relief.options.irradiance;
}

/// Directions of all paths, and what Lambert's weights of each bounce sum to, for each texel.
struct Paths {
    Paths(const Relief& relief, int count, int segments) : depth(static_cast<std::size_t>(segments)) {
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
    double factor(const Relief& relief, int b, std::size_t i) const {
        if (sums.empty()) return relief.scatter.count();
        const double sum = sums[static_cast<std::size_t>(b)][i];
        return sum > 0 ? 1 / sum : 0;
    }
    std::size_t depth;
    std::vector<int> indices = {};
    std::vector<std::vector<double>> sums = {};
};

/// One segment more than bounces: the deepest sees the sky alone.
void follow(const Relief& relief, ScatteredLight& out) {
    const ScatteredLightOptions& options = relief.options;
    const std::size_t texels = relief.normals.size();
    const Paths paths(relief, options.paths, options.bounces + 1);
    std::vector<Rgb> sky(texels, Rgb(0)), indirect(texels, Rgb(0));
    Texture before(texels, glm::vec4(0)), after(texels, glm::vec4(0));
    for (int p = 0; p < options.paths; ++p)
        for (int b = options.bounces; b >= 0;
             --b) {  // what leaves towards segment b − 1, of what comes along segment b
            const std::size_t k = paths.at(p, b);
            const Vec3 d = relief.scatter.directions[k];
            const Vec3 to = b > 0 ? -relief.scatter.directions[paths.at(p, b - 1)] : options.viewer;
            const Rgb skyRadiance = relief.skyOf(k);
            const Lookup passedOn = relief.lookup(before);
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
    const Relief relief = makeRelief(map, scatter, options, plan.normals);
    ScatteredLight out;
    std::vector<Rgb> direct(relief.normals.size(), Rgb(0));
    relief.eachTexel([&](int, int, std::size_t i) { direct[i] = directly(relief, i, options.viewer); });
    out.direct = imageOf(relief, direct);
    if (options.pathsMeet && !options.brdf)
        meet(relief, plan, out);
    else
        follow(relief, out);
    return out;
}

}  // namespace nacre
