#include "shading/multipass/rough_face.hpp"

#include <algorithm>
#include <cmath>

namespace nacre {
namespace {

double random(std::uint64_t i) {  // SplitMix64
    std::uint64_t z = (i + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

/// Where a ray from the eye goes on at a facet; none: past the critical angle.
std::optional<Vec3> sentOn(const Vec3& v, const Vec3& facet, const std::optional<double>& eta) {
    const double cosine = glm::dot(v, facet);
    if (!eta) return 2 * cosine * facet - v;
    const double beyond2 = 1 - (1 - cosine * cosine) / (*eta * *eta);
    if (beyond2 <= 0) return {};
    return -v / *eta + (cosine / *eta - std::sqrt(beyond2)) * facet;
}

/// Share of the facets that a direction sees: Walter et al. 2007, the rational form behind equation 27.
double seen(double cosine, double alpha) {
    const double tangent = std::sqrt(std::max(0.0, 1 - cosine * cosine)) / std::abs(cosine);
    if (tangent * alpha * 1.6 <= 1) return 1;
    const double a = 1 / (alpha * tangent);
    return (3.535 * a + 2.181 * a * a) / (1 + 2.276 * a + 2.577 * a * a);
}

}  // namespace

Vec2 facetSample(int i, ShearSampling sampling) {
    const auto k = static_cast<std::uint64_t>(i);
    Vec2 u(random(2 * k), random(2 * k + 1));
    if (sampling == ShearSampling::LowDiscrepancy) {
        u = 0.5 + Vec2(0.7548776662466927, 0.5698402909980532) * double(i + 1);
        u -= glm::floor(u);
    }
    const double radius = std::sqrt(-2 * std::log1p(-u.x));
    return radius * Vec2(std::cos(2 * kPi * u.y), std::sin(2 * kPi * u.y));
}

FacetShear facetShear(const Vec3& towardsEye, const Plane& plane, const std::optional<double>& eta, double alpha,
                      const Vec2& gaussian) {
    const Vec3 front(plane), x = planeAxis(plane);
    const double side = glm::dot(front, towardsEye) > 0 ? 1 : -1;
    const Vec3 n = side * front, slopes = gaussian.x * x + gaussian.y * glm::cross(front, x);
    const Vec3 facet = glm::normalize(n + alpha * std::sqrt(0.5) * slopes);
    const double facing = glm::dot(towardsEye, facet), cosine = glm::dot(towardsEye, n);
    const std::optional<Vec3> smooth = sentOn(towardsEye, n, eta), rough = sentOn(towardsEye, facet, eta);
    if (facing <= 0 || cosine <= 0 || !smooth || !rough) return {};
    const double kept = eta ? -side : side;  // the side of the plane where the ray goes on
    const double ahead = kept * glm::dot(*rough, front), aheadSmooth = kept * glm::dot(*smooth, front);
    if (ahead <= 0 || aheadSmooth <= 0) return {};
    const Vec3 off = *rough / ahead - *smooth / aheadSmooth;
    FacetShear out;
    out.facet = facet;
    out.slope = -kept * Vec2(glm::dot(off, x), glm::dot(off, glm::cross(front, x)));
    out.weight = facing * seen(cosine, alpha) * seen(ahead, alpha) / (cosine * glm::dot(facet, n));  // equation 41
    return out;
}

}  // namespace nacre
