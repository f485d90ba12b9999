#include "bump/bump_levels.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/sampling.hpp"

namespace nacre {
namespace {

constexpr int kDirections = 48;
using Shares = std::array<float, kDirections>;  // of the area under a texel, lit from each direction

/// The texels of n under texel k of m, with the area that each shares, in texels of n.
struct Under {
    int first = 0, last = 0;  // last + 1
    int n = 1, k = 0, m = 1;
    Under(int n_, int k_, int m_)
        : first(static_cast<int>(std::int64_t{k_} * n_ / m_)),
          last(static_cast<int>(((std::int64_t{k_} + 1) * n_ + m_ - 1) / m_)),
          n(n_),
          k(k_),
          m(m_) {}
    float area(int i) const {
        const std::int64_t low = std::max(std::int64_t{i} * m, std::int64_t{k} * n);
        const std::int64_t high = std::min((std::int64_t{i} + 1) * m, (std::int64_t{k} + 1) * n);
        return static_cast<float>(high - low) / static_cast<float>(n);
    }
};

/// visit(x, y, share) for each texel under (x, y) of the next level; the shares' sum is 1.
template <class Visit>
void forEachUnder(int width, int height, int x, int y, Visit visit) {
    const Under columns(width, x, std::max(1, width / 2)), rows(height, y, std::max(1, height / 2));
    for (int j = rows.first; j < rows.last; ++j)
        for (int i = columns.first; i < columns.last; ++i) visit(i, j, columns.area(i) * rows.area(j));
}

Image halved(const Image& image) {
    Image out(std::max(1, image.width() / 2), std::max(1, image.height() / 2), image.channels());
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x)
            forEachUnder(image.width(), image.height(), x, y, [&](int i, int j, float share) {
                for (int c = 0; c < out.channels(); ++c) out.at(x, y, c) += share * image.at(i, j, c);
            });
    return out;
}

/// Drawn by the cosine: even on the disk.
struct Lights {
    std::array<float, kDirections> x, y;
    Lights() {
        for (int i = 0; i < kDirections; ++i) {
            const auto n = static_cast<std::uint64_t>(i) + 1;
            const Vec3 d = cosineHemisphere({(i + 0.5) / kDirections, radicalInverse(n, 2)});
            x[static_cast<std::size_t>(i)] = static_cast<float>(d.x);
            y[static_cast<std::size_t>(i)] = static_cast<float>(d.y);
        }
    }
};

/// |M l + o|² for each light.
Shares squares(const Image& shape, const Image& offset, int x, int y, const Lights& lights) {
    const float m11 = shape.at(x, y, 0), m12 = shape.at(x, y, 1), m22 = shape.at(x, y, 2);
    const float o1 = offset.at(x, y, 0), o2 = offset.at(x, y, 1);
    Shares out;
    for (std::size_t i = 0; i < kDirections; ++i) {
        const float p = m11 * lights.x[i] + m12 * lights.y[i] + o1, q = m12 * lights.x[i] + m22 * lights.y[i] + o2;
        out[i] = p * p + q * q;
    }
    return out;
}

struct Fit {
    float scale = 1, spread = 0;
};

/// Least squares of 1/2 + (1 − k² q)/(2 w) within [0, 1] over a grid; the first of equals, so that k = 1 wins.
Fit fit(const Shares& q, const Shares& wanted) {
    static constexpr std::array<float, 11> kScales = {1, 1.1f, 0.91f, 1.21f, 0.83f, 1.4f, 0.7f, 1.7f, 0.6f, 2, 0.5f};
    static constexpr std::array<float, 9> kSpreads = {0.05f, 0.1f, 0.2f, 0.35f, 0.6f, 1, 1.7f, 3, 6};
    Fit best;
    float least = 2 * kDirections;
    for (const float w : kSpreads)
        for (const float k : kScales) {
            const float start = 0.5f + 0.5f / w, slope = 0.5f * k * k / w;
            Shares error;
            for (std::size_t i = 0; i < kDirections; ++i) {
                const float share = std::min(1.0f, std::max(0.0f, start - slope * q[i]));
                error[i] = (share - wanted[i]) * (share - wanted[i]);
            }
            float sum = 0;
            for (const float e : error) sum += e;
            if (sum < least) least = sum, best = {k, w};
        }
    return best;
}

/// Means of M and o under each texel, and its lit shares.
struct Means {
    Image shape, offset;
    std::vector<Shares> lit;
};

/// The finest level has no stored shares: they are made on the way.
std::vector<Shares> sharesUnder(const Means& from, int width, int height, const Lights& lights, unsigned threads) {
    std::vector<Shares> out(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const int w = from.shape.width();
    parallelFor(static_cast<std::size_t>(height), threads, [&](std::size_t y) {
        for (int x = 0; x < width; ++x) {
            Shares sum{};
            forEachUnder(w, from.shape.height(), x, static_cast<int>(y), [&](int i, int j, float share) {
                if (from.lit.empty()) {
                    const Shares q = squares(from.shape, from.offset, i, j, lights);
                    for (std::size_t d = 0; d < kDirections; ++d) sum[d] += q[d] <= 1 ? share : 0;
                } else {
                    const Shares& lit = from.lit[static_cast<std::size_t>(j) * static_cast<std::size_t>(w) +
                                                 static_cast<std::size_t>(i)];
                    for (std::size_t d = 0; d < kDirections; ++d) sum[d] += share * lit[d];
                }
            });
            out[y * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] = sum;
        }
    });
    return out;
}

EllipseLevel fitted(const Means& means, const Lights& lights, unsigned threads) {
    const int width = means.shape.width(), height = means.shape.height();
    EllipseLevel out{Image(width, height, 4), means.offset};
    parallelFor(static_cast<std::size_t>(height), threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < width; ++x) {
            const std::size_t i = row * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
            const Fit f = fit(squares(means.shape, means.offset, x, y, lights), means.lit[i]);
            for (int c = 0; c < 3; ++c) out.shape.at(x, y, c) = f.scale * means.shape.at(x, y, c);
            for (int c = 0; c < 2; ++c) out.offset.at(x, y, c) = f.scale * means.offset.at(x, y, c);
            out.shape.at(x, y, 3) = f.spread;
        }
    });
    return out;
}

Image withSpread(const Image& shape) {
    Image out(shape.width(), shape.height(), 4);
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x) out.setRgb(x, y, shape.rgb(x, y));
    return out;
}

bool isSmallest(const Image& image) { return image.width() == 1 && image.height() == 1; }

}  // namespace

double litShare(double value, double spread) {
    if (spread <= 0) return value >= 0 ? 1 : 0;
    return std::clamp(0.5 + 0.5 * value / spread, 0.0, 1.0);
}

double bumpedAlpha(double material, double relief) { return std::hypot(material, relief); }

std::vector<EllipseLevel> ellipseLevels(const EllipseMap& map, unsigned threads) {
    require(!map.shape.empty() && map.shape.channels() == 3 && map.offset.channels() == 3 &&
                map.shape.width() == map.offset.width() && map.shape.height() == map.offset.height(),
            "ellipseLevels: expected two images of three channels and one size");
    const Lights lights;
    std::vector<EllipseLevel> out{{withSpread(map.shape), map.offset}};
    Means means{map.shape, map.offset, {}};
    while (!isSmallest(means.shape)) {
        Means next{halved(means.shape), halved(means.offset), {}};
        next.lit = sharesUnder(means, next.shape.width(), next.shape.height(), lights, threads);
        means = std::move(next);
        out.push_back(fitted(means, lights, threads));
    }
    return out;
}

std::vector<HorizonLevel> horizonLevels(const HorizonMap& map, unsigned threads) {
    require(map.azimuths() >= 1, "horizonLevels: expected azimuths, found none");
    const auto count = static_cast<std::size_t>(map.azimuths());
    const Image& first = map.elevation[0];
    std::vector<HorizonLevel> out{{map.elevation, Image(first.width(), first.height(), 1)}};
    std::vector<Image> square(count);  // means of the elevations' squares
    for (std::size_t k = 0; k < count; ++k) {
        square[k] = map.elevation[k];
        for (float& e : square[k].data()) e *= e;
    }
    while (!isSmallest(out.back().spread)) {
        HorizonLevel next{std::vector<Image>(count), {}};
        parallelFor(count, threads, [&](std::size_t k) {
            next.elevation[k] = halved(out.back().elevation[k]);
            square[k] = halved(square[k]);
        });
        next.spread = Image(square[0].width(), square[0].height(), 1);
        for (std::size_t i = 0; i < next.spread.data().size(); ++i) {
            double variance = 0;
            for (std::size_t k = 0; k < count; ++k) {
                const double mean = next.elevation[k].data()[i];
                variance += std::max(0.0, square[k].data()[i] - mean * mean) / static_cast<double>(count);
            }
            next.spread.data()[i] = static_cast<float>(std::sqrt(3 * variance));
        }
        out.push_back(std::move(next));
    }
    return out;
}

}  // namespace nacre
