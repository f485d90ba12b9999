#include "reference/sphere_psnr.hpp"

#include <limits>
#include <vector>

#include "core/parallel.hpp"
#include "reference/tone.hpp"

namespace nacre {

namespace {

constexpr int kPixels = 128, kLights = 6;
constexpr double kElevation = 20 * kPi / 180, kAzimuthStep = 30 * kPi / 180;

struct LitPixel {
    Rgb approximate, truth;  ///< radiance
};

Vec3 lightDirection(int i) {
    const double az = i * kAzimuthStep;
    return {std::sin(az) * std::cos(kElevation), std::sin(kElevation), std::cos(az) * std::cos(kElevation)};
}

/// The lit pixels of one row of one picture.
std::vector<LitPixel> shadeRow(int y, const Vec3& light, const BrdfFunction& approximate, const BrdfFunction& truth) {
    std::vector<LitPixel> row;
    const double ny = 1 - 2 * (y + 0.5) / kPixels;
    for (int x = 0; x < kPixels; ++x) {
        const double nx = 2 * (x + 0.5) / kPixels - 1, zz = 1 - nx * nx - ny * ny;
        if (zz <= 0) continue;
        const Vec3 n(nx, ny, std::sqrt(zz)), t = glm::normalize(glm::cross(Vec3(0, 1, 0), n)), b = glm::cross(n, t);
        const Vec3 wi(glm::dot(t, light), glm::dot(b, light), glm::dot(n, light)), wo(t.z, b.z, n.z);
        if (wi.z <= 0) continue;
        row.push_back({approximate(wi, wo) * wi.z, truth(wi, wo) * wi.z});
    }
    return row;
}

std::vector<LitPixel> shadeAll(const BrdfFunction& approximate, const BrdfFunction& truth, unsigned threads) {
    std::vector<std::vector<LitPixel>> rows(kPixels * kLights);
    parallelFor(rows.size(), threads, [&](std::size_t i) {
        const int row = static_cast<int>(i);
        rows[i] = shadeRow(row % kPixels, lightDirection(row / kPixels), approximate, truth);
    });
    std::vector<LitPixel> pixels;
    for (const auto& row : rows) pixels.insert(pixels.end(), row.begin(), row.end());
    return pixels;
}

}  // namespace

double spherePsnr(const BrdfFunction& approximate, const BrdfFunction& truth, unsigned threads) {
    const std::vector<LitPixel> pixels = shadeAll(approximate, truth, threads);
    std::vector<double> luminances;
    for (const LitPixel& p : pixels) luminances.push_back(luminance(p.truth));
    const double white = whitePoint(std::move(luminances));
    double sum = 0;
    for (const LitPixel& p : pixels) {
        if (!isFinite(p.approximate)) return -std::numeric_limits<double>::infinity();
        for (int c = 0; c < 3; ++c) sum += sqr(srgbEncode(p.approximate[c] / white) - srgbEncode(p.truth[c] / white));
    }
    return psnrOfMeanSquare(sum / (3 * static_cast<double>(pixels.size())));
}

}  // namespace nacre
