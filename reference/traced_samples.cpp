#include "reference/traced_samples.hpp"

namespace nacre {

Vec3 turnedTo(const Vec3& n, const Vec3& d) {
    const Vec3 helper = std::abs(n.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 t = glm::normalize(glm::cross(helper, n)), b = glm::cross(n, t);
    return d.x * t + d.y * b + d.z * n;
}

std::pair<Vec3, double> lobeSample(const Lobe& lobe, const Vec3& r, const Vec2& u) {
    const double phi = 2 * kPi * u.y;
    const auto about = [&](double cosine) {
        const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
        return turnedTo(r, {sine * std::cos(phi), sine * std::sin(phi), cosine});
    };
    if (isMirror(lobe)) return {r, 1};
    if (lobe.kind == LobeKind::Diffuse) return {about(std::sqrt(u.x)), 1};
    if (lobe.kind == LobeKind::Phong) return {about(std::pow(1 - u.x, 1 / (lobe.exponent + 1))), 1};
    const bool beckmann = lobe.kind == LobeKind::Beckmann || lobe.kind == LobeKind::BeckmannRefraction;
    const double a2 = sqr(lobe.alpha), tan2 = beckmann ? -a2 * std::log1p(-u.x) : a2 * u.x / (1 - u.x);
    const double cosine = (1 - tan2) / (1 + tan2);  // of twice the half vector's angle
    return {about(cosine), std::max(0.0, cosine)};
}

}  // namespace nacre
