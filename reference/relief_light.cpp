#include "reference/relief_light.hpp"

#include <fmt/format.h>

#include <random>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/sampling.hpp"
#include "reference/relief_rays.hpp"

namespace nacre {

namespace {

/// d of the frame whose z is n.
Vec3 turnedTo(const Vec3& n, const Vec3& d) {
    const Vec3 helper = std::abs(n.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 t = glm::normalize(glm::cross(helper, n)), b = glm::cross(n, t);
    return d.x * t + d.y * b + d.z * n;
}

/// Numbers of one texel: neither its neighbours' nor those of another seed (the finaliser of SplitMix64).
std::mt19937_64 randomOf(std::uint64_t seed, std::uint64_t texel) {
    std::uint64_t z = seed + 0x9e3779b97f4a7c15u * (texel + 1);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return std::mt19937_64(z ^ (z >> 31));
}

struct Scene {
    Relief relief;
    const ReliefLightOptions& options;
};

/// Radiance that leaves p for light that comes straight from the light: albedo/π · E · max(0, n·l) where lit.
Rgb directLight(const Scene& scene, const Vec2& p, const Vec3& normal) {
    const double cosine = glm::dot(normal, scene.options.light);
    if (cosine <= 0 || !isLit(scene.relief, p, scene.options.light)) return Rgb(0);
    return scene.options.albedo(p) / kPi * scene.options.irradiance * cosine;
}

/// One path from a texel. With pdf cosθ/π the estimate of ∫ albedo/π · L cosθ dω is albedo · L, at each vertex.
void addPath(const Scene& scene, Vec3 p, Vec3 normal, std::mt19937_64& random, Rgb& sky, Rgb& indirect) {
    const ReliefLightOptions& options = scene.options;
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    Rgb carried = options.albedo(Vec2(p));
    for (int reflections = 0; reflections < options.bounces || options.sky; ++reflections) {
        const double u = uniform(), v = uniform();
        const Vec3 d = turnedTo(normal, cosineHemisphere({u, v}));
        const std::optional<ReliefHit> hit = firstHit(scene.relief, p, d);
        if (!hit) {
            if (options.sky) (reflections == 0 ? sky : indirect) += carried * options.sky(d);
            return;
        }
        if (reflections == options.bounces) return;
        indirect += carried * directLight(scene, Vec2(hit->point), hit->normal);
        carried *= options.albedo(Vec2(hit->point));
        p = hit->point, normal = hit->normal;
    }
}

TexelLight lightOf(const Scene& scene, const HeightMap& map, const glm::ivec2& texel) {
    const ReliefLightOptions& options = scene.options;
    const float height = map.heights.at(texel.x, texel.y, 0);
    if (std::isnan(height)) return {};
    const Vec3 p(texel.x + 0.5, texel.y + 0.5, height);
    const Vec3 normal = options.normal ? options.normal(texel.x, texel.y) : texelNormal(map, texel.x, texel.y);
    std::mt19937_64 random = randomOf(options.seed, static_cast<std::uint64_t>(texel.y) * map.width() + texel.x);
    TexelLight out;
    out.direct = directLight(scene, Vec2(p), normal);
    Rgb mean(0), squares(0);  // of sky + indirect; squares: sum of squared differences from the mean (Welford)
    for (int i = 1; i <= options.paths; ++i) {
        Rgb sky(0), indirect(0);
        addPath(scene, p, normal, random, sky, indirect);
        out.sky += sky;
        out.indirect += indirect;
        const Rgb before = sky + indirect - mean;
        mean += before / double(i);
        squares += before * (sky + indirect - mean);
    }
    const double count = options.paths;
    out.sky /= count;
    out.indirect /= count;
    out.standardError = glm::sqrt(squares / std::max(1.0, count - 1) / count);
    return out;
}

}  // namespace

Vec3 texelNormal(const HeightMap& map, int x, int y) {
    Vec2 sum(0);
    double patches = 0;
    for (const Vec2 side : {Vec2(-1, -1), Vec2(1, -1), Vec2(-1, 1), Vec2(1, 1)}) {
        const int i = x + static_cast<int>(side.x), j = y + static_cast<int>(side.y);
        const double own = map.at(x, y), besideX = map.at(i, y), besideY = map.at(x, j), across = map.at(i, j);
        if (std::isnan(own + besideX + besideY + across)) continue;
        sum += side * Vec2(besideX - own, besideY - own);
        ++patches;
    }
    return glm::normalize(Vec3(patches > 0 ? -sum / patches : Vec2(0), 1));
}

std::function<Rgb(const Vec2& p)> bilinearAlbedo(const Image& image, Wrap wrap) {
    require(!image.empty(), "bilinearAlbedo: empty image");
    return [image, wrap](const Vec2& p) {
        const double x = std::floor(p.x - 0.5), y = std::floor(p.y - 0.5), s = p.x - 0.5 - x, t = p.y - 0.5 - y;
        const auto texel = [&](int i, int j) {
            return image.rgb(wrapIndex(static_cast<int>(x) + i, image.width(), wrap),
                             wrapIndex(static_cast<int>(y) + j, image.height(), wrap));
        };
        return (1 - t) * ((1 - s) * texel(0, 0) + s * texel(1, 0)) + t * ((1 - s) * texel(0, 1) + s * texel(1, 1));
    };
}

std::vector<TexelLight> traceReliefLight(const HeightMap& map, std::span<const glm::ivec2> texels,
                                         const ReliefLightOptions& options) {
    validateHeightMap(map);
    require(std::abs(glm::length(options.light) - 1) < 1e-6, "traceReliefLight: expected a unit direction of light");
    require(isFinite(options.irradiance), "traceReliefLight: expected a finite irradiance");
    require(options.bounces >= 0 && options.paths >= 1, "traceReliefLight: expected bounces >= 0, paths >= 1");
    require(static_cast<bool>(options.albedo), "traceReliefLight: expected an albedo");
    for (const glm::ivec2& t : texels)
        require(t.x >= 0 && t.y >= 0 && t.x < map.width() && t.y < map.height(),
                fmt::format("traceReliefLight: texel ({}, {}) is outside the map", t.x, t.y));
    const Scene scene{Relief(map), options};
    std::vector<TexelLight> out(texels.size());
    parallelFor(out.size(), options.threads, [&](std::size_t i) { out[i] = lightOf(scene, map, texels[i]); });
    return out;
}

}  // namespace nacre
