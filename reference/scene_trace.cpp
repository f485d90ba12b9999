#include "reference/scene_trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "core/error.hpp"
#include "core/light_area.hpp"
#include "core/parallel.hpp"
#include "core/sampling.hpp"
#include "reference/camera_rays.hpp"
#include "reference/light_path.hpp"
#include "reference/scattered_light.hpp"
#include "reference/specular_path.hpp"
#include "reference/traced_relief.hpp"
#include "reference/traced_samples.hpp"

namespace nacre {
namespace {

class Tracer {
public:
    Tracer(const SceneDescription& scene, const Camera& camera, const SceneTruths& truths,
           const std::vector<SceneParts>& parts, const SceneTraceOptions& options)
        : scene_(scene),
          truths_(truths),
          parts_(parts),
          options_(options),
          nodes_(nodeTransforms(scene, options.time)),
          lights_(lightsInWorld(scene, nodes_)),
          areas_(areasInWorld(scene, nodes_)),
          surfaces_(scene, nodes_),
          paths_(scene, nodes_, surfaces_, options.lightDepth),
          scattered_(scene, nodes_, surfaces_),
          rays_(options.points.empty() ? CameraRays(camera, options.width, options.height, options.supersample)
                                       : CameraRays(camera, options.width, options.height, options.points)),
          turn_(Mat3(glm::rotate(glm::dmat4(1), -scene.sky.rotationY, Vec3(0, 1, 0)))) {
        for (const SceneParts& p : parts) occlusion_ = occlusion_ || p.occlusion;
    }

    void pixel(int x, int y, std::vector<Image>& out) const {
        std::vector<Rgb> sums(parts_.size(), Rgb(0));
        for (int k = 0; k < rays_.samples(); ++k) {
            const auto pixel = static_cast<std::uint64_t>(y) * options_.width + x;
            SpecularPathOptions path{options_.specularDepth, options_.spreadRays, {}};
            path.next = PixelSequence(options_.seed, pixel, 4, static_cast<unsigned>(k * options_.spreadRays));
            const Rgb fog = followSpecular(scene_, surfaces_, rays_.at(x, y, k), path, [&](const PathEnd& end) {
                if (!end.hit) {
                    for (std::size_t i = 0; i < sums.size(); ++i)
                        if (takes(parts_[i], end.specular)) sums[i] += end.share * background(parts_[i], end.direction);
                    return;
                }
                Point point = pointAt(*end.hit);
                point.pixel = pixel;
                point.ray = static_cast<unsigned>(k);
                const Rgb share = end.share * end.texel;
                for (std::size_t i = 0; i < sums.size(); ++i)
                    if (takes(parts_[i], end.specular)) sums[i] += share * radiance(point, parts_[i]);
            });
            for (std::size_t i = 0; i < sums.size(); ++i)  // of paths over specular surfaces alone
                if (takes(parts_[i], true)) sums[i] += fog;
        }
        for (std::size_t i = 0; i < sums.size(); ++i) out[i].setRgb(x, y, sums[i] / double(rays_.samples()));
    }

private:
    /// What is blocked of the sky that a normal sees, of rays with the cosine about it.
    struct Blocked {
        double byRelief = 0, byAll = 0;             ///< shares
        Rgb radianceByRelief{0}, radianceByAll{0};  ///< of the diffuse light
    };
    /// A hit, and what costs rays: found once for all pictures.
    struct Point {
        SurfacePoint s;
        std::size_t node = 0;
        std::uint64_t pixel = 0, ray = 0;
        const SceneMaterial* material = nullptr;
        const MaterialTruth* truth = nullptr;
        Vec2 at{0};                       ///< in the relief [texels]
        Vec3 reliefNormal{0, 0, 1};       ///< in the mesh's frame
        std::vector<int> shadowed, dark;  ///< a light: by other surfaces, by the relief; −1 = not asked
        std::vector<std::optional<std::vector<LightArrival>>> arrivals;  ///< a light: by way of specular faces
        std::optional<Rgb> indirect;
        std::optional<Blocked> blocked[2];  ///< without and with the relief's normal
        std::optional<Rgb> mirrorBlocked[2];
    };

    static bool takes(const SceneParts& parts, bool specularFirst) {
        return parts.firstSurface == SceneParts::FirstSurface::Any ||
               (parts.firstSurface == SceneParts::FirstSurface::Specular) == specularFirst;
    }

    Rgb background(const SceneParts& parts, const Vec3& direction) const {
        if (!parts.sky) return Rgb(0);
        return truths_.sky ? truths_.sky(turn_ * direction) : scene_.sky.color;
    }

    Point pointAt(const SceneRays::Hit& hit) const {
        Point p;
        p.s = hit.s;
        p.node = hit.node;
        const auto material = static_cast<std::size_t>(scene_.nodes[p.node].material);
        p.material = &scene_.materials.at(material);
        p.truth = &truths_.materials[material];
        p.shadowed.assign(lights_.size(), -1);
        p.dark.assign(lights_.size(), -1);
        p.arrivals.resize(lights_.size());
        if (p.truth->relief) {
            const HeightMap& map = p.truth->relief->map;
            p.at = p.s.uv * p.material->relief->tiles * Vec2(map.width(), map.height());
            p.reliefNormal = patchNormal(map, p.at);
        }
        return p;
    }

    /// The frame of reflectance. Twin: nacre_bump_frame.
    static SurfacePoint shadingFrame(const Point& p, bool relief) {
        static constexpr double kLeast = 0.05;
        SurfacePoint out = p.s;
        const double facing = glm::dot(p.s.normal, p.s.toEye);
        if (!relief || facing <= 0) return out;
        Vec3 n = p.reliefNormal.x * p.s.tangent + p.reliefNormal.y * p.s.bitangent + p.reliefNormal.z * p.s.normal;
        const double missing = std::min(facing, kLeast) - glm::dot(n, p.s.toEye);
        if (missing > 0) n = glm::normalize(n + missing * p.s.toEye);
        const double hand = glm::dot(glm::cross(p.s.normal, p.s.tangent), p.s.bitangent) < 0 ? -1 : 1;
        const Vec3 t = p.s.tangent - glm::dot(n, p.s.tangent) * n;
        out.normal = n;
        out.tangent = glm::dot(t, t) > 1e-12 ? glm::normalize(t) : turnedTo(n, {1, 0, 0});
        out.bitangent = hand * glm::cross(n, out.tangent);
        return out;
    }

    bool shadowed(Point& p, std::size_t light, const Vec3& offset) const {
        if (!scene_.lights[light].shadow || !scene_.nodes[p.node].receivesShadow) return false;
        if (p.shadowed[light] < 0) {
            const double length = glm::length(offset);
            const double distance = lights_[light].directional ? std::numeric_limits<double>::infinity() : length;
            p.shadowed[light] = surfaces_.shadowed(p.s.position, offset / length, distance);
        }
        return p.shadowed[light] != 0;
    }
    static bool dark(Point& p, std::size_t light, const Vec3& local) {
        if (p.dark[light] < 0) p.dark[light] = !isLit(p.truth->relief->rays, p.at, local);
        return p.dark[light] != 0;
    }

    Rgb lamps(Point& p, const SurfacePoint& frame, const SceneParts& parts, bool relief) const {
        const BrdfFunction& f = parts.bakedBrdf && p.truth->bakedBrdf ? p.truth->bakedBrdf : p.truth->brdf;
        Rgb sum(0);
        if (!f || !(glm::dot(p.s.normal, p.s.toEye) > 0)) return sum;
        for (std::size_t i = 0; i < lights_.size(); ++i) {
            if (!areas_[i]) {
                sum +=
                    lamp(p, frame, parts, relief, i, lights_[i], f) + sentOn(p, frame, parts, relief, i, lights_[i], f);
                continue;
            }
            PixelSequence next = sequence(p, 4 + i, options_.lightPoints);
            for (int k = 0; k < options_.lightPoints; ++k) {
                p.shadowed[i] = p.dark[i] = -1;  // of the point before
                p.arrivals[i].reset();
                const Light light = pointOfArea(lights_[i], *areas_[i], next());
                sum += (lamp(p, frame, parts, relief, i, light, f) + sentOn(p, frame, parts, relief, i, light, f)) /
                       double(options_.lightPoints);
            }
        }
        return sum;
    }
    Rgb lamp(Point& p, const SurfacePoint& frame, const SceneParts& parts, bool relief, std::size_t i,
             const Light& light, const BrdfFunction& f) const {
        const Vec3 wo = toLocal(frame, p.s.toEye);
        const Vec3 offset = light.directional ? light.position : light.position - p.s.position;
        const Vec3 toLight = glm::normalize(offset), local = toLocal(p.s, toLight), wi = toLocal(frame, toLight);
        const Rgb arriving = light.color * lightFalloff(light, p.s.position);
        if (arriving == Rgb(0) || (relief && local.z <= 0)) return Rgb(0);
        const bool bounces = relief && parts.indirect && p.material->relief->indirectLight == static_cast<int>(i);
        const bool direct = wi.z > 0 && wo.z > 0;
        if ((!bounces && !direct) || (parts.shadows && shadowed(p, i, offset))) return Rgb(0);
        const Rgb bounced = bounces ? indirect(p, local) * arriving : Rgb(0);
        if (!direct || (relief && parts.reliefShadow && dark(p, i, local))) return bounced;
        return bounced + f(wi, wo) * arriving * wi.z;
    }

    /// Light of a lamp that mirrors and panes send on.
    Rgb sentOn(Point& p, const SurfacePoint& frame, const SceneParts& parts, bool relief, std::size_t i,
               const Light& light, const BrdfFunction& f) const {
        if (!parts.shadows || !scene_.lights[i].shadow) return Rgb(0);
        if (!p.arrivals[i]) {
            std::vector<LightArrival>& found = p.arrivals[i].emplace();
            paths_.follow(light, p.s.position, scene_.nodes[p.node].receivesShadow,
                          [&](const LightArrival& arrival) { found.push_back(arrival); });
            if (options_.lightDepth > 0 && !scattered_.empty())
                scattered_.follow(light, p.s.position, scene_.nodes[p.node].receivesShadow, options_.facePoints,
                                  sequence(p, 32 + i, options_.facePoints),
                                  [&](const LightArrival& arrival) { found.push_back(arrival); });
        }
        const Vec3 wo = toLocal(frame, p.s.toEye);
        Rgb sum(0);
        for (const LightArrival& arrival : *p.arrivals[i]) {
            const Vec3 wi = toLocal(frame, arrival.toLight), local = toLocal(p.s, arrival.toLight);
            if (!(wi.z > 0 && wo.z > 0) || (relief && local.z <= 0)) continue;
            if (relief && parts.reliefShadow && !isLit(p.truth->relief->rays, p.at, local)) continue;
            sum += f(wi, wo) * arrival.irradiance * wi.z;
        }
        return sum;
    }

    /// Light of lamps by way of other surfaces.
    Rgb interreflected(const Point& from, const SurfacePoint& frame, const SceneParts& parts) const {
        const int bounces = parts.bounces > 0 ? parts.bounces : options_.interreflectionBounces;
        PixelSequence first = sequence(from, 3, options_.interreflectionPaths);
        PixelRandom random(options_.seed, from.pixel * static_cast<unsigned>(rays_.samples()) + from.ray, 5);
        Rgb sum(0);
        for (int i = 0; i < options_.interreflectionPaths; ++i) {
            Point at = from;
            SurfacePoint here = frame;
            Rgb carried(1);
            for (int k = 0; k < bounces; ++k) {
                if (!at.truth->brdf || !(glm::dot(here.normal, here.toEye) > 0)) break;
                const Vec3 d = turnedTo(here.normal, cosineHemisphere(k == 0 ? first() : random.pair()));
                carried *= at.truth->brdf(toLocal(here, d), toLocal(here, here.toEye)) * kPi;
                const auto hit = surfaces_.firstHit({here.position, d, surfaces_.skip(), 1e30}, -d);
                if (!hit) break;
                const std::uint64_t pixel = from.pixel, ray = from.ray;
                at = pointAt(*hit);
                at.pixel = pixel, at.ray = ray * 64 + static_cast<unsigned>(8 * i + k);
                here = at.s;
                sum += carried * lamps(at, here, parts, false);
            }
        }
        return sum / double(options_.interreflectionPaths);
    }
    Rgb indirect(Point& p, const Vec3& local) const {
        if (!p.indirect) {
            const std::uint64_t number = p.pixel * static_cast<unsigned>(rays_.samples()) + p.ray;
            p.indirect =
                bounced(*p.truth->relief, *p.material->relief, p.at, p.reliefNormal, local, options_.indirectPaths,
                        sequence(p, 0, options_.indirectPaths), PixelRandom(options_.seed, number, 3));
        }
        return *p.indirect;
    }

    /// `count` points a ray, those of a pixel's rays one after the other.
    PixelSequence sequence(const Point& p, std::uint64_t purpose, int count) const {
        return {options_.seed, p.pixel, purpose, p.ray * static_cast<unsigned>(count)};
    }

    const Blocked& blocked(Point& p, const Vec3& normal, bool relief) const {
        std::optional<Blocked>& kept = p.blocked[relief];
        if (kept) return *kept;
        const int rays = occlusion_ ? std::max(options_.skyRays, options_.occlusionRays) : options_.skyRays;
        PixelSequence next = sequence(p, 1, rays);
        const BrightTexels* bright = p.truth->diffuseSource.get();
        Blocked sum;
        for (int i = 0; i < rays; ++i) {
            // Half of the rays with the cosine, half where the surrounding is bright: weighted as one mixture
            // (Veach & Guibas 1995, balance heuristic).
            const bool towardsLight = bright != nullptr && i % 2 == 1;
            const Vec2 square = next();
            const Vec3 d = towardsLight ? bright->draw(square) * turn_ : turnedTo(normal, cosineHemisphere(square));
            const double cosine = glm::dot(d, normal);
            if (cosine <= 0) continue;
            const Vec3 local = toLocal(p.s, d);
            const bool byRelief = relief && (local.z <= 0 || !isLit(p.truth->relief->rays, p.at, local));
            const bool byAll = byRelief || (occlusion_ && surfaces_.blocked(p.s.position, d));
            if (!byAll) continue;
            double weight = 1.0 / rays;
            if (bright != nullptr) {
                const double share = double(rays / 2) / rays, density = cosine / kPi;
                weight *= density / ((1 - share) * density + share * bright->density(turn_ * d));
            }
            const Rgb radiance = bright != nullptr ? p.truth->diffuseColor * bright->radiance(turn_ * d) : Rgb(0);
            sum.byAll += weight, sum.radianceByAll += weight * radiance;
            if (byRelief) sum.byRelief += weight, sum.radianceByRelief += weight * radiance;
        }
        return *(kept = sum);
    }
    Rgb mirrorBlocked(Point& p, const Vec3& r, bool relief) const {
        std::optional<Rgb>& kept = p.mirrorBlocked[relief];
        if (kept) return *kept;
        const int rays = isMirror(p.truth->reflectionLobe) ? 1 : options_.occlusionRays;
        PixelSequence next = sequence(p, 2, rays);
        Rgb sum(0);
        double weights = 0;
        for (int i = 0; i < rays; ++i) {
            const auto [d, weight] = lobeSample(p.truth->reflectionLobe, r, next());
            weights += weight;
            if (weight > 0 && surfaces_.blocked(p.s.position, d)) sum += weight * p.truth->reflectionSource(turn_ * d);
        }
        return *(kept = weights > 0 ? sum / weights : Rgb(0));
    }

    Rgb surrounding(Point& p, const SurfacePoint& frame, const SceneParts& parts, bool relief) const {
        const SurroundedSurface& surface = p.truth->surrounding;
        SurroundedSurface here = surface;
        const bool blocks = (relief && parts.reliefShadow) || parts.occlusion;
        if (surface.reflection)
            here.reflection = [&](const Vec3& r) {
                const Rgb all = surface.reflection(turn_ * r);
                return parts.occlusion ? all - mirrorBlocked(p, r, relief) : all;
            };
        if (surface.transmission) here.transmission = [&](const Vec3& t) { return surface.transmission(turn_ * t); };
        if (surface.diffuse)
            here.diffuse = [&](const Vec3& n) {
                const Rgb all = surface.diffuse(turn_ * n);
                if (!blocks) return all;
                const Blocked& b = blocked(p, n, relief);
                return all - (parts.occlusion ? b.radianceByAll : b.radianceByRelief);
            };
        return surroundedRadiance(here, p.s.toEye, frame.normal);
    }

    Rgb radiance(Point& p, const SceneParts& parts) const {
        const bool relief = parts.relief && p.truth->relief;
        const SurfacePoint frame = shadingFrame(p, relief);
        Rgb sum(0);
        if (parts.ambient && p.material->ambient != Rgb(0)) {
            double seen = 1;
            if ((relief && parts.reliefShadow) || parts.occlusion) {
                const Blocked& b = blocked(p, frame.normal, relief);
                seen -= parts.occlusion ? b.byAll : b.byRelief;
            }
            sum += p.material->ambient * seen;
        }
        if (parts.lamps) sum += lamps(p, frame, parts, relief);
        if (parts.interreflection) sum += interreflected(p, frame, parts);
        if (parts.surrounding && p.material->surrounding) sum += surrounding(p, frame, parts, relief);
        return sum;
    }

    const SceneDescription& scene_;
    const SceneTruths& truths_;
    const std::vector<SceneParts>& parts_;
    const SceneTraceOptions& options_;
    std::vector<glm::dmat4> nodes_;
    std::vector<Light> lights_;
    std::vector<std::optional<LightArea>> areas_;
    SceneRays surfaces_;
    LightPaths paths_;
    ScatteredLight scattered_;
    CameraRays rays_;
    Mat3 turn_;
    bool occlusion_ = false;
};

}  // namespace

std::vector<Image> traceScene(const SceneDescription& scene, const Camera& camera, const SceneTruths& truths,
                              const std::vector<SceneParts>& parts, const SceneTraceOptions& options) {
    require(options.width >= 1 && options.height >= 1 && options.supersample >= 1 && options.skyRays >= 1 &&
                options.indirectPaths >= 1 && options.occlusionRays >= 1 && options.lightPoints >= 1 &&
                options.interreflectionPaths >= 1 && options.interreflectionBounces >= 1 && options.facePoints >= 1 &&
                options.specularDepth >= 0 && options.lightDepth >= 0 && options.spreadRays >= 1,
            "traceScene: sizes and numbers of rays must be >= 1, depths >= 0");
    require(truths.materials.size() == scene.materials.size(), "traceScene: expected a truth for each material");
    for (const SceneLight& light : scene.lights) checkCone(light.light);
    const Tracer tracer(scene, camera, truths, parts, options);
    std::vector<Image> out(parts.size(), Image(options.width, options.height, 3));
    static constexpr int kBand = 8;  // rows between two reports
    for (int first = 0; first < options.height; first += kBand) {
        report(options.progress, "tracing", static_cast<double>(first) / options.height);
        const int rows = std::min(kBand, options.height - first);
        parallelFor(static_cast<std::size_t>(rows), options.threads, [&](std::size_t row) {
            for (int x = 0; x < options.width; ++x) tracer.pixel(x, first + static_cast<int>(row), out);
        });
    }
    return out;
}

}  // namespace nacre
