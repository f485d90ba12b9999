#include "shading/hybrid/plane_factors.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>

#include "core/math.hpp"

namespace nacre {
namespace {

double total(const std::vector<double>& factors) { return std::accumulate(factors.begin(), factors.end(), 0.0); }

TEST(PlaneFactors, AddUpToTheHemisphereAndToACubesFace) {
    EXPECT_NEAR(total(planeFactors(64, 1000, PlaneSource::Cosine)), 1, 1e-5);  // what is beyond: 1/(4 · 1000²) a side
    EXPECT_NEAR(total(planeFactors(64, 1, PlaneSource::Uniform)), 4 * kPi / 6, 1e-12);
    // Of a square of half width 1 at distance 1: 4/π · 1/√2 · atan(1/√2)
    EXPECT_NEAR(total(planeFactors(8, 1, PlaneSource::Cosine)), 4 / kPi * std::sqrt(0.5) * std::atan(std::sqrt(0.5)),
                1e-12);
}

TEST(PlaneFactors, ArePixelsOfTheDensity) {
    // cosθ/π dω = 1/(π (1 + x² + y²)²) dx dy, dω = (1 + x² + y²)^(−3/2) dx dy, at a small pixel's middle
    constexpr int kSize = 2001;
    const double side = 3.0 * 2 / kSize, area = side * side;
    const auto cosine = planeFactors(kSize, 3, PlaneSource::Cosine),
               uniform = planeFactors(kSize, 3, PlaneSource::Uniform);
    for (const auto& [i, j] : {std::pair{1000, 1000}, {1500, 800}, {3, 1990}}) {
        const double x = side * (i - 1000), y = side * (j - 1000), square = 1 + x * x + y * y;
        const auto at = static_cast<std::size_t>(j * kSize + i);
        EXPECT_NEAR(cosine[at] / area * kPi * square * square, 1, 1e-4) << i << " " << j;
        EXPECT_NEAR(uniform[at] / area * std::pow(square, 1.5), 1, 1e-4) << i << " " << j;
    }
}

TEST(PlaneFactors, RejectsEmptyPlanes) {
    EXPECT_THROW(planeFactors(0, 1, PlaneSource::Cosine), std::invalid_argument);
    EXPECT_THROW(planeFactors(4, 0, PlaneSource::Cosine), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
