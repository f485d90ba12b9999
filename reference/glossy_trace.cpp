#include "reference/glossy_trace.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/sampling.hpp"
#include "envmaps/spherical_harmonics.hpp"
#include "reference/embree_scene.hpp"
#include "reference/transfer_trace.hpp"

namespace nacre {

IsotropicBrdf phongLobe(double exponent) {
    require(std::isfinite(exponent) && exponent >= 0, "Phong's lobe: expected a finite exponent of 0 or more");
    return [exponent](const Vec3& wi, const Vec3& wo) {
        const double c = wi.z * wo.z - wi.x * wo.x - wi.y * wo.y;
        return c > 0 ? (exponent + 2) / (2 * kPi) * std::pow(c, exponent) : 0;
    };
}

std::vector<double> tracedGlossyTransfer(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> positions,
                                         std::span<const glm::vec3> normals, const Vec3& eye, const IsotropicBrdf& f,
                                         int order, std::size_t rays) {
    require(order >= 0 && rays >= 1, "traced transfer: expected an order of 0 or more and at least one ray");
    require(!positions.empty() && normals.size() == positions.size(), "traced transfer: expected a normal a position");
    const Mesh mesh = meshOfExtentOne(triangles, positions);
    const EmbreeScene scene(mesh);
    constexpr double kFar = 1e3;
    const std::size_t count = static_cast<std::size_t>((order + 1) * (order + 1));
    std::vector<double> out(positions.size() * count, 0);
    parallelFor(positions.size(), 0, [&](std::size_t v) {
        const Vec3 n = normals[v], toEye = eye - Vec3(positions[v]), p = Vec3(mesh.positions[v]) + kTransferLift * n;
        if (n == Vec3(0) || !(glm::dot(n, toEye) > 0)) return;
        const Vec3 side = std::abs(n.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
        const Vec3 t = glm::normalize(glm::cross(side, n)), b = glm::cross(n, t), o = glm::normalize(toEye);
        const Vec3 wo(glm::dot(o, t), glm::dot(o, b), glm::dot(o, n));
        const Vec2 shift(radicalInverse(v + 1, 3), radicalInverse(v + 1, 5));
        for (std::size_t k = 0; k < rays; ++k) {
            const Vec2 point =
                Vec2((static_cast<double>(k) + 0.5) / static_cast<double>(rays), radicalInverse(k, 2)) + shift;
            const Vec3 wi = cosineHemisphere(point - glm::floor(point)), s = wi.x * t + wi.y * b + wi.z * n;
            const double weight = kPi * f(wi, wo) / static_cast<double>(rays);
            if (weight == 0 || scene.occluded({p, s, 0, kFar})) continue;
            const std::vector<double> y = realHarmonics(order, s);
            for (std::size_t c = 0; c < count; ++c) out[v * count + c] += weight * y[c];
        }
    });
    return out;
}

}  // namespace nacre
