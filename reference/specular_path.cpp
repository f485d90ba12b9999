#include "reference/specular_path.hpp"

#include <limits>

namespace nacre {
namespace {

/// Fog of the face that a ray left, until where it goes.
struct Fog {
    Rgb radiance{0};
    double perLength = 0;  ///< of the ray
};

class Follower {
public:
    Follower(const SceneDescription& scene, const SceneRays& rays, const SpecularPathOptions& options,
             const std::function<void(const PathEnd&)>& end)
        : scene_(scene), rays_(rays), options_(options), end_(end) {}

    Rgb fogLight{0};

    void follow(const Ray& ray, Rgb share, int left, const Fog& fog, bool split) {
        const Vec3 along = glm::normalize(ray.direction);
        const std::optional<SceneRays::Hit> hit = rays_.firstHit(ray, -along);
        const double length = hit ? glm::length(hit->s.position - ray.origin) : std::numeric_limits<double>::infinity();
        if (fog.perLength > 0) {
            const double faded = std::min(1.0, length * fog.perLength);
            fogLight += share * faded * fog.radiance;
            share *= 1 - faded;
        }
        const bool later = left < options_.depth;
        if (!hit) return end_({{}, along, share, Rgb(1), later});
        const auto material = static_cast<std::size_t>(scene_.nodes[hit->node].material);
        const std::optional<SceneSpecular>& specular = scene_.materials[material].specular;
        if (!specular) return end_({hit, along, share, Rgb(1), later});
        SceneSpecular here = *specular;
        Rgb texel(1);
        if (here.texture) {
            const glm::vec4 at = sampleBilinear(*here.texture, float(hit->s.uv.x), float(hit->s.uv.y));
            texel = Rgb(at);
            here.surface *= at.a;
        }
        if (here.filter) {
            const Rgb color(sampleBilinear(*here.filter, float(hit->s.uv.x), float(hit->s.uv.y)));
            (here.ior ? here.transmission : here.reflection) *= color;
        }
        if (here.surface > 0) end_({hit, along, share * here.surface, texel, true});
        if (left == 0) return;
        const Vec3 normal = normalOf(*hit, along);
        const bool spreads = here.scatters();
        const int count = spreads && !split ? options_.spreadRays : 1;
        if (here.roughness > 0) return followFacets(*hit, normal, here, along, share / double(count), count, left);
        for (const SpecularRay& next : specularRays(here, along, normal))
            for (int i = 0; i < count; ++i) {
                const Vec3 direction = spreads ? spread(next.direction, normal, here.spread) : next.direction;
                const double cosine = std::abs(glm::dot(direction, normal));
                const Fog ahead{here.fog, here.fogDistance > 0 ? cosine / here.fogDistance : 0};
                follow({hit->s.position, direction, rays_.skip(), std::numeric_limits<float>::max()},
                       share * next.share / double(count), left - 1, ahead, split || spreads);
            }
    }

private:
    /// The interpolated normal on the triangle's side, as curved surfaces need it; the triangle's own where the ray
    /// sees those two from different sides, at outlines.
    static Vec3 normalOf(const SceneRays::Hit& hit, const Vec3& along) {
        const Vec3 smooth = glm::dot(hit.s.normal, hit.plane) < 0 ? -hit.s.normal : hit.s.normal;
        return glm::dot(along, smooth) * glm::dot(along, hit.plane) > 0 ? smooth : hit.plane;
    }

    /// Rays at facets of a rough surface: of Beckmann's distribution, with Smith's shadowing (Walter et al. 2007,
    /// equations 38 to 41).
    void followFacets(const SceneRays::Hit& hit, const Vec3& normal, const SceneSpecular& surface, const Vec3& along,
                      const Rgb& share, int count, int left) {
        const Vec3 n = glm::dot(along, normal) > 0 ? -normal : normal;
        const double cosine = std::abs(glm::dot(along, n)), alpha = surface.roughness;
        const Vec3 x = glm::normalize(glm::cross(n, std::abs(n.y) < 0.5 ? Vec3(0, 1, 0) : Vec3(0, 0, 1)));
        for (int i = 0; i < count; ++i) {
            const Vec2 u = options_.next();
            const double slope = alpha * std::sqrt(-std::log1p(-u.x)), phi = 2 * kPi * u.y;
            const Vec3 facet = glm::normalize(n + slope * (std::cos(phi) * x + std::sin(phi) * glm::cross(n, x)));
            const double facing = -glm::dot(along, facet);
            if (facing <= 0 || cosine == 0) continue;
            SceneSpecular flat = surface;  // as the facet is: seen from its front
            if (flat.ior && n != normal) flat.ior = 1 / *flat.ior;
            for (const SpecularRay& next : specularRays(flat, along, facet)) {
                const double ahead = glm::dot(next.direction, n);
                if ((ahead > 0) != (glm::dot(next.direction, facet) > 0) || ahead == 0) continue;
                const double weight =
                    facing / (cosine * glm::dot(facet, n)) / ((1 + hidden(cosine, alpha)) * (1 + hidden(ahead, alpha)));
                const Fog fog{surface.fog, surface.fogDistance > 0 ? std::abs(ahead) / surface.fogDistance : 0};
                follow({hit.s.position, next.direction, rays_.skip(), std::numeric_limits<float>::max()},
                       share * weight * next.share, left - 1, fog, true);
            }
        }
    }

    /// Smith's Λ of Beckmann's distribution.
    static double hidden(double cosine, double alpha) {
        const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
        if (sine < 1e-9) return 0;
        const double a = std::abs(cosine) / (alpha * sine);
        return 0.5 * (std::erf(a) - 1) + std::exp(-a * a) / (2 * a * std::sqrt(kPi));
    }

    /// Slopes against the normal moved by a Gaussian (Box and Muller's).
    Vec3 spread(const Vec3& direction, const Vec3& normal, double deviation) const {
        const Vec3 n = glm::dot(direction, normal) > 0 ? normal : -normal;
        const Vec3 x = glm::normalize(glm::cross(n, std::abs(n.y) < 0.5 ? Vec3(0, 1, 0) : Vec3(0, 0, 1)));
        const Vec2 u = options_.next();
        const double radius = deviation * std::sqrt(-2 * std::log1p(-u.x)), phi = 2 * kPi * u.y;
        return glm::normalize(direction / glm::dot(direction, n) +
                              radius * (std::cos(phi) * x + std::sin(phi) * glm::cross(n, x)));
    }

    const SceneDescription& scene_;
    const SceneRays& rays_;
    const SpecularPathOptions& options_;
    const std::function<void(const PathEnd&)>& end_;
};

}  // namespace

double fresnelReflectance(double before, double beyond, double eta) {
    const double s = (before - eta * beyond) / (before + eta * beyond);
    const double p = (eta * before - beyond) / (eta * before + beyond);
    return 0.5 * (s * s + p * p);
}

std::vector<SpecularRay> specularRays(const SceneSpecular& surface, const Vec3& along, const Vec3& normal) {
    const Vec3 n = glm::dot(along, normal) > 0 ? -normal : normal;
    const double cosine = std::min(1.0, -glm::dot(along, n)), rest = 1 - surface.surface;
    const Vec3 mirrored = along + 2 * cosine * n;
    std::vector<SpecularRay> out;
    const auto add = [&](const Vec3& direction, const Rgb& share) {
        if (share != Rgb(0)) out.push_back({glm::normalize(direction), share});
    };
    if (!surface.ior) {
        add(mirrored, rest * surface.reflection);
        return out;
    }
    const double eta = n == normal ? *surface.ior : 1 / *surface.ior;
    const double sine2 = (1 - cosine * cosine) / (eta * eta);
    double reflects = 1;
    if (sine2 < 1) {
        const double beyond = std::sqrt(1 - sine2);
        reflects = !surface.partial || eta == 1 ? 0 : fresnelReflectance(cosine, beyond, eta);
        add(along / eta + (cosine / eta - beyond) * n, (1 - reflects) * rest * surface.transmission);
    }
    add(mirrored, reflects * rest * surface.reflection);
    return out;
}

Rgb followSpecular(const SceneDescription& scene, const SceneRays& rays, const Ray& ray,
                   const SpecularPathOptions& options, const std::function<void(const PathEnd&)>& end) {
    Follower follower(scene, rays, options, end);
    follower.follow(ray, Rgb(1), options.depth, {}, false);
    return follower.fogLight;
}

}  // namespace nacre
