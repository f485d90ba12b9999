#include "envmaps/texel_points.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"

namespace nacre {

std::vector<SpherePoint> texelPoints(const EnvMap& map, unsigned threads) { return blockPoints(map, 1, threads); }

std::vector<SpherePoint> blockPoints(const EnvMap& map, int block, unsigned threads) {
    require(block >= 1 && map.size() % block == 0, "blockPoints: the block must divide the map's size");
    const int size = map.size(), columns = map.image.width() / block, rows = map.image.height() / block;
    const std::vector<double> solidAngles = envSolidAngles(map.layout, size, threads);
    std::vector<SpherePoint> points(static_cast<std::size_t>(columns) * rows);
    parallelFor(rows, threads, [&](std::size_t row) {
        for (int column = 0; column < columns; ++column) {
            Vec3 middle(0);
            Vec4 weight(0);
            for (int j = 0; j < block; ++j)
                for (int i = 0; i < block; ++i) {
                    const int x = column * block + i, y = static_cast<int>(row) * block + j;
                    const double omega = solidAngles[static_cast<std::size_t>(y) * map.image.width() + x];
                    weight += omega * Vec4(map.image.rgb(x, y), 1);
                    middle += omega * envTexelDirection(map.layout, size, x, y);
                }
            const double length = glm::length(middle);
            points[row * columns + column] = {length > 0 ? middle / length : Vec3(0, 0, 1), weight};
        }
    });
    std::erase_if(points, [](const SpherePoint& p) { return p.weight.w == 0; });
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
