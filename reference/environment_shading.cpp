#include "reference/environment_shading.hpp"

#include "core/parallel.hpp"

namespace nacre {

Vec3 mirrored(const Vec3& toEye, const Vec3& normal) { return 2 * glm::dot(normal, toEye) * normal - toEye; }

Vec3 refracted(const Vec3& toEye, const Vec3& normal, double ior) {
    const Vec3 along = toEye - glm::dot(toEye, normal) * normal;  // length = sine of the angle outside
    const Vec3 inside = -along / ior;
    const double cos2 = 1 - glm::dot(inside, inside);
    return cos2 < 0 ? Vec3(0) : inside - std::sqrt(cos2) * normal;
}

Rgb surroundedRadiance(const SurroundedSurface& surface, const Vec3& toEye, const Vec3& normal) {
    const double cosView = glm::dot(toEye, normal);
    if (!(cosView > 0)) return Rgb(0);
    const Rgb weight = surface.weight ? surface.weight(cosView) : Rgb(1);
    const Rgb mirror = surface.reflection ? surface.reflection(mirrored(toEye, normal)) : Rgb(0);
    Rgb rest(0);
    if (surface.transmission) {
        const Vec3 t = refracted(toEye, normal, surface.ior);
        if (t != Vec3(0)) rest += surface.transmission(t);
    }
    if (surface.diffuse) rest += surface.diffuse(normal);
    return weight * mirror + (surface.blend ? Rgb(1) - weight : Rgb(1)) * rest;
}

std::vector<Rgb> shadeSurrounded(const TracedSurface& traced, const SurroundedSurface& surface,
                                 const RadianceByDirection& sky, unsigned threads) {
    std::vector<Rgb> out(traced.points.size());
    parallelFor(out.size(), threads, [&](std::size_t i) {
        const SurfacePoint& p = traced.points[i];
        if (TracedSurface::hit(p))
            out[i] = surroundedRadiance(surface, p.toEye, p.normal);
        else
            out[i] = sky ? sky(traced.directions[i]) : Rgb(0);
    });
    return out;
}

}  // namespace nacre
