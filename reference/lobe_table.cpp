#include "reference/lobe_table.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "reference/environment_error.hpp"

namespace nacre {
namespace {

double widthOf(const Lobe& lobe) {
    if (lobe.kind == LobeKind::GgxAnisotropic) return std::min(lobe.alpha, lobe.alphaY);
    return std::min(1.0, zonalKernel(lobe).width);
}
double supportOf(const Lobe& lobe) {
    static constexpr double kNothing = 1e-6;  // of a lobe's height
    if (lobe.kind != LobeKind::Phong) return isZonal(lobe.kind) ? zonalKernel(lobe).support : kPi;
    return lobe.exponent > 0 ? std::acos(std::pow(kNothing, 1 / lobe.exponent)) : kPi / 2;
}

int tableSize(const Lobe& lobe, const LobeTableOptions& o) {
    return std::clamp(static_cast<int>(std::ceil(o.perWidth * kPi / 2 / widthOf(lobe))), 16, o.most);
}
int sourceHeight(const Lobe& lobe, const LobeTableOptions& o) {
    return std::clamp(static_cast<int>(std::ceil(o.perWidth * kPi / widthOf(lobe))), 64, 2 * o.most);
}

/// The averaged source, texel by texel.
class Sum {
public:
    Sum(const EnvMap& map, const Lobe& lobe) : lobe_(lobe), size_(map.size()), support_(supportOf(lobe)), map_(map) {
        for (int y = 0; y < size_; ++y) {
            solidAngle_.push_back(envSolidAngle(map.layout, size_, 0, y));
            for (int x = 0; x < 2 * size_; ++x) directions_.push_back(envTexelDirection(map.layout, size_, x, y));
        }
    }
    Rgb operator()(const Vec3& r) const {
        const double latitude = std::asin(std::clamp(r.y, -1.0, 1.0)), row = kPi / size_;
        const double cosSupport = support_ >= kPi ? -2 : std::cos(support_);
        Rgb sum(0);
        double weights = 0;
        for (int y = 0; y < size_; ++y) {
            if (std::abs(kPi / 2 - (y + 0.5) * row - latitude) > support_ + row) continue;
            for (int x = 0; x < 2 * size_; ++x) {
                const Vec3& l = directions_[static_cast<std::size_t>(y) * 2 * size_ + x];
                if (glm::dot(l, r) < cosSupport) continue;
                const double w = lobeWeight(lobe_, r, l) * solidAngle_[static_cast<std::size_t>(y)];
                if (w <= 0) continue;
                sum += w * map_.image.rgb(x, y);
                weights += w;
            }
        }
        return weights > 0 ? sum / weights : sampleEnv(map_, r);
    }

private:
    Lobe lobe_;
    int size_;
    double support_;
    const EnvMap& map_;
    std::vector<double> solidAngle_;
    std::vector<Vec3> directions_;
};

}  // namespace

EnvMap areaAveraged(const EnvMap& source, int size, unsigned threads) {
    require(size >= 1, "areaAveraged: size must be >= 1");
    EnvMap out(EnvLayout::LatLong, size);
    // Points of a regular grid in each texel, at least as dense as the source's texels.
    const int n = std::clamp((3 * source.size() + size - 1) / size, 2, 64);
    parallelFor(static_cast<std::size_t>(size), threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < 2 * size; ++x) {
            Rgb sum(0);
            double weights = 0;
            for (int k = 0; k < n * n; ++k) {
                const Vec3 d = envDirection(out.layout, size, x + (k % n + 0.5) / n, y + (k / n + 0.5) / n);
                const double w = std::sqrt(std::max(0.0, 1 - d.y * d.y));
                sum += w * sampleEnv(source, d);
                weights += w;
            }
            out.image.setRgb(x, y, sum / weights);
        }
    });
    return out;
}

double lobeTableResolution(const Lobe& lobe, const LobeTableOptions& options) {
    return std::min(tableSize(lobe, options) / (kPi / 2), sourceHeight(lobe, options) / kPi) * widthOf(lobe);
}

EnvMap tabulateLobe(const EnvMap& source, const Lobe& lobe, const LobeTableOptions& options) {
    validateLobe(lobe);
    require(!isMirror(lobe), "tabulateLobe: a mirror needs no table");
    const int height = sourceHeight(lobe, options);
    const EnvMap averaged = areaAveraged(source, height, options.threads);
    const Sum sum(averaged, lobe);
    EnvMap out(EnvLayout::Cube, tableSize(lobe, options));
    parallelFor(static_cast<std::size_t>(out.image.height()), options.threads, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < out.image.width(); ++x)
            out.image.setRgb(x, y, sum(envTexelDirection(out.layout, out.size(), x, y)));
        if (row == 0) report(options.progress, "sums over the surrounding", 0);
    });
    return out;
}

}  // namespace nacre
