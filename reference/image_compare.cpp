#include "reference/image_compare.hpp"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <vector>

#include "core/error.hpp"
#include "reference/tone.hpp"

namespace nacre {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void requireSameSize(const Image& a, const Image& b, const char* what) {
    require(a.width() == b.width() && a.height() == b.height(),
            fmt::format("{}: {}x{} against {}x{} pixels", what, a.width(), a.height(), b.width(), b.height()));
}

bool inside(const Image& mask, int x, int y) { return mask.empty() || mask.at(x, y, 0) >= 1; }

Rgb srgbOf(const Rgb& radiance, double white) {
    return {srgbEncode(radiance.r / white), srgbEncode(radiance.g / white), srgbEncode(radiance.b / white)};
}

struct Sums {
    double linear = 0, srgb = 0, truth = 0, sum = 0, absolute = 0;
};

void accumulate(ImageDifference& out, Sums& sums, const Rgb& a, const Rgb& b, double white) {
    ++out.pixels;
    const bool finite = isFinite(a);
    out.nonFinite += !finite;
    const Rgb d = finite ? a - b : Rgb(kInfinity), encoded = finite ? srgbOf(a, white) - srgbOf(b, white) : d;
    sums.linear += glm::dot(d, d);
    sums.srgb += glm::dot(encoded, encoded);
    sums.truth += glm::dot(b, b);
    sums.sum += 3 * mean(b);
    sums.absolute += 3 * mean(glm::abs(d));
    out.maxAbs = std::max(out.maxAbs, maxComponent(glm::abs(d)));
}

}  // namespace

double pictureWhite(const Image& truth, const Image& mask) {
    if (!mask.empty()) requireSameSize(mask, truth, "pictureWhite: mask");
    std::vector<double> values;
    for (int y = 0; y < truth.height(); ++y)
        for (int x = 0; x < truth.width(); ++x)
            if (const double value = luminance(truth.rgb(x, y)); value > 0 && inside(mask, x, y))
                values.push_back(value);
    return whitePoint(values);
}

ImageDifference compareImages(const Image& image, const Image& truth, double white, const Image& mask) {
    requireSameSize(image, truth, "compareImages");
    if (!mask.empty()) requireSameSize(mask, truth, "compareImages: mask");
    require(white > 0, "compareImages: white must be > 0");
    ImageDifference out;
    Sums sums;
    for (int y = 0; y < truth.height(); ++y)
        for (int x = 0; x < truth.width(); ++x) {
            if (!inside(mask, x, y)) continue;
            require(isFinite(truth.rgb(x, y)), fmt::format("compareImages: the truth is not finite at ({}, {})", x, y));
            accumulate(out, sums, image.rgb(x, y), truth.rgb(x, y), white);
        }
    require(out.pixels > 0, "compareImages: no pixel inside the mask");
    const double count = 3 * static_cast<double>(out.pixels);
    out.psnrLinear = psnrOfMeanSquare(sums.linear / count / sqr(white));
    out.psnrSrgb = psnrOfMeanSquare(sums.srgb / count);
    out.relative = sums.linear == 0 ? 0 : std::sqrt(sums.linear / sums.truth);
    out.rmsOverMean = sums.linear == 0 ? 0 : std::sqrt(sums.linear / count) / (sums.sum / count);
    out.meanAbs = sums.absolute / count;
    return out;
}

Rgb differenceColor(double x) {
    static constexpr std::array<std::array<double, 3>, 6> kStops{
        {{0, 0, 0}, {0.08, 0.01, 0.2}, {0.45, 0.02, 0.1}, {0.9, 0.2, 0.02}, {1, 0.75, 0.1}, {1, 1, 1}}};
    const double place = clamp01(x) * (kStops.size() - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
    const double f = place - static_cast<double>(i);
    Rgb out;
    for (int c = 0; c < 3; ++c)
        out[c] = (1 - f) * kStops[i][static_cast<std::size_t>(c)] + f * kStops[i + 1][static_cast<std::size_t>(c)];
    return out;
}

Image differenceImage(const Image& image, const Image& truth, double white, double scale, const Image& mask) {
    requireSameSize(image, truth, "differenceImage");
    if (!mask.empty()) requireSameSize(mask, truth, "differenceImage: mask");
    require(white > 0 && scale > 0, "differenceImage: white and scale must be > 0");
    Image out(truth.width(), truth.height(), 3);
    for (int y = 0; y < truth.height(); ++y)
        for (int x = 0; x < truth.width(); ++x) {
            const Rgb a = image.rgb(x, y), d = glm::abs(srgbOf(a, white) - srgbOf(truth.rgb(x, y), white));
            const Rgb color = isFinite(a) ? differenceColor(maxComponent(d) / scale) : Rgb(0, 1, 0);
            out.setRgb(x, y, inside(mask, x, y) ? color : Rgb(0.2));
        }
    return out;
}

}  // namespace nacre
