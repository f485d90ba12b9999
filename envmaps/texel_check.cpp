#include "envmaps/texel_check.hpp"

#include <fmt/format.h>

#include "core/error.hpp"

namespace nacre {

std::string toString(NegativePolicy policy) {
    return policy == NegativePolicy::Keep ? "keep" : policy == NegativePolicy::Clamp ? "clamp" : "error";
}

NegativePolicy negativePolicyFromString(const std::string& name) {
    for (const NegativePolicy policy : {NegativePolicy::Keep, NegativePolicy::Clamp, NegativePolicy::Error})
        if (toString(policy) == name) return policy;
    throw std::invalid_argument(fmt::format("unknown rule '{}' for negative texels; known: keep, clamp, error", name));
}

static TexelReport countTexels(const Image& image) {
    static constexpr double kHalfMax = 65504;
    TexelReport report;
    report.texels = image.texelCount();
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const Rgb v = image.rgb(x, y);
            const bool negative = v.r < 0 || v.g < 0 || v.b < 0, finite = isFinite(v);
            report.negative += negative;
            report.nonFinite += !finite;
            report.overflowed += v.r >= kHalfMax || v.g >= kHalfMax || v.b >= kHalfMax;
            if ((negative || !finite) && report.firstBad.empty())
                report.firstBad = fmt::format("({}, {}) {:g} {:g} {:g}", x, y, v.r, v.g, v.b);
        }
    return report;
}

/// The mean of the finite neighbours in `image`; 0 when there is none.
static Rgb neighbourMean(const Image& image, int x, int y, const TexelTopology& topology) {
    const int rows = topology.blockRows ? topology.blockRows : image.height(), top = y / rows * rows;
    Rgb sum(0);
    int count = 0;
    for (int j = std::max(top, y - 1); j <= std::min(top + rows - 1, y + 1); ++j)
        for (int step = -1; step <= 1; ++step) {
            int i = x + step;
            if (topology.wrapX) i = (i + image.width()) % image.width();
            if ((i == x && j == y) || i < 0 || i >= image.width() || !isFinite(image.rgb(i, j))) continue;
            sum += image.rgb(i, j);
            ++count;
        }
    return count ? sum / static_cast<double>(count) : Rgb(0);
}

static void mendNonFinite(Image& image, const TexelTopology& topology) {
    const Image before = image;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            if (!isFinite(before.rgb(x, y))) image.setRgb(x, y, neighbourMean(before, x, y, topology));
}

/// \return the energy removed, in percent of Σ |L| dω
static double clampNegative(Image& image, std::span<const double> weights) {
    double removed = 0, left = 0;
    for (std::size_t i = 0; i < image.data().size(); ++i) {
        float& v = image.data()[i];
        const double energy = weights[i / 3] > 0 ? weights[i / 3] * static_cast<double>(v) : 0;
        (v < 0 ? removed : left) += std::abs(energy);
        if (v < 0) v = 0;
    }
    return removed > 0 ? 100 * removed / (removed + left) : 0;
}

TexelReport checkTexels(Image& image, std::span<const double> weights, const TexelTopology& topology,
                        NegativePolicy policy, const std::string& name) {
    require(image.channels() == 3 && weights.size() == image.texelCount(),
            "checkTexels: expected three channels and a weight for each texel");
    TexelReport report = countTexels(image);
    if (policy == NegativePolicy::Error && report.negative + report.nonFinite > 0)
        throw Error(fmt::format("{}: expected finite texels >= 0, found {} negative and {} non-finite of {}, first {}",
                                name, report.negative, report.nonFinite, report.texels, report.firstBad));
    if (report.nonFinite == report.texels)
        throw Error(fmt::format("{}: expected finite texels, found none among {}", name, report.texels));
    if (report.nonFinite > 0) mendNonFinite(image, topology);
    if (policy == NegativePolicy::Clamp && report.negative > 0)
        report.energyRemovedPercent = clampNegative(image, weights);
    return report;
}

}  // namespace nacre
