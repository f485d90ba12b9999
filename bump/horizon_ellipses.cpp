#include "bump/horizon_ellipses.hpp"

#include <fmt/format.h>

#include "bump/ellipse_fit.hpp"
#include "bump/sweep.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"

namespace nacre {
namespace {

constexpr float kCodes = 65535;  // horizons are kept as 16-bit radii while a map is fitted

}  // namespace

double ellipseValue(const HorizonEllipse& e, const Vec3& light) {
    const double x = e.m11 * light.x + e.m12 * light.y + e.o1, y = e.m12 * light.x + e.m22 * light.y + e.o2;
    return 1 - x * x - y * y;
}

HorizonEllipse ellipseFromAxes(const Vec2& centre, const Vec2& axis, double r1, double r2) {
    require(r1 > 0 && r2 > 0, fmt::format("ellipseFromAxes: expected radii > 0, found {} and {}", r1, r2));
    require(glm::length(axis) > 0, "ellipseFromAxes: expected an axis that is not 0");
    const Vec2 a = glm::normalize(axis);
    const double p = 1 / r1, q = 1 / r2;  // M = p a aᵀ + q (1 − a aᵀ)
    HorizonEllipse e{q + (p - q) * a.x * a.x, (p - q) * a.x * a.y, q + (p - q) * a.y * a.y, 0, 0};
    e.o1 = -(e.m11 * centre.x + e.m12 * centre.y);
    e.o2 = -(e.m12 * centre.x + e.m22 * centre.y);
    return e;
}

HorizonEllipse EllipseMap::at(int x, int y) const {
    return {shape.at(x, y, 0), shape.at(x, y, 1), shape.at(x, y, 2), offset.at(x, y, 0), offset.at(x, y, 1)};
}

EllipseMap fitEllipses(const HeightMap& map, const EllipseOptions& options) {
    validateHeightMap(map);
    require(options.directions >= 8,
            fmt::format("fitEllipses: expected 8 directions or more, found {}", options.directions));
    const EllipseFitter fitter(options.directions, options.fit);
    const std::size_t texels = map.heights.texelCount(), count = static_cast<std::size_t>(fitter.directions());
    std::vector<std::uint16_t> radii(texels * count);  // direction by direction
    SweepMemories memories;
    parallelFor(count, options.threads, [&](std::size_t k) {
        std::vector<float> slopes(texels);
        sweepHorizons(map, 2 * kPi * static_cast<double>(k) / static_cast<double>(count), 1, false, memories, slopes);
        for (std::size_t i = 0; i < texels; ++i)  // cosine of the horizon's elevation
            radii[k * texels + i] = static_cast<std::uint16_t>(kCodes / std::sqrt(1 + slopes[i] * slopes[i]) + 0.5f);
    });
    EllipseMap out{Image(map.width(), map.height(), 3), Image(map.width(), map.height(), 3)};
    parallelFor(static_cast<std::size_t>(map.height()), options.threads, [&](std::size_t y) {
        std::vector<float> lit(count);
        for (int x = 0; x < map.width(); ++x) {
            const std::size_t texel = y * static_cast<std::size_t>(map.width()) + static_cast<std::size_t>(x);
            double sky = 0;
            for (std::size_t k = 0; k < count; ++k) {
                lit[k] = static_cast<float>(radii[k * texels + texel]) / kCodes;
                sky += sqr(lit[k]) / static_cast<double>(count);
            }
            const HorizonEllipse e = fitter.fit(lit);
            const int row = static_cast<int>(y);
            out.shape.setRgb(x, row, {e.m11, e.m12, e.m22});
            out.offset.setRgb(x, row, {e.o1, e.o2, sky});
        }
    });
    return out;
}

}  // namespace nacre
