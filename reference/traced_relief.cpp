#include "reference/traced_relief.hpp"

#include "core/sampling.hpp"

namespace nacre {

Vec3 patchNormal(const HeightMap& map, const Vec2& p) {
    const Vec2 corner(std::floor(p.x - 0.5), std::floor(p.y - 0.5)), t = p - 0.5 - corner;
    const int i = static_cast<int>(corner.x), j = static_cast<int>(corner.y);
    const double h00 = map.at(i, j), h10 = map.at(i + 1, j), h01 = map.at(i, j + 1), h11 = map.at(i + 1, j + 1);
    const double dx = (1 - t.y) * (h10 - h00) + t.y * (h11 - h01), dy = (1 - t.x) * (h01 - h00) + t.x * (h11 - h10);
    return std::isfinite(dx) && std::isfinite(dy) ? glm::normalize(Vec3(-dx, -dy, 1)) : Vec3(0, 0, 1);
}

Rgb bounced(const ReliefTruth& relief, const SceneRelief& options, const Vec2& at, const Vec3& normal,
            const Vec3& light, int paths, PixelSequence starts, PixelRandom random) {
    const double height = heightAt(relief.map, at);
    if (std::isnan(height)) return Rgb(0);
    Rgb sum(0);
    for (int i = 0; i < paths; ++i) {
        Vec3 p(at, height), n = normal;
        Rgb carried = options.albedo;
        for (int k = 0; k < options.bounces; ++k) {
            const auto hit = firstHit(relief.rays, p, turnedTo(n, cosineHemisphere(k == 0 ? starts() : random.pair())));
            if (!hit) break;
            const double cosine = glm::dot(hit->normal, light);
            if (cosine > 0 && isLit(relief.rays, Vec2(hit->point), light))
                sum += carried * options.albedo * (cosine / kPi);
            carried *= options.albedo;
            p = hit->point, n = hit->normal;
        }
    }
    return sum / static_cast<double>(paths);
}

}  // namespace nacre
