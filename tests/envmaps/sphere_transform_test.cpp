// The fast transform against the definition, harmonic by harmonic.
#include "envmaps/sphere_transform.hpp"

#include <gtest/gtest.h>

#include <complex>

#include "core/sampling.hpp"

namespace nacre {
namespace {

constexpr double kWindow = 2e-6;  // of the largest sum; measured 4e-7

/// Y_lm by the standard library's Legendre functions.
std::complex<double> harmonic(int l, int m, const Vec3& d) {
    const double theta = std::atan2(std::hypot(d.x, d.y), d.z), phi = std::atan2(d.y, d.x);
    return std::sph_legendre(l, m, theta) * std::polar(1.0, m * phi);  // carries the phase (−1)^m
}

std::vector<SpherePoint> somePoints(int count) {
    std::vector<SpherePoint> points;
    for (int i = 1; i <= count; ++i) {
        const double z = 1 - 2 * radicalInverse(i, 2), phi = 2 * kPi * radicalInverse(i, 3), r = std::sqrt(1 - z * z);
        points.push_back({{r * std::cos(phi), r * std::sin(phi), z},
                          {radicalInverse(i, 5), radicalInverse(i, 7) - 0.5, i % 3, 1.0}});
    }
    points.push_back({{0, 0, 1}, {1, 2, 3, 1}});  // the poles, and the seam φ = 0
    points.push_back({{0, 0, -1}, {-1, 2, 5, 1}});
    points.push_back({{1, 0, 0}, {1, 0, 0, 1}});
    points.push_back({{std::sqrt(1 - 1e-8), -1e-4, 0}, {0, 1, 0, 1}});
    return points;
}

TEST(SphereTransform, AnalysisIsTheSumOverThePoints) {
    for (const int order : {0, 1, 2, 5, 24}) {
        const std::vector<SpherePoint> points = somePoints(300);
        const Harmonics a = analyseHarmonics(points, order);
        for (int m = 0; m <= order; ++m)
            for (int l = m; l <= order; ++l)
                for (int c = 0; c < 4; ++c) {
                    std::complex<double> expected = 0;
                    for (const SpherePoint& p : points)
                        expected += p.weight[c] * std::conj(harmonic(l, m, p.direction));
                    EXPECT_NEAR(a.at(l, m).re[c], expected.real(), kWindow * 300) << "order " << order << l << m << c;
                    EXPECT_NEAR(a.at(l, m).im[c], expected.imag(), kWindow * 300) << "order " << order << l << m << c;
                }
    }
}

TEST(SphereTransform, SynthesisIsTheSumOverTheHarmonics) {
    for (const int order : {0, 1, 2, 7, 20}) {
        Harmonics a(order);
        for (int m = 0; m <= order; ++m)
            for (int l = m; l <= order; ++l)
                a.at(l, m) = {Vec4(1, l, m - 2, 0.5), m == 0 ? Vec4(0) : Vec4(l - m, 1, -1, 0.25)};
        std::vector<Vec3> directions;
        for (const SpherePoint& p : somePoints(100)) directions.push_back(p.direction);
        const std::vector<Vec4> f = synthesiseHarmonics(a, directions);
        double largest = 0;
        for (const Vec4& v : f) largest = std::max(largest, std::abs(v.y));
        for (std::size_t i = 0; i < directions.size(); ++i)
            for (int c = 0; c < 4; ++c) {
                double expected = 0;
                for (int m = 0; m <= order; ++m)
                    for (int l = m; l <= order; ++l) {
                        const std::complex<double> y = harmonic(l, m, directions[i]);
                        expected += (m ? 2 : 1) * (a.at(l, m).re[c] * y.real() - a.at(l, m).im[c] * y.imag());
                    }
                EXPECT_NEAR(f[i][c], expected, kWindow * std::max(1.0, largest)) << "order " << order << " i " << i;
            }
    }
}

TEST(SphereTransform, HighOrdersKeepTheirDigits) {  // Legendre functions start at sin^m θ
    const Vec3 d = glm::normalize(Vec3(0.3, 0.2, 0.5));
    const std::vector<SpherePoint> point{{d, Vec4(1)}};
    const Harmonics a = analyseHarmonics(point, 600);
    for (int l : {0, 100, 333, 600})
        for (int m : {0, 1, 50, 300, 600}) {
            if (m > l) continue;
            EXPECT_NEAR(a.at(l, m).re.x, harmonic(l, m, d).real(), 1e-5) << l << " " << m;
        }
}

TEST(SphereTransform, SameBitsForAnyThreadCount) {
    const std::vector<SpherePoint> points = somePoints(2000);
    const Harmonics one = analyseHarmonics(points, 40, 1), many = analyseHarmonics(points, 40, 0);
    std::vector<Vec3> directions;
    for (const SpherePoint& p : points) directions.push_back(p.direction);
    EXPECT_EQ(synthesiseHarmonics(one, directions, 1), synthesiseHarmonics(many, directions, 0));
    for (int m = 0; m <= 40; ++m)
        for (int l = m; l <= 40; ++l) EXPECT_EQ(one.at(l, m).re, many.at(l, m).re);
}

TEST(SphereTransform, RejectsBadOrders) {
    EXPECT_THROW(analyseHarmonics({}, -1), std::invalid_argument);
    EXPECT_THROW(analyseHarmonics({}, kMaxHarmonicOrder + 1), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
