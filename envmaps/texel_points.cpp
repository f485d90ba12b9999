#include "envmaps/texel_points.hpp"

#include <cmath>
#include <span>

#include "core/error.hpp"
#include "core/parallel.hpp"

namespace nacre {

namespace {

double lightOf(const SpherePoint& p) { return std::abs(p.weight.x) + std::abs(p.weight.y) + std::abs(p.weight.z); }

SpherePoint merged(std::span<const SpherePoint> texels) {
    Vec3 middle(0);
    Vec4 weight(0);
    for (const SpherePoint& p : texels) {
        weight += p.weight;
        middle += p.weight.w * p.direction;
    }
    const double length = glm::length(middle);
    return {length > 0 ? middle / length : texels.front().direction, weight};
}

double offCentreLight(std::span<const SpherePoint> texels, const Vec3& middle) {
    Vec3 sum(0);
    for (const SpherePoint& p : texels) sum += lightOf(p) * (p.direction - middle);
    return glm::length(sum);
}

}  // namespace

std::vector<SpherePoint> texelPoints(const EnvMap& map, unsigned threads) {
    const std::vector<double> solidAngles = envSolidAngles(map.layout, map.size(), threads);
    const int width = map.image.width();
    std::vector<SpherePoint> points(solidAngles.size());
    parallelFor(map.image.height(), threads, [&](std::size_t row) {
        for (int x = 0; x < width; ++x) {
            const std::size_t i = row * width + x;
            const int y = static_cast<int>(row);
            points[i] = {envTexelDirection(map.layout, map.size(), x, y),
                         solidAngles[i] * Vec4(map.image.rgb(x, y), 1)};
        }
    });
    std::erase_if(points, [](const SpherePoint& p) { return p.weight.w == 0; });
    return points;
}

std::vector<SpherePoint> blockPoints(const EnvMap& map, int block, double offCentre, unsigned threads) {
    require(block >= 1 && map.size() % block == 0, "blockPoints: the block must divide the map's size");
    if (block == 1) return texelPoints(map, threads);
    const int size = map.size(), width = map.image.width(), rows = map.image.height() / block;
    const std::vector<double> solidAngles = envSolidAngles(map.layout, size, threads);
    const double allLight = parallelSum(rows, threads, [&](std::size_t row) {
        double sum = 0;
        for (std::size_t i = row * block * width; i < (row + 1) * block * width; ++i)
            for (int c = 0; c < 3; ++c) sum += solidAngles[i] * std::abs(map.image.data()[3 * i + c]);
        return sum;
    });
    std::vector<std::vector<SpherePoint>> parts(rows);
    parallelFor(rows, threads, [&](std::size_t row) {
        std::vector<SpherePoint> texels;
        for (int column = 0; column < width / block; ++column) {
            texels.clear();
            for (int k = 0; k < block * block; ++k) {
                const int x = column * block + k % block, y = static_cast<int>(row) * block + k / block;
                const double omega = solidAngles[static_cast<std::size_t>(y) * width + x];
                if (omega > 0)
                    texels.push_back({envTexelDirection(map.layout, size, x, y), omega * Vec4(map.image.rgb(x, y), 1)});
            }
            if (texels.empty()) continue;
            const SpherePoint middle = merged(texels);
            if (offCentreLight(texels, middle.direction) > offCentre * allLight)
                parts[row].insert(parts[row].end(), texels.begin(), texels.end());
            else
                parts[row].push_back(middle);
        }
    });
    std::vector<SpherePoint> points;
    for (const std::vector<SpherePoint>& part : parts) points.insert(points.end(), part.begin(), part.end());
    return points;
}

std::vector<Vec3> texelDirections(EnvLayout layout, int size, unsigned threads) {
    const glm::ivec2 extent = envExtent(layout, size);
    std::vector<Vec3> out(static_cast<std::size_t>(extent.x) * extent.y);
    parallelFor(extent.y, threads, [&](std::size_t row) {
        for (int x = 0; x < extent.x; ++x)
            out[row * extent.x + x] = envTexelDirection(layout, size, x, static_cast<int>(row));
    });
    return out;
}

}  // namespace nacre
