#include "reference/volume_trace.hpp"

#include <limits>
#include <optional>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "reference/camera_rays.hpp"

namespace nacre {
namespace {

Rgb shade(const VolumeField& field, const Vec3& position, const Vec3& toEye, const std::vector<Light>& lights,
          const BrdfFunction& brdf, bool shadows) {
    const SurfacePoint s = field.at(position, toEye);
    const Vec3 wo = toLocal(s, toEye);
    Rgb sum(0);
    if (!(wo.z > 0)) return sum;
    for (const Light& light : lights) {
        const Vec3 offset = light.directional ? light.position : light.position - position;
        const double distance = glm::length(offset);
        const Vec3 l = offset / distance, wi = toLocal(s, l);
        if (!(wi.z > 0)) continue;
        const double end = light.directional ? std::numeric_limits<double>::max() : distance;
        if (shadows && field.firstInside({position, l, field.skip(l), end})) continue;
        sum += brdf(wi, wo) * light.color * (wi.z * lightFalloff(light, position));
    }
    return sum;
}

}  // namespace

RaytracedPicture traceVolume(const TracedVolume& surface, const Camera& camera, const std::vector<Light>& lights,
                             const BrdfFunction& brdf, const RaytraceOptions& options) {
    require(options.width >= 1 && options.height >= 1 && options.supersample >= 1, "traceVolume: a size is below 1");
    const VolumeField field(surface);
    const CameraRays rays(camera, options.width, options.height, options.supersample);
    RaytracedPicture out{Image(options.width, options.height, 3), Image(options.width, options.height, 1)};
    parallelFor(static_cast<std::size_t>(options.height), options.threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < options.width; ++x) {
            Rgb sum(0);
            int hits = 0;
            for (int k = 0; k < rays.samples(); ++k) {
                const Ray ray = rays.at(x, y, k);
                const std::optional<double> t = field.firstInside(ray);
                hits += t.has_value();
                sum += t ? shade(field, ray.origin + *t * ray.direction, -glm::normalize(ray.direction), lights, brdf,
                                 options.shadows)
                         : options.background;
            }
            out.radiance.setRgb(x, y, sum / static_cast<double>(rays.samples()));
            out.coverage.at(x, y, 0) = static_cast<float>(hits) / static_cast<float>(rays.samples());
        }
    });
    return out;
}

}  // namespace nacre
