#include "envmaps/spherical_harmonics.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "envmaps/sphere_transform.hpp"
#include "envmaps/texel_points.hpp"

namespace nacre {

static constexpr int kSummedOrder = 16;

// With P̄_l^m free of sin^mθ, and (x + iy)^m for sin^mθ e^{imφ}: no angle, and so no pole.
std::vector<double> realHarmonics(int order, const Vec3& d) {
    std::vector<double> out(static_cast<std::size_t>((order + 1) * (order + 1)));
    double diagonal = std::sqrt(1 / (4 * kPi)), re = 1, im = 0;
    for (int m = 0; m <= order; ++m) {
        if (m > 0) {
            diagonal *= std::sqrt((2.0 * m + 1) / (2.0 * m));
            const double next = re * d.x - im * d.y;
            im = re * d.y + im * d.x;
            re = next;
        }
        const auto factor = [m](double l) { return std::sqrt((4 * l * l - 1) / (l * l - static_cast<double>(m) * m)); };
        double before = 0, now = diagonal;
        for (int l = m; l <= order; ++l) {
            const std::size_t middle = static_cast<std::size_t>(l * l + l);
            if (m == 0) {
                out[middle] = now;
            } else {
                out[middle + m] = std::sqrt(2.0) * now * re;
                out[middle - m] = std::sqrt(2.0) * now * im;
            }
            const double a = factor(l + 1), next = a * d.z * now - (l == m ? 0 : a / factor(l)) * before;
            before = now;
            now = next;
        }
    }
    return out;
}

static SphericalHarmonics summed(const std::vector<SpherePoint>& points, int order, unsigned threads) {
    constexpr std::size_t kBlock = 4096;
    const std::size_t blocks = (points.size() + kBlock - 1) / kBlock,
                      count = static_cast<std::size_t>((order + 1) * (order + 1));
    std::vector<std::vector<Rgb>> parts(blocks, std::vector<Rgb>(count, Rgb(0)));
    parallelFor(blocks, threads, [&](std::size_t block) {
        for (std::size_t i = block * kBlock; i < std::min(points.size(), (block + 1) * kBlock); ++i) {
            const std::vector<double> y = realHarmonics(order, points[i].direction);
            for (std::size_t k = 0; k < count; ++k) parts[block][k] += y[k] * Rgb(points[i].weight);
        }
    });
    SphericalHarmonics out{order, std::vector<Rgb>(count, Rgb(0))};
    for (const std::vector<Rgb>& part : parts)
        for (std::size_t k = 0; k < count; ++k) out.coefficients[k] += part[k];
    return out;
}

SphericalHarmonics projectEnvironment(const EnvMap& map, int order, unsigned threads) {
    require(order >= 0 && order <= kMaxHarmonicOrder,
            fmt::format("spherical harmonics: order must be 0 to {}, found {}", kMaxHarmonicOrder, order));
    const std::vector<SpherePoint> points = texelPoints(map, threads);
    if (order <= kSummedOrder) return summed(points, order, threads);
    const Harmonics complex = analyseHarmonics(points, order, threads);
    SphericalHarmonics out{order, std::vector<Rgb>(static_cast<std::size_t>((order + 1) * (order + 1)))};
    for (int m = 0; m <= order; ++m)
        for (int l = m; l <= order; ++l) {
            const double scale =
                m == 0 ? 1 : std::sqrt(2.0) * (m % 2 ? -1 : 1);  // the phase that Y_lm has and y_lm has not
            out.at(l, m) = scale * Rgb(complex.at(l, m).re);
            if (m > 0) out.at(l, -m) = -scale * Rgb(complex.at(l, m).im);
        }
    return out;
}

SphericalHarmonics filterHarmonics(const SphericalHarmonics& in, const Lobe& lobe) {
    const std::vector<double> k = zonalCoefficients(zonalKernel(lobe), in.order);
    SphericalHarmonics out = in;
    for (int l = 0; l <= in.order; ++l)
        for (int m = -l; m <= l; ++m) out.at(l, m) *= k[l];
    return out;
}

HarmonicWindow harmonicWindowFromString(const std::string& name) {
    if (name == "none") return HarmonicWindow::None;
    if (name == "hann") return HarmonicWindow::Hann;
    if (name == "lanczos") return HarmonicWindow::Lanczos;
    throw std::invalid_argument(fmt::format("unknown window '{}'; known: none, hann, lanczos", name));
}

SphericalHarmonics windowHarmonics(const SphericalHarmonics& in, HarmonicWindow window) {
    SphericalHarmonics out = in;
    for (int l = 0; l <= in.order; ++l) {
        const double x = kPi * l / (in.order + 1);
        double factor = 1;
        if (window == HarmonicWindow::Hann) factor = 0.5 * (1 + std::cos(x));
        if (window == HarmonicWindow::Lanczos && l > 0) factor = std::sin(x) / x;
        for (int m = -l; m <= l; ++m) out.at(l, m) *= factor;
    }
    return out;
}

Rgb evaluateHarmonics(const SphericalHarmonics& harmonics, const Vec3& d) {
    const std::vector<double> y = realHarmonics(harmonics.order, d);
    Rgb sum(0);
    for (std::size_t k = 0; k < y.size(); ++k) sum += y[k] * harmonics.coefficients[k];
    return sum;
}

}  // namespace nacre
