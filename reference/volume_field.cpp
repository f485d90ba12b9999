#include "reference/volume_field.hpp"

#include <algorithm>
#include <cmath>

namespace nacre {
namespace {

constexpr double kStep = 1.0 / 8;     // [texels]
constexpr int kBisections = 40;       // to 1e-13 of a texel
constexpr double kShadowSkip = 1e-3;  // [texels]: the bisection ends inside by rounding

const Volume& checked(const Volume& volume) {
    checkVolume(volume);
    return volume;
}

}  // namespace

/// origin + t · direction in texel coordinates, from first to last.
struct VolumeField::TexelRay {
    Vec3 origin, direction;
    double first, last;

    Vec3 at(double t) const { return origin + t * direction; }
};

VolumeField::VolumeField(const TracedVolume& surface)
    : volume_(checked(surface.volume)),
      iso_(surface.iso),
      toWorld_(surface.toWorld * volumeToLocal(surface.volume)),
      fromWorld_(glm::inverse(toWorld_)),
      normals_(glm::transpose(glm::inverse(glm::dmat3(surface.toWorld)))),
      gradients_(volumeGradients(surface.volume)) {}

std::optional<double> VolumeField::firstInside(const Ray& ray) const {
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

SurfacePoint VolumeField::at(const Vec3& position, const Vec3& toEye) const {
    const Vec3 gradient = sampleGradients(volume_, gradients_, Vec3(fromWorld_ * Vec4(position, 1)));
    const Vec3 outward = -(normals_ * gradient);
    const double length = glm::length(outward);
    const Vec3 n = length > 0 ? outward / length : toEye;
    const Vec3 t = glm::normalize(glm::cross(n, std::abs(n.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
    return {position, n, t, glm::cross(n, t), toEye};
}

double VolumeField::skip(const Vec3& direction) const {
    return kShadowSkip / glm::length(Vec3(fromWorld_ * Vec4(direction, 0)) * Vec3(volume_.size));
}

bool VolumeField::above(const TexelRay& r, double t) const {
    return sampleVolume(volume_, r.at(t) / Vec3(volume_.size)) >= iso_;
}

double VolumeField::bisected(const TexelRay& r, double outside, double inside) const {
    for (int i = 0; i < kBisections; ++i) {
        const double middle = 0.5 * (outside + inside);
        (above(r, middle) ? inside : outside) = middle;
    }
    return inside;
}

std::optional<VolumeField::TexelRay> VolumeField::clipped(const Ray& ray) const {
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

}  // namespace nacre
