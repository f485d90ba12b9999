#include "shading/hybrid/traced_pixels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "core/error.hpp"
#include "core/parallel.hpp"

namespace nacre {
namespace {

void checkTraceable(const SceneDescription& scene) {
    if (scene.sky.asset >= 0) throw Error("traced pixels: expected a background of one colour, found a map");
    for (const SceneNode& node : scene.nodes)
        if (node.volume >= 0)
            throw Error(fmt::format("traced pixels: expected meshes alone, found a volume at node '{}'", node.name));
    for (const SceneMaterial& m : scene.materials) {
        const auto fail = [&](const char* what) {
            throw Error(fmt::format("traced pixels: material '{}': expected {}", m.name, what));
        };
        if (m.relief) fail("no relief");
        if (m.surrounding) fail("no surrounding");
        if (!m.specular) continue;
        const SceneSpecular& s = *m.specular;
        if (s.scatters() || s.fogDistance > 0 || s.texture || s.filter || s.surface > 0)
            fail("a clear specular surface, without spread, roughness, fog, texture, filter and own light");
    }
}

/// Among four neighbours of the picture, by which they may differ: more is a shadow's edge, which would be blurred.
constexpr double kUneven = 0.1;

/// Whether f is one value wherever it is asked.
bool isDiffuse(const BrdfFunction& f) {
    if (!f) return true;  // black
    const Rgb first = f({0, 0, 1}, {0, 0, 1});
    for (const double elevation : {0.2, 0.8, 1.2})
        for (const double azimuth : {0.0, 1.3, kPi})
            for (const double other : {0.1, 0.8}) {
                const Vec3 wi(std::sin(elevation) * std::cos(azimuth), std::sin(elevation) * std::sin(azimuth),
                              std::cos(elevation)),
                    wo(std::sin(other), 0, std::cos(other));
                const Rgb difference = f(wi, wo) - first;
                for (int c = 0; c < 3; ++c)
                    if (std::abs(difference[c]) > 1e-6 * first[c]) return false;
            }
    return true;
}

/// Fresnel's mean of both polarisations, from the sines' ratio eta (beyond over before) and the cosine before.
double fresnel(double cosine, double eta, double cosineBeyond) {
    const double parallel = (eta * cosine - cosineBeyond) / (eta * cosine + cosineBeyond);
    const double across = (cosine - eta * cosineBeyond) / (cosine + eta * cosineBeyond);
    return 0.5 * (parallel * parallel + across * across);
}

/// x along any tangent.
Vec3 localOf(const Vec3& n, const Vec3& d) {
    const Vec3 x = glm::normalize(glm::cross(std::abs(n.y) < 0.9 ? Vec3(0, 1, 0) : Vec3(1, 0, 0), n));
    return {glm::dot(x, d), glm::dot(glm::cross(n, x), d), glm::dot(n, d)};
}

}  // namespace

SpecularTracer::SpecularTracer(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes,
                               std::vector<BrdfFunction> brdfs)
    : scene_(scene), brdfs_(std::move(brdfs)), rays_(scene, nodes) {
    checkTraceable(scene);
    require(brdfs_.size() == scene.materials.size(), "traced pixels: expected a BRDF for each material");
    for (const BrdfFunction& f : brdfs_) diffuse_.push_back(isDiffuse(f));
}

void SpecularTracer::followOne(std::uint32_t pixel, const RaySceneHit& at, const Vec3& along, const Rgb& share,
                               int left, std::vector<TracedEnd>& out) const {
    const SceneMaterial& material = scene_.materials[static_cast<std::size_t>(scene_.nodes[at.node].material)];
    if (!material.specular) return out.push_back({pixel, true, at, along, share});
    if (left == 0) return;
    const SceneSpecular& s = *material.specular;
    // Interpolated, unless that is seen from the other side than the triangle: at outlines.
    const bool front = glm::dot(along, at.face) < 0;
    Vec3 n = front ? at.face : -at.face;
    const Vec3 smooth = glm::dot(at.normal, n) < 0 ? -at.normal : at.normal;
    if (glm::dot(along, smooth) < 0) n = smooth;
    const double cosine = std::min(1.0, -glm::dot(along, n));
    const auto go = [&](const Vec3& direction, const Rgb& part) {
        if (part == Rgb(0)) return;
        if (const auto hit = rays_.firstHit(at.place, direction))
            followOne(pixel, *hit, direction, share * part, left - 1, out);
        else
            out.push_back({pixel, false, {}, direction, share * part});
    };
    double reflects = 1;
    if (s.ior) {
        const double eta = front ? *s.ior : 1 / *s.ior, beyond2 = 1 - (1 - cosine * cosine) / (eta * eta);
        if (beyond2 > 0) {
            const double beyond = std::sqrt(beyond2);
            reflects = s.partial && eta != 1 ? fresnel(cosine, eta, beyond) : 0;
            go(glm::normalize((along + cosine * n) / eta - beyond * n), (1 - reflects) * s.transmission);
        }
    }
    go(glm::normalize(along + 2 * cosine * n), reflects * s.reflection);
}

std::vector<TracedEnd> SpecularTracer::follow(std::span<const SeenPoint> seen, int width, int depth,
                                              unsigned threads) const {
    require(width >= 1 && seen.size() % static_cast<std::size_t>(width) == 0, "traced pixels: expected whole rows");
    const glm::dmat4 toWorld = glm::inverse(scene_.camera.view());
    const Vec3 eye(toWorld[3]), backwards(toWorld[2]);
    const std::size_t rows = seen.size() / static_cast<std::size_t>(width);
    std::vector<std::vector<TracedEnd>> ends(rows);
    parallelFor(rows, threads, [&](std::size_t row) {
        for (int x = 0; x < width; ++x) {
            const std::size_t pixel = row * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
            const SeenPoint& p = seen[pixel];
            if (p.normal.w == 0) continue;
            const Vec3 place(p.place), along = scene_.camera.orthographic ? -backwards : glm::normalize(place - eye);
            // The buffer has no triangle's normal: one ray from just before the place finds it.
            const double before = std::max(1e-3 * glm::length(place - eye), 3 * rays_.skip());
            const auto first = rays_.firstHit(place - before * along, along);
            if (first) followOne(static_cast<std::uint32_t>(pixel), *first, along, Rgb(1), depth, ends[row]);
        }
    });
    std::vector<TracedEnd> out;
    for (const auto& row : ends) out.insert(out.end(), row.begin(), row.end());
    return out;
}

std::optional<Rgb> SpecularTracer::seenLight(const TracedEnd& end, std::span<const SeenPoint> seen,
                                             const Image& picture, const glm::dmat4& toClip) const {
    const Vec4 clip = toClip * Vec4(end.at.place, 1);
    if (!(clip.w > 0)) return {};
    const Vec2 at((clip.x / clip.w + 1) / 2 * picture.width() - 0.5,
                  (clip.y / clip.w + 1) / 2 * picture.height() - 0.5);
    const int x0 = static_cast<int>(std::floor(at.x)), y0 = static_cast<int>(std::floor(at.y));
    if (x0 < 0 || y0 < 0 || x0 + 1 >= picture.width() || y0 + 1 >= picture.height()) return {};
    const auto seenAt = [&](int x, int y) -> const SeenPoint& {
        return seen[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width()) +
                    static_cast<std::size_t>(x)];
    };
    const Vec3 corner(seenAt(x0, y0).place), across(seenAt(x0 + 1, y0 + 1).place);
    const double pixel = glm::length(across - corner);  // all four must show the surface near the end
    Rgb sum(0), low(1e300), high(0);
    for (int k = 0; k < 4; ++k) {
        const int x = x0 + k % 2, y = y0 + k / 2;
        const SeenPoint& p = seenAt(x, y);
        if (p.place.w != static_cast<float>(end.at.node + 1)) return {};
        if (glm::length(Vec3(p.place) - end.at.place) > 2 * pixel) return {};
        const double wx = k % 2 == 1 ? at.x - x0 : 1 - (at.x - x0), wy = k / 2 == 1 ? at.y - y0 : 1 - (at.y - y0);
        const Rgb here = picture.rgb(x, picture.height() - 1 - y);
        sum += wx * wy * here, low = glm::min(low, here), high = glm::max(high, here);
    }
    for (int c = 0; c < 3; ++c)
        if (high[c] - low[c] > kUneven * high[c]) return {};
    return sum;
}

Rgb SpecularTracer::ownLight(const TracedEnd& end, const TracedLight& light) const {
    const auto index = static_cast<std::size_t>(scene_.nodes[end.at.node].material);
    const SceneMaterial& material = scene_.materials[index];
    const BrdfFunction& f = brdfs_[index];
    Rgb sum = material.ambient;
    const Vec3 &n = end.at.normal, place = end.at.place, wo = localOf(n, -end.direction);
    if (!f || !(wo.z > 0)) return sum;
    const auto reflected = [&](const Vec3& to) { return f(localOf(n, to), wo); };
    for (std::size_t i = 0; i < light.lamps.size(); ++i) {
        const Light& lamp = light.lamps[i];
        const Vec3 to = lamp.directional ? lamp.position : glm::normalize(lamp.position - place);
        const double cosine = glm::dot(n, to);
        if (!(cosine > 0)) continue;
        const Vec3 source = lamp.directional ? place + 1e4 * to : lamp.position;
        if (light.shadowed[i] && scene_.nodes[end.at.node].receivesShadow && rays_.blocked(place, source, true))
            continue;
        sum += reflected(to) * lamp.color * (lightFalloff(lamp, place) * cosine);
    }
    for (const VirtualPointLight& v : light.virtuals) {
        const double share = virtualLightGeometry(v, place, n, light.near).x;
        if (share > 0 && !(light.virtualShadows && rays_.blocked(place, v.position, false)))
            sum += reflected(glm::normalize(v.place - place)) * v.power * (share / kPi);
    }
    return sum;
}

Image SpecularTracer::shade(std::span<const TracedEnd> ends, std::span<const SeenPoint> seen, const Image& picture,
                            const TracedLight& light, TracedReport* report, unsigned threads) const {
    require(seen.size() == static_cast<std::size_t>(picture.width()) * static_cast<std::size_t>(picture.height()),
            "traced pixels: expected a picture of the buffer's size");
    require(light.shadowed.size() == light.lamps.size(), "traced pixels: expected a mark for each lamp");
    const glm::dmat4 toClip =
        scene_.camera.projection(double(picture.width()) / picture.height()) * scene_.camera.view();
    std::vector<Rgb> radiance(ends.size(), Rgb(0));
    std::atomic<std::size_t> reused = 0;
    parallelFor(ends.size(), threads, [&](std::size_t i) {
        const TracedEnd& end = ends[i];
        if (!end.hit) {
            radiance[i] = scene_.sky.color;
            return;
        }
        std::optional<Rgb> there;
        if (diffuse_[static_cast<std::size_t>(scene_.nodes[end.at.node].material)] &&
            glm::dot(end.at.normal, end.direction) < 0)
            there = seenLight(end, seen, picture, toClip);
        if (there) ++reused;
        radiance[i] = there ? *there : ownLight(end, light);
    });
    Image out(picture.width(), picture.height(), 3);
    std::size_t hits = 0;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const int x = static_cast<int>(ends[i].pixel) % picture.width(),
                  y = picture.height() - 1 - static_cast<int>(ends[i].pixel) / picture.width();
        out.setRgb(x, y, out.rgb(x, y) + ends[i].share * radiance[i]);
        hits += ends[i].hit;
    }
    if (report != nullptr) {
        report->ends = ends.size();
        report->reused = hits > 0 ? static_cast<double>(reused) / static_cast<double>(hits) : 0;
        for (const SeenPoint& p : seen) report->pixels += p.normal.w != 0;
    }
    return out;
}

}  // namespace nacre
