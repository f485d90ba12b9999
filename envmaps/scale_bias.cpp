#include "envmaps/scale_bias.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/fresnel.hpp"
#include "core/parallel.hpp"

namespace nacre {

static constexpr double kSmallest = 1e-4;  // of n·v and alpha: the limits at 0 are not reached by quadrature

/// Half vector visible from v at (a, b) of the unit square (Heitz 2018, section 3): a disk, seen from v, stretched.
static Vec3 visibleHalf(const Vec3& v, double alpha, double a, double b) {
    const Vec3 stretched = glm::normalize(Vec3(alpha * v.x, alpha * v.y, v.z));
    const double length2 = sqr(stretched.x) + sqr(stretched.y);
    const Vec3 t1 = length2 > 0 ? Vec3(-stretched.y, stretched.x, 0) / std::sqrt(length2) : Vec3(1, 0, 0);
    const Vec3 t2 = glm::cross(stretched, t1);
    const double r = std::sqrt(a), phi = 2 * kPi * b, x = r * std::cos(phi), s = 0.5 * (1 + stretched.z);
    const double y = (1 - s) * std::sqrt(std::max(0.0, 1 - x * x)) + s * r * std::sin(phi);
    const Vec3 h = x * t1 + y * t2 + std::sqrt(std::max(0.0, 1 - x * x - y * y)) * stretched;
    return glm::normalize(Vec3(alpha * h.x, alpha * h.y, std::max(0.0, h.z)));
}

static double lambda(double cosine, double alpha) {
    const double tan2 = std::max(0.0, 1 - cosine * cosine) / (cosine * cosine);
    return 0.5 * (std::sqrt(1 + alpha * alpha * tan2) - 1);
}

// Drawn by visible half vectors, the integrand is F · G2/G1(v) = F (1 + Λ(v))/(1 + Λ(v) + Λ(l)).
ScaleBias integrateScaleBias(double cosV, double alpha, int points) {
    require(cosV > 0 && cosV <= 1, fmt::format("scale-bias: expected n·v in (0, 1], found {}", cosV));
    require(alpha > 0 && alpha <= 1, fmt::format("scale-bias: expected alpha in (0, 1], found {}", alpha));
    require(points >= 1, "scale-bias: points must be >= 1");
    const Vec3 v(std::sqrt(1 - cosV * cosV), 0, cosV);
    const double lambdaV = lambda(cosV, alpha);
    ScaleBias out{0, 0};
    for (int i = 0; i < points; ++i)
        for (int j = 0; j < points; ++j) {
            // a = 1 − (1 − t)³: more points at the rim, where h is near the horizon and l about to fall below it.
            const double rest = 1 - (i + 0.5) / points;
            const Vec3 h = visibleHalf(v, alpha, 1 - rest * rest * rest, (j + 0.5) / points);
            const double voh = glm::dot(v, h), cosL = 2 * voh * h.z - v.z;
            if (cosL <= 0) continue;
            const double weight = 3 * sqr(rest) * (1 + lambdaV) / (1 + lambdaV + lambda(cosL, alpha)) / sqr(points);
            const double fresnel = schlickWeight(voh);
            out.scale += weight * (1 - fresnel);
            out.bias += weight * fresnel;
        }
    return out;
}

AssetTexture bakeScaleBias(int size, TexelFormat format, unsigned threads) {
    require(size >= 2 && size <= 1024, fmt::format("scale-bias: size must be 2 to 1024, found {}", size));
    Image image(size, size, 2);
    parallelFor(size, threads, [&](std::size_t y) {
        const double alpha = std::max(kSmallest, sqr(static_cast<double>(y) / (size - 1)));
        for (int x = 0; x < size; ++x) {
            const ScaleBias value = integrateScaleBias(std::max(kSmallest, sqr(x / (size - 1.0))), alpha);
            image.at(x, static_cast<int>(y), 0) = static_cast<float>(value.scale);
            image.at(x, static_cast<int>(y), 1) = static_cast<float>(value.bias);
        }
    });
    return makeTexture("scale_bias", "cos_perceptual", image, format);
}

ScaleBias lookupScaleBias(const AssetTexture& table, double cosV, double perceptualRoughness) {
    const float size = static_cast<float>(table.image.width());
    const auto place = [&](double c) { return (static_cast<float>(clamp01(c)) * (size - 1) + 0.5f) / size; };
    const glm::vec4 texel = table.bias + table.scale * sampleBilinear(table.image, place(std::sqrt(clamp01(cosV))),
                                                                      place(perceptualRoughness));
    return {texel.x, texel.y};
}

Rgb multipleScattering(const Rgb& f0, const ScaleBias& single) {
    const double missing = std::max(0.0, 1 - single.scale - single.bias);
    const Rgb once = f0 * single.scale + single.bias, average = f0 + (Rgb(1) - f0) / 21.0;
    return once + once * average * missing / (Rgb(1) - average * missing);
}

}  // namespace nacre
