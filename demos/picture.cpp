#include "demos/picture.hpp"

#include "core/error.hpp"
#include "reference/tone.hpp"
#include "shading/image_output.hpp"

namespace nacre {
namespace {

bool sameSize(const Image& a, const Image& b) { return a.width() == b.width() && a.height() == b.height(); }

}  // namespace

Image halved(const Image& image) {
    require(image.width() % 2 == 0 && image.height() % 2 == 0, "halved: width and height must be even");
    Image out(image.width() / 2, image.height() / 2, image.channels());
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x)
            for (int c = 0; c < out.channels(); ++c)
                out.at(x, y, c) = (image.at(2 * x, 2 * y, c) + image.at(2 * x + 1, 2 * y, c) +
                                   image.at(2 * x, 2 * y + 1, c) + image.at(2 * x + 1, 2 * y + 1, c)) /
                                  4;
    return out;
}

Image over(const Image& image, const Image& coverage, double background) {
    require(sameSize(image, coverage), "over: image and coverage have different sizes");
    Image out(image.width(), image.height(), 3);
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x)
            out.setRgb(x, y, image.rgb(x, y) + Rgb((1 - coverage.at(x, y, 0)) * background));
    return out;
}

Image channelOf(const Image& image, int channel) {
    Image out(image.width(), image.height(), 1);
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x) out.at(x, y, 0) = image.at(x, y, channel);
    return out;
}

double differenceQuantile(const Image& image, const Image& truth, double white, const Image& mask, double share) {
    require(sameSize(image, truth) && sameSize(image, mask), "differenceQuantile: images have different sizes");
    std::vector<double> differences;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            if (mask.at(x, y, 0) != 1) continue;
            const Rgb a = image.rgb(x, y) / white, b = truth.rgb(x, y) / white;
            double largest = 0;
            for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(srgbEncode(a[c]) - srgbEncode(b[c])));
            differences.push_back(largest);
        }
    if (differences.empty()) return 0;
    const auto at =
        differences.begin() + static_cast<std::ptrdiff_t>((1 - share) * static_cast<double>(differences.size() - 1));
    std::nth_element(differences.begin(), at, differences.end());
    return *at;
}

double roundUpScale(double value) {
    require(std::isfinite(value) && value > 0, "roundUpScale: value must be finite, > 0");
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= value * (1 - 1e-9)) return factor * power;  // rounding must not skip a step
    return 10 * power;
}

Picture encodePicture(std::string file, const Image& image, double white) {
    return {std::move(file), encodePng(toneMap(image, {white}), image.width(), image.height())};
}

}  // namespace nacre
