#include "reference/volume_trace.hpp"

#include <cmath>
#include <limits>
#include <optional>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "reference/camera_rays.hpp"

namespace nacre {
namespace {

constexpr double kStep = 1.0 / 8;     // [texels]
constexpr int kBisections = 40;       // to 1e-13 of a texel
constexpr double kShadowSkip = 1e-3;  // [texels] off the surface: the bisection ends inside by rounding

/// origin + t · direction in texel coordinates, from first to last.
struct TexelRay {
    Vec3 origin, direction;
    double first, last;

    Vec3 at(double t) const { return origin + t * direction; }
};

class Field {
public:
    explicit Field(const TracedVolume& surface)
        : volume_(surface.volume),
          iso_(surface.iso),
          toWorld_(surface.toWorld * volumeToLocal(surface.volume)),
          fromWorld_(glm::inverse(toWorld_)),
          normals_(glm::transpose(glm::inverse(glm::dmat3(surface.toWorld)))),
          gradients_(volumeGradients(surface.volume)) {}

    /// The first t in [near, far] inside the surface and the box.
    std::optional<double> firstInside(const Ray& ray) const {
        const std::optional<TexelRay> r = clipped(ray);
        if (!r) return {};
        if (above(*r, r->first)) return r->first;
        const double step = kStep / glm::length(r->direction);
        double before = r->first;
        while (before < r->last) {
            const double after = std::min(before + step, r->last);
            if (above(*r, after)) return bisected(*r, before, after);
            before = after;
        }
        return {};
    }
    double texelsPerUnit(const Vec3& direction) const {
        return glm::length(Vec3(fromWorld_ * Vec4(direction, 0)) * Vec3(volume_.size));
    }
    Vec3 outward(const Vec3& position, const Vec3& toEye) const {
        const Vec3 gradient = sampleGradients(volume_, gradients_, Vec3(fromWorld_ * Vec4(position, 1)));
        const Vec3 outward = -(normals_ * gradient);
        const double length = glm::length(outward);
        return length > 0 ? outward / length : toEye;
    }

private:
    bool above(const TexelRay& r, double t) const {
        return sampleVolume(volume_, r.at(t) / Vec3(volume_.size)) >= iso_;
    }
    double bisected(const TexelRay& r, double outside, double inside) const {
        for (int i = 0; i < kBisections; ++i) {
            const double middle = 0.5 * (outside + inside);
            (above(r, middle) ? inside : outside) = middle;
        }
        return inside;
    }
    std::optional<TexelRay> clipped(const Ray& ray) const {
        TexelRay r{Vec3(fromWorld_ * Vec4(ray.origin, 1)) * Vec3(volume_.size),
                   Vec3(fromWorld_ * Vec4(ray.direction, 0)) * Vec3(volume_.size), ray.near, ray.far};
        for (int c = 0; c < 3; ++c) {
            if (r.direction[c] == 0) {
                if (r.origin[c] < 0 || r.origin[c] > volume_.size[c]) return {};
                continue;
            }
            const double a = -r.origin[c] / r.direction[c], b = (volume_.size[c] - r.origin[c]) / r.direction[c];
            r.first = std::max(r.first, std::min(a, b));
            r.last = std::min(r.last, std::max(a, b));
        }
        if (!(r.first < r.last)) return {};
        return r;
    }

    const Volume& volume_;
    double iso_;
    glm::dmat4 toWorld_, fromWorld_;
    glm::dmat3 normals_;
    std::vector<glm::vec3> gradients_;
};

/// Any frame about n: a volume has no tangents.
Mat3 frameAbout(const Vec3& n) {
    const Vec3 t = glm::normalize(glm::cross(n, std::abs(n.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
    return {t, glm::cross(n, t), n};
}

Rgb shade(const Field& field, const Vec3& position, const Vec3& toEye, const std::vector<Light>& lights,
          const BrdfFunction& brdf, bool shadows) {
    const Mat3 toLocal = glm::transpose(frameAbout(field.outward(position, toEye)));
    const Vec3 wo = toLocal * toEye;
    Rgb sum(0);
    if (!(wo.z > 0)) return sum;
    for (const Light& light : lights) {
        const Vec3 offset = light.directional ? light.position : light.position - position;
        const double distance = glm::length(offset);
        const Vec3 l = offset / distance, wi = toLocal * l;
        if (!(wi.z > 0)) continue;
        const double skip = kShadowSkip / field.texelsPerUnit(l);
        const double end = light.directional ? std::numeric_limits<double>::max() : distance;
        if (shadows && field.firstInside({position, l, skip, end})) continue;
        sum += brdf(wi, wo) * light.color * (wi.z * lightFalloff(light, position));
    }
    return sum;
}

}  // namespace

RaytracedPicture traceVolume(const TracedVolume& surface, const Camera& camera, const std::vector<Light>& lights,
                             const BrdfFunction& brdf, const RaytraceOptions& options) {
    require(options.width >= 1 && options.height >= 1 && options.supersample >= 1, "traceVolume: a size is below 1");
    checkVolume(surface.volume);
    const Field field(surface);
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
