#include "envmaps/convert.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "envmaps/texel_grid.hpp"

namespace nacre {

using footprint::clipSphere;
using footprint::Footprints;
using footprint::SpherePolygon;

namespace {

/// How a DualParaboloid's texel lies to the rim.
enum class Rim { Inside, Across, Beyond };

Rim rimOf(int size, int x, int y) {
    if (size == 1) return Rim::Across;
    const auto coordinate = [&](int position) { return 2 * (position - 0.5) / (size - 1) - 1; };
    const double x0 = coordinate(x), x1 = coordinate(x + 1), y0 = coordinate(y % size), y1 = coordinate(y % size + 1);
    const double nearX = x0 > 0 ? x0 : std::min(x1, 0.0), nearY = y0 > 0 ? y0 : std::min(y1, 0.0);
    const double farX = std::max(std::abs(x0), std::abs(x1)), farY = std::max(std::abs(y0), std::abs(y1));
    static constexpr double kTouching = 1e-9;
    if (farX * farX + farY * farY <= 1 + kTouching) return Rim::Inside;
    return nearX * nearX + nearY * nearY >= 1 - kTouching ? Rim::Beyond : Rim::Across;
}

/// Every texel's overlap with the map, before the seams are shared.
std::vector<Overlap> overlaps(const EnvMap& map, EnvLayout layout, int size, const Mat3& toMap, unsigned threads) {
    const TexelGrid grid(map);
    const Footprints footprints(layout, size);
    const glm::ivec2 extent = envExtent(layout, size);
    std::vector<Overlap> out(static_cast<std::size_t>(extent.x) * extent.y);
    const bool turned = toMap != Mat3(1);
    parallelFor(extent.y, threads, [&](std::size_t row) {
        TexelGrid::Scratch scratch;
        std::vector<SpherePolygon> pieces;
        SpherePolygon cut;
        const int y = static_cast<int>(row);
        for (int x = 0; x < extent.x; ++x) {
            pieces.clear();
            footprints.append(x, y, pieces);
            const bool across = layout == EnvLayout::DualParaboloid && rimOf(size, x, y) == Rim::Across;
            Overlap& sum = out[row * extent.x + x];
            for (SpherePolygon& piece : pieces) {
                if (across) {
                    clipSphere(piece, {0, 0, y < size ? 1 : -1}, cut);
                    std::swap(piece, cut);
                }
                if (turned)
                    for (Vec3& p : piece) p = toMap * p;
                if (piece.size() >= 3) sum += grid.overlap(piece, scratch);
            }
        }
    });
    return out;
}

/// Texels on either side of a seam get the average over both. \return what texel (x, y) shares with
std::vector<glm::ivec2> partners(EnvLayout layout, int size, int x, int y) {
    if (size == 1) return {};
    const int last = size - 1;
    if (layout == EnvLayout::DualParaboloid && rimOf(size, x, y) == Rim::Across) return {{x, (y + size) % (2 * size)}};
    if (layout != EnvLayout::Octahedral) return {};
    const bool sideX = x == 0 || x == last, sideY = y == 0 || y == last;
    if (sideX && sideY) return {{last - x, y}, {x, last - y}, {last - x, last - y}};
    if (sideY) return {{last - x, y}};
    if (sideX) return {{x, last - y}};
    return {};
}

EnvMap averaged(const EnvMap& map, EnvLayout layout, int size, const Mat3& toMap, unsigned threads) {
    const std::vector<Overlap> parts = overlaps(map, layout, size, toMap, threads);
    EnvMap out(layout, size);
    const int width = out.image.width();
    const auto part = [&](int x, int y) { return parts[static_cast<std::size_t>(y) * width + x]; };
    for (int y = 0; y < out.image.height(); ++y)
        for (int x = 0; x < width; ++x) {
            Overlap sum = part(x, y);
            for (const glm::ivec2& other : partners(layout, size, x, y)) sum += part(other.x, other.y);
            out.image.setRgb(x, y, sum.radiance / sum.solidAngle);
        }
    return out;
}

/// The same texels in other places: source(x, y) says where each comes from.
template <typename Source>
EnvMap permuted(const EnvMap& map, Source&& source) {
    EnvMap out(map.layout, map.size());
    for (int y = 0; y < out.image.height(); ++y)
        for (int x = 0; x < out.image.width(); ++x) {
            const glm::ivec2 from = source(x, y);
            out.image.setRgb(x, y, map.image.rgb(from.x, from.y));
        }
    return out;
}

glm::ivec2 cubeTexelOf(int size, const Vec3& direction) {
    const glm::dvec2 p = envPosition(EnvLayout::Cube, size, direction);
    return {static_cast<int>(p.x), static_cast<int>(p.y)};
}

}  // namespace

EnvMap convertEnv(const EnvMap& map, EnvLayout layout, int size, unsigned threads) {
    require(!map.image.empty() && size >= 1, "convertEnv: empty map, or size < 1");
    if (map.layout == layout && map.size() == size) return map;
    return averaged(map, layout, size, Mat3(1), threads);
}

EnvMap rotateEnv(const EnvMap& map, double yaw, unsigned threads) {
    require(!map.image.empty() && std::isfinite(yaw), "rotateEnv: empty map, or yaw not finite");
    if (yaw == 0) return map;
    const double c = std::cos(yaw), s = std::sin(yaw);  // toMap turns by −yaw: +x comes back to +z
    return averaged(map, map.layout, map.size(), Mat3(c, 0, s, 0, 1, 0, -s, 0, c), threads);
}

EnvMap mirrorEnvX(const EnvMap& map) {
    const int size = map.size(), width = map.image.width();
    if (map.layout != EnvLayout::Cube) return permuted(map, [&](int x, int y) { return glm::ivec2(width - 1 - x, y); });
    return permuted(map, [&](int x, int y) {
        const Vec3 d = envTexelDirection(EnvLayout::Cube, size, x, y);
        return cubeTexelOf(size, {-d.x, d.y, d.z});
    });
}

EnvMap mirrorEnvY(const EnvMap& map) {
    const int size = map.size();
    if (map.layout != EnvLayout::Cube)
        return permuted(map, [&](int x, int y) { return glm::ivec2(x, y / size * size + size - 1 - y % size); });
    return permuted(map, [&](int x, int y) {
        const Vec3 d = envTexelDirection(EnvLayout::Cube, size, x, y);
        return cubeTexelOf(size, {d.x, -d.y, d.z});
    });
}

int matchingSize(const EnvMap& map, EnvLayout layout) {
    // Texels over a quarter turn: a cube's face has N, the others N/2.
    if (map.layout == layout) return map.size();
    const int quarter = map.layout == EnvLayout::Cube ? map.size() : (map.size() + 1) / 2;
    return layout == EnvLayout::Cube ? quarter : 2 * quarter;
}

Rgb envEnergy(const EnvMap& map, unsigned threads) {
    const std::vector<double> solidAngles = envSolidAngles(map.layout, map.size(), threads);
    Rgb sum(0);
    for (int y = 0; y < map.image.height(); ++y)
        for (int x = 0; x < map.image.width(); ++x) {
            const double solidAngle = solidAngles[static_cast<std::size_t>(y) * map.image.width() + x];
            if (solidAngle > 0) sum += map.image.rgb(x, y) * solidAngle;  // texels beyond a rim count nothing
        }
    return sum;
}

}  // namespace nacre
