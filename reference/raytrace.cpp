#include "reference/raytrace.hpp"

#include <fmt/format.h>

#include <limits>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "reference/camera_rays.hpp"
#include "reference/embree_scene.hpp"

namespace nacre {

namespace {

class Renderer {
public:
    Renderer(const Mesh& mesh, const Camera& camera, const std::vector<Light>& lights, const BrdfFunction& brdf,
             const RaytraceOptions& options)
        : mesh_(mesh),
          lights_(lights),
          brdf_(brdf),
          options_(options),
          scene_(mesh),
          rays_(camera, options.width, options.height, options.supersample) {}

    void pixel(int x, int y, RaytracedPicture& out) const {
        const int n = options_.supersample;
        Rgb sum(0);
        int hits = 0;
        for (int i = 0; i < n * n; ++i) {
            const Ray ray = rays_.at(x, y, i);
            const RayHit hit = scene_.firstHit(ray);
            hits += hit.found;
            sum += hit.found ? radiance(surfaceAt(mesh_, hit, -glm::normalize(ray.direction))) : options_.background;
        }
        out.radiance.setRgb(x, y, sum / static_cast<double>(n * n));
        out.coverage.at(x, y, 0) = static_cast<float>(hits) / static_cast<float>(n * n);
    }

private:
    Rgb radiance(const SurfacePoint& s) const {
        const Vec3 wo = toLocal(s, s.toEye);
        Rgb sum(0);
        if (!(wo.z > 0)) return sum;
        for (const Light& light : lights_) {
            const Vec3 offset = light.directional ? light.position : light.position - s.position;
            const double distance = glm::length(offset);
            const Vec3 wi = toLocal(s, offset / distance);
            const double falloff = lightFalloff(light, s.position);
            if (!(wi.z > 0) || !(falloff > 0) || (options_.shadows && occluded(s, light, offset))) continue;
            sum += brdf_(wi, wo) * light.color * (wi.z * falloff);
        }
        return sum;
    }
    bool occluded(const SurfacePoint& s, const Light& light, const Vec3& offset) const {
        const double skip = 1e-5 * scene_.size();  // past the triangle itself: positions are single precision
        const double length = glm::length(offset);
        const double end = light.directional ? std::numeric_limits<float>::max() : length - skip;
        return scene_.occluded({s.position, offset / length, skip, end});
    }

    const Mesh& mesh_;
    const std::vector<Light>& lights_;
    const BrdfFunction& brdf_;
    const RaytraceOptions& options_;
    EmbreeScene scene_;
    CameraRays rays_;
};

void checkMesh(const Mesh& mesh) {
    const std::size_t n = mesh.positions.size();
    require(mesh.normals.size() == n && mesh.tangents.size() == n,
            fmt::format("raytrace: {} positions, but {} normals and {} tangents", n, mesh.normals.size(),
                        mesh.tangents.size()));
    for (const glm::vec3& p : mesh.positions) require(isFinite(Vec3(p)), "raytrace: a position is not finite");
    for (const glm::uvec3& t : mesh.triangles)
        require(std::max(t.x, std::max(t.y, t.z)) < n, fmt::format("raytrace: a triangle's index is not below {}", n));
}

}  // namespace

RaytracedPicture raytrace(const Mesh& mesh, const Camera& camera, const std::vector<Light>& lights,
                          const BrdfFunction& brdf, const RaytraceOptions& options) {
    require(options.width >= 1 && options.height >= 1 && options.supersample >= 1, "raytrace: a size is below 1");
    checkMesh(mesh);
    for (const Light& light : lights) checkCone(light);
    const Renderer renderer(mesh, camera, lights, brdf, options);
    RaytracedPicture out{Image(options.width, options.height, 3), Image(options.width, options.height, 1)};
    parallelFor(static_cast<std::size_t>(options.height), options.threads, [&](std::size_t y) {
        for (int x = 0; x < options.width; ++x) renderer.pixel(x, static_cast<int>(y), out);
    });
    return out;
}

TracedSurface traceSurface(const Mesh& mesh, const Camera& camera, const RaytraceOptions& options) {
    require(options.width >= 1 && options.height >= 1 && options.supersample >= 1, "traceSurface: a size is below 1");
    checkMesh(mesh);
    const EmbreeScene scene(mesh);
    const CameraRays rays(camera, options.width, options.height, options.supersample);
    const int samples = rays.samples();
    TracedSurface out{options.width, options.height, options.supersample, {}, {}};
    out.points.resize(static_cast<std::size_t>(options.width) * options.height * samples, SurfacePoint{});
    out.directions.resize(out.points.size());
    parallelFor(static_cast<std::size_t>(options.height), options.threads, [&](std::size_t y) {
        std::size_t at = y * options.width * samples;
        for (int x = 0; x < options.width; ++x)
            for (int k = 0; k < samples; ++k, ++at) {
                const Ray ray = rays.at(x, static_cast<int>(y), k);
                out.directions[at] = glm::normalize(ray.direction);
                const RayHit hit = scene.firstHit(ray);
                if (!hit.found) continue;
                out.points[at] = surfaceAt(mesh, hit, -out.directions[at]);
            }
    });
    return out;
}

RaytracedPicture assemblePicture(const TracedSurface& surface, const std::vector<Rgb>& radiance) {
    require(radiance.size() == surface.points.size(),
            fmt::format("assemblePicture: {} samples, but {} radiances", surface.points.size(), radiance.size()));
    const int samples = surface.supersample * surface.supersample;
    RaytracedPicture out{Image(surface.width, surface.height, 3), Image(surface.width, surface.height, 1)};
    std::size_t at = 0;
    for (int y = 0; y < surface.height; ++y)
        for (int x = 0; x < surface.width; ++x) {
            Rgb sum(0);
            int hits = 0;
            for (int k = 0; k < samples; ++k, ++at) {
                sum += radiance[at];
                hits += TracedSurface::hit(surface.points[at]);
            }
            out.radiance.setRgb(x, y, sum / static_cast<double>(samples));
            out.coverage.at(x, y, 0) = static_cast<float>(hits) / static_cast<float>(samples);
        }
    return out;
}

}  // namespace nacre
