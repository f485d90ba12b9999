#include "reference/shadow_error.hpp"

#include <fmt/format.h>

#include <limits>

#include "core/error.hpp"
#include "core/parallel.hpp"

namespace nacre {
namespace {

constexpr int kGrid = 5;              ///< rays along an edge of a boundary's square
constexpr int kMostHits = 64;         ///< of a ray that looks for the pixel's surface
constexpr double kOffSurface = 1e-5;  ///< of the scene's size: single precision leaves positions 1e-7

Vec3 towards(const Light& light, const Vec3& p) {
    return light.directional ? light.position : glm::normalize(light.position - p);
}

/// The ray of a map coordinate, in the world; t is the depth along the layer's axis.
Ray mapRay(const ShadowView& view, int layer, const Vec2& map, double far) {
    const glm::dmat4 back = glm::inverse(glm::dmat4(shadowLayerFrame(view, layer)) * view.fromWorld);
    if (view.kind != ShadowKind::Directional) {
        const Vec3 d = view.kind == ShadowKind::DualParaboloid
                           ? Vec3(2.0 * map / view.scale, 1 - glm::dot(map, map) / sqr(view.scale)) /
                                 (1 + glm::dot(map, map) / sqr(view.scale))
                           : Vec3(map / view.scale, 1);
        return {Vec3(back[3]), glm::dmat3(back) * d, 0, far};
    }
    const Vec3& c = view.cascades[static_cast<std::size_t>(layer)];
    const Vec3 origin((map - Vec2(c)) / c.z, view.near);  // depths are counted from the view's near
    return {Vec3(back * Vec4(origin, 1)), glm::dmat3(back) * Vec3(0, 0, 1), 0, far - view.near};
}

double rounded(const DepthCode& code, const ShadowView& view, double z) {
    const double top = code.bits > 0 ? std::pow(2.0, code.bits) - 1 : 0;
    const auto round = [&](double d) { return top > 0 ? std::round(d * top) / top : d; };
    const double range = view.far - view.near;
    if (!code.hyperbolic) return round((z - view.near) / range);
    const double inverse = 1 / view.near - 1 / view.far, d = round((1 / view.near - 1 / z) / inverse);
    return (1 / (1 / view.near - d * inverse) - view.near) / range;
}

}  // namespace

ShadowTruth::ShadowTruth(const Mesh& mesh, const Camera& camera, const Light& light, const ShadowErrorOptions& options)
    : scene_(mesh), light_(light), options_(options) {
    require(options.width >= 1 && options.height >= 1, "ShadowTruth: a size is below 1");
    require(mesh.normals.size() == mesh.positions.size(), "ShadowTruth: expected a normal for each position");
    for (const glm::uvec3& t : mesh.triangles)
        require(std::max(t.x, std::max(t.y, t.z)) < mesh.positions.size(), "ShadowTruth: an index is out of range");
    checkCone(light);
    pixels_.resize(static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height));
    const double aspect = static_cast<double>(options.width) / options.height;
    const glm::dmat4 toWorld = glm::inverse(camera.view());
    const double y = camera.orthographic ? camera.height / 2 : std::tan(camera.fovY / 2);
    parallelFor(static_cast<std::size_t>(options.height), options.threads, [&](std::size_t row) {
        for (int x = 0; x < options.width; ++x) {
            const Vec2 at =
                Vec2(2 * (x + 0.5) / options.width - 1, 1 - 2 * (static_cast<double>(row) + 0.5) / options.height) *
                Vec2(y * aspect, y);
            const Vec3 o = camera.orthographic ? Vec3(at, 0) : Vec3(0);
            const Vec3 d = camera.orthographic ? Vec3(0, 0, -1) : Vec3(at, -1);
            pixels_[index(x, static_cast<int>(row))] =
                trace(mesh, {Vec3(toWorld * Vec4(o, 1)), Vec3(toWorld * Vec4(d, 0)), camera.near, camera.far});
        }
    });
}

ShadowTruth::Pixel ShadowTruth::trace(const Mesh& mesh, const Ray& ray) const {
    const RayHit hit = scene_.firstHit(ray);
    if (!hit.found) return {};
    const glm::uvec3& t = mesh.triangles[hit.triangle];
    const Vec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    const Vec3 shading = (1 - hit.u - hit.v) * Vec3(mesh.normals[t.x]) + hit.u * Vec3(mesh.normals[t.y]) +
                         hit.v * Vec3(mesh.normals[t.z]);
    Pixel out;
    out.position = (1 - hit.u - hit.v) * a + hit.u * b + hit.v * c;
    const Vec3 face = glm::cross(b - a, c - a), to = towards(light_, out.position);
    if (!(glm::dot(shading, ray.direction) < 0) || !(glm::dot(shading, to) > 0)) return {};
    if (!(lightFalloff(light_, out.position) > 0) || !(glm::length(face) > 0)) return {};
    out.normal = glm::normalize(glm::dot(face, ray.direction) < 0 ? face : -face);
    const bool behind = glm::dot(out.normal, to) <= 0;
    const double end = light_.directional ? std::numeric_limits<float>::max()
                                          : glm::length(light_.position - out.position) * (1 - kOffSurface);
    const Vec3 start = out.position + out.normal * (kOffSurface * scene_.size());
    out.truth = behind || scene_.occluded({start, to, 0, end}) ? ShadowPixel::Shadowed : ShadowPixel::Lit;
    return out;
}

/// Whether the surface under another ray of the light, the one nearest to the pixel's plane, is the first hit.
bool ShadowTruth::litThere(const Pixel& pixel, const Ray& fromLight) const {
    const double slope = glm::dot(pixel.normal, fromLight.direction);
    const double expected = glm::dot(pixel.normal, pixel.position - fromLight.origin) / slope;
    if (!(std::abs(slope) > 1e-9) || !(expected > 0)) return false;
    Ray ray = fromLight;
    double nearest = std::numeric_limits<double>::max();
    bool first = true;
    for (int i = 0; i < kMostHits; ++i) {
        const RayHit hit = scene_.firstHit(ray);
        if (!hit.found) break;
        const double off = std::abs(hit.t - expected);
        if (off >= nearest) break;  // hits come in order: from here on they are farther off
        nearest = off, first = i == 0;
        ray.near = hit.t * (1 + 1e-6) + 1e-6 * scene_.size() / glm::length(ray.direction);
    }
    return first;
}

bool ShadowTruth::atBoundary(const Pixel& pixel, const ShadowView& view) const {
    const ShadowPlace place = shadowPlace(view, pixel.position);
    const double far = 2 * (std::abs(view.near) + view.far) + 2 * scene_.size();
    for (int j = 0; j < kGrid; ++j)
        for (int i = 0; i < kGrid; ++i) {
            const Vec2 off = Vec2(i, j) / (kGrid - 1.0) * 2.0 - 1.0;  // of n/2 texels; a texel is 2/size wide
            const Ray ray =
                mapRay(view, place.layer,
                       place.map + off * static_cast<double>(view.filter) / static_cast<double>(view.size), far);
            if (litThere(pixel, ray) != (pixel.truth == ShadowPixel::Lit)) return true;
        }
    return false;
}

Image ShadowTruth::picture() const {
    Image out(options_.width, options_.height, 1);
    for (std::size_t i = 0; i < pixels_.size(); ++i)
        out.data()[i] = pixels_[i].truth == ShadowPixel::None ? 0.5f : pixels_[i].truth == ShadowPixel::Lit ? 1 : 0;
    return out;
}

Image ShadowTruth::judge(const Image& mask, const ShadowView& view) const {
    require(mask.width() == options_.width && mask.height() == options_.height,
            fmt::format("ShadowTruth: expected a mask of {} x {}, found {} x {}", options_.width, options_.height,
                        mask.width(), mask.height()));
    Image out(options_.width, options_.height, 1);
    parallelFor(static_cast<std::size_t>(options_.height), options_.threads, [&](std::size_t row) {
        for (int x = 0; x < options_.width; ++x) {
            const int y = static_cast<int>(row);
            const Pixel& pixel = pixels_[index(x, y)];
            const bool lit = pixel.truth == ShadowPixel::Lit;
            if (pixel.truth == ShadowPixel::None || (mask.at(x, y, 0) > 0.5) == lit) continue;
            out.at(x, y, 0) = atBoundary(pixel, view) ? 3 : lit ? 1 : 2;
        }
    });
    return out;
}

ShadowError ShadowTruth::compare(const Image& mask, const ShadowView& view) const {
    const Image judged = judge(mask, view);
    ShadowError out;
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        out.pixels += pixels_[i].truth != ShadowPixel::None;
        out.acne += judged.data()[i] == 1;
        out.leaks += judged.data()[i] == 2;
        out.boundary += judged.data()[i] == 3;
    }
    return out;
}

Image ShadowTruth::mask(const ShadowView& view, const std::vector<Image>& layers, int hyperbolicBits) const {
    Image out(options_.width, options_.height, 1);
    parallelFor(static_cast<std::size_t>(options_.height), options_.threads, [&](std::size_t row) {
        for (int x = 0; x < options_.width; ++x) {
            const int y = static_cast<int>(row);
            const Pixel& pixel = pixels_[index(x, y)];
            out.at(x, y, 0) = 0.5;
            if (pixel.truth == ShadowPixel::None) continue;
            if (hyperbolicBits == 0) {
                out.at(x, y, 0) = static_cast<float>(shadowLit(view, layers, pixel.position, pixel.normal));
                continue;
            }
            ShadowView there = view;  // dz = z² (1/near − 1/far) per unit of the code
            const double z = shadowPlace(view, pixel.position).q.z;
            there.resolution =
                view.resolution + 0.5 * z * z * (1 / view.near - 1 / view.far) / std::pow(2.0, hyperbolicBits);
            out.at(x, y, 0) = static_cast<float>(shadowLit(there, layers, pixel.position, pixel.normal));
        }
    });
    return out;
}

std::vector<Image> tracedShadowMap(const Mesh& mesh, const ShadowView& view, const DepthCode& code, unsigned threads) {
    require(view.kind != ShadowKind::DualParaboloid, "tracedShadowMap: no dual paraboloids");
    require(!code.hyperbolic || view.near > 0, "tracedShadowMap: a z-buffer needs near > 0");
    const EmbreeScene scene(mesh);
    std::vector<Image> out;
    for (int layer = 0; layer < view.layers(); ++layer) {
        Image& image = out.emplace_back(view.size, view.size, 1);
        parallelFor(static_cast<std::size_t>(view.size), threads, [&](std::size_t y) {
            for (int x = 0; x < view.size; ++x) {
                const Vec2 map((x + 0.5) * 2 / view.size - 1, (static_cast<double>(y) + 0.5) * 2 / view.size - 1);
                Ray ray = mapRay(view, layer, map, view.far);
                const double offset = view.kind == ShadowKind::Directional ? view.near : 0;
                ray.near = view.kind == ShadowKind::Directional ? 0 : view.near;
                const RayHit hit = scene.firstHit(ray);
                image.at(x, static_cast<int>(y), 0) =
                    hit.found ? static_cast<float>(rounded(code, view, hit.t + offset)) : 1.0f;
            }
        });
    }
    return out;
}

}  // namespace nacre
