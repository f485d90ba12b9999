#include "bench/environment_naive.hpp"

#include "core/error.hpp"
#include "core/sampling.hpp"

namespace nacre::bench {

CubePyramid::CubePyramid(EnvMap cube) {
    require(cube.layout == EnvLayout::Cube, "CubePyramid: expected a cube");
    levels_.push_back(std::move(cube));
    while (levels_.back().size() > 1) {
        const EnvMap& fine = levels_.back();
        EnvMap coarse(EnvLayout::Cube, fine.size() / 2);
        const int edge = coarse.size();
        for (int y = 0; y < 6 * edge; ++y)
            for (int x = 0; x < edge; ++x) {
                const int fx = 2 * x, fy = y / edge * fine.size() + 2 * (y % edge);
                coarse.image.setRgb(x, y,
                                    (fine.image.rgb(fx, fy) + fine.image.rgb(fx + 1, fy) + fine.image.rgb(fx, fy + 1) +
                                     fine.image.rgb(fx + 1, fy + 1)) /
                                        4.0);
            }
        levels_.push_back(std::move(coarse));
    }
}

Rgb CubePyramid::sample(const Vec3& direction, double lod) const {
    lod = std::clamp(lod, 0.0, static_cast<double>(levels_.size() - 1));
    const auto low = static_cast<std::size_t>(lod);
    const double share = lod - static_cast<double>(low);
    const Rgb fine = sampleEnv(levels_[low], direction);
    return share > 0 ? (1 - share) * fine + share * sampleEnv(levels_[low + 1], direction) : fine;
}

namespace {

/// A light direction about +z with its density [1/sr] and weight.
struct LobeSample {
    Vec3 l;
    double pdf = 0, weight = 1;
};

LobeSample drawSample(const Lobe& lobe, const Vec2& u) {
    const double phi = 2 * kPi * u.x;
    const auto direction = [phi](double cosine) {
        const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
        return Vec3(sine * std::cos(phi), sine * std::sin(phi), cosine);
    };
    switch (lobe.kind) {
        case LobeKind::Diffuse: {
            const double cosine = std::sqrt(1 - u.y);
            return {direction(cosine), cosine / kPi, 1};
        }
        case LobeKind::Phong: {
            const double cosine = std::pow(1 - u.y, 1 / (lobe.exponent + 1));
            return {direction(cosine), (lobe.exponent + 1) / (2 * kPi) * std::pow(cosine, lobe.exponent), 1};
        }
        case LobeKind::Ggx: {
            const double a2 = sqr(lobe.alpha), cosine = std::sqrt((1 - u.y) / (1 + (a2 - 1) * u.y));
            const Vec3 h = direction(cosine), l = 2 * cosine * h - Vec3(0, 0, 1);
            const double d = a2 / (kPi * sqr(sqr(cosine) * (a2 - 1) + 1));
            return {l, d / 4, std::max(0.0, l.z)};  // pdf = D cosθh / (4 v·h), v = n
        }
        default:
            break;
    }
    throw std::invalid_argument("importanceSampled: expected diffuse, phong or ggx, found " + toString(lobe.kind));
}

}  // namespace

Rgb importanceSampled(const CubePyramid& source, const Lobe& lobe, const Vec3& r, int count, bool filtered) {
    const Vec3 side = glm::normalize(glm::cross(std::abs(r.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0), r));
    const Mat3 frame(side, glm::cross(r, side), r);
    const double texel = 4 * kPi / (6.0 * sqr(source.size()));
    Rgb sum(0);
    double weights = 0;
    for (int i = 0; i < count; ++i) {
        const LobeSample s = drawSample(lobe, {(i + 0.5) / count, radicalInverse(static_cast<std::uint64_t>(i), 2)});
        if (s.weight <= 0) continue;
        const double lod = filtered ? 0.5 * std::log2(1 / (count * s.pdf * texel)) : 0;
        sum += s.weight * source.sample(frame * s.l, lod);
        weights += s.weight;
    }
    return weights > 0 ? sum / weights : source.sample(r, 0);
}

}  // namespace nacre::bench
