#include "bump/normals.hpp"

#include "core/parallel.hpp"

namespace nacre {

namespace {

/// Slopes' first and second moments of the texels under a texel, and how much area they have.
struct Moments {
    Vec2 mean{0};
    double square = 0;  ///< of x plus of y
    double area = 0;
};

struct Level {
    int width = 0, height = 0;
    std::vector<Moments> texels;
    Moments& at(int x, int y) { return texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x]; }
    const Moments& at(int x, int y) const {
        return texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x];
    }
};

/// The gradient that the patch between texel (i, j) and (i + a, j + b) has at (i, j); false when it has a hole.
bool patchSlope(const HeightMap& map, int i, int j, int a, int b, Vec2& slope) {
    const double own = map.at(i, j), x = map.at(i + a, j), y = map.at(i, j + b);
    slope = {(x - own) * a, (y - own) * b};
    return !std::isnan(slope.x) && !std::isnan(slope.y) && !std::isnan(map.at(i + a, j + b));
}

Vec2 slopeAt(const HeightMap& map, int i, int j) {
    Vec2 sum(0), slope;
    int patches = 0;
    for (const int b : {-1, 1})
        for (const int a : {-1, 1})
            if (patchSlope(map, i, j, a, b, slope)) sum += slope, ++patches;
    return patches ? sum / static_cast<double>(patches) : Vec2(0);
}

Level finest(const HeightMap& map, unsigned threads) {
    const Image slopes = surfaceSlopes(map, threads);
    Level out{map.width(), map.height(), std::vector<Moments>(map.heights.texelCount())};
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) {
            const Vec2 s(slopes.at(x, y, 0), slopes.at(x, y, 1));
            out.at(x, y) = {s, glm::dot(s, s), std::isnan(map.heights.at(x, y, 0)) ? 0.0 : 1.0};
        }
    return out;
}

/// Mean over the columns and rows of `from` under texel (x, y) of a level of w × h, each by the area they share.
Moments meanUnder(const Level& from, int w, int h, int x, int y) {
    const auto shared = [](int i, int n, int k, int m) {  // of texel i of n with texel k of m, in texels of n, times m
        const std::int64_t low = std::max(std::int64_t{i} * m, std::int64_t{k} * n);
        const std::int64_t high = std::min((std::int64_t{i} + 1) * m, (std::int64_t{k} + 1) * n);
        return static_cast<double>(high - low) / m;
    };
    const auto first = [](int k, int n, int m) { return static_cast<int>(std::int64_t{k} * n / m); };
    const auto last = [](int k, int n, int m) { return static_cast<int>(((std::int64_t{k} + 1) * n + m - 1) / m); };
    Moments sum;
    for (int j = first(y, from.height, h); j < last(y, from.height, h); ++j)
        for (int i = first(x, from.width, w); i < last(x, from.width, w); ++i) {
            const Moments& m = from.at(i, j);
            const double area = m.area * shared(i, from.width, x, w) * shared(j, from.height, y, h);
            sum.mean += area * m.mean;
            sum.square += area * m.square;
            sum.area += area;
        }
    if (sum.area > 0) sum.mean /= sum.area, sum.square /= sum.area;
    return sum;
}

Level coarser(const Level& from, unsigned threads) {
    Level out{std::max(1, from.width / 2), std::max(1, from.height / 2), {}};
    out.texels.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
    parallelFor(static_cast<std::size_t>(out.height), threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < out.width; ++x) out.at(x, y) = meanUnder(from, out.width, out.height, x, y);
    });
    return out;
}

Image normalsOf(const Level& level, bool roughness) {
    Image out(level.width, level.height, roughness ? 4 : 3);
    for (int y = 0; y < level.height; ++y)
        for (int x = 0; x < level.width; ++x) {
            const Moments& m = level.at(x, y);
            out.setRgb(x, y, glm::normalize(Vec3(-m.mean.x, -m.mean.y, 1)));
            // 2 σ² with σ² the mean of the two axes' variances: their sum.
            if (roughness)
                out.at(x, y, 3) = static_cast<float>(std::sqrt(std::max(0.0, m.square - glm::dot(m.mean, m.mean))));
        }
    return out;
}

}  // namespace

Image surfaceSlopes(const HeightMap& map, unsigned threads) {
    validateHeightMap(map);
    Image out(map.width(), map.height(), 2);
    parallelFor(static_cast<std::size_t>(map.height()), threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < map.width(); ++x) {
            const Vec2 slope = slopeAt(map, x, y);
            out.at(x, y, 0) = static_cast<float>(slope.x);
            out.at(x, y, 1) = static_cast<float>(slope.y);
        }
    });
    return out;
}

NormalMap makeNormals(const HeightMap& map, const NormalOptions& options) {
    Level level = finest(map, options.threads);
    NormalMap out;
    out.levels.push_back(normalsOf(level, options.roughness));
    while (options.levels && (level.width > 1 || level.height > 1)) {
        level = coarser(level, options.threads);
        out.levels.push_back(normalsOf(level, options.roughness));
    }
    return out;
}

}  // namespace nacre
