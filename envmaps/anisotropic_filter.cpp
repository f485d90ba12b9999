#include "envmaps/anisotropic_filter.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "envmaps/texel_points.hpp"

namespace nacre {

Vec3 lobeTangent(const Vec3& axis, const Vec3& r) {
    Vec3 t = axis - glm::dot(axis, r) * r;
    if (glm::length(t) < 1e-10 * glm::length(axis))
        t = glm::cross(r, std::abs(r.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 0, 1));
    return glm::normalize(t);
}

static int blockFor(const EnvMap& source, double alpha) {
    const double texel = kPi / 2 / (source.layout == EnvLayout::LatLong ? source.size() / 2.0 : source.size());
    for (int block = 8; block > 1; block /= 2)
        if (source.size() % block == 0 && block * texel <= 0.25 * alpha) return block;
    return 1;
}

EnvMap filterAnisotropic(const EnvMap& source, const Lobe& lobe, EnvLayout layout, int size, unsigned threads) {
    validateLobe(lobe);
    constexpr double kOffCentre = 1e-6;
    const int block = blockFor(source, std::min(lobe.alpha, lobe.alphaY));
    const std::vector<SpherePoint> points = blockPoints(source, block, kOffCentre, threads);
    const std::vector<Vec3> directions = texelDirections(layout, size, threads);
    EnvMap out(layout, size);
    parallelFor(directions.size(), threads, [&](std::size_t i) {
        const Vec3 r = directions[i], t = lobeTangent(lobe.axis, r), b = glm::cross(r, t);
        const Vec3 x = t / lobe.alpha, y = b / lobe.alphaY;
        Vec4 sum(0);
        for (const SpherePoint& p : points) {
            const double cosine = glm::dot(p.direction, r);
            if (cosine <= 0) continue;
            // D(h) ∝ (|h|²/((h·x)² + (h·y)² + (h·r)²))² for h = l + r; x and y are across r, so h·x = l·x.
            const double across = sqr(glm::dot(p.direction, x)) + sqr(glm::dot(p.direction, y));
            sum += sqr(2 * (1 + cosine) / (across + sqr(1 + cosine))) * cosine * p.weight;
        }
        for (int c = 0; c < 3; ++c) out.image.data()[3 * i + c] = static_cast<float>(sum[c] / sum.w);
    });
    return out;
}

}  // namespace nacre
