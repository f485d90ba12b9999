#include "transfer/mask_kernel.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <numeric>
#include <random>

#include "core/math.hpp"
#include "core/sampling.hpp"
#include "envmaps/spherical_harmonics.hpp"

namespace nacre {
namespace {

using Mask = std::vector<std::uint32_t>;

bool bitOf(const Mask& mask, int size, int row, int step) {
    return mask[static_cast<std::size_t>(step / 32 * size + row)] >> (step % 32) & 1;
}

int bitsOf(const Mask& mask) {
    return std::accumulate(mask.begin(), mask.end(), 0, [](int n, std::uint32_t w) { return n + std::popcount(w); });
}

struct Corners {
    glm::vec3 a, b, c;
};

Mask drawn(int size, const std::vector<Corners>& triangles, bool bothSides, VectorSet set = VectorSet::Widest,
           const Receiver& receiver = {}) {
    std::vector<BlockerRow> rows;
    for (const Corners& t : triangles) rows.push_back(blockerRow(t.a, t.b, t.c));
    std::vector<std::uint32_t> indices(rows.size() + 16);
    std::iota(indices.begin(), indices.end(), 0u);
    Mask mask(maskWords(size), 0);
    maskKernel(size, set).draw(*maskRows(size), rows.data(), receiver, bothSides, indices.data(), rows.size(),
                               mask.data());
    return mask;
}

/// The directions that bits stand for, by row and step: the row's azimuth, and its own offset within the step.
std::vector<Vec3> directionsOf(int size) {
    const auto tables = maskRows(size);
    std::vector<Vec3> directions;
    for (int row = 0; row < size; ++row)
        for (int step = 0; step < size; ++step) {
            const double u = std::min(1.0, (step + 1 - double{tables->dither[row]}) / size);
            const double phi = 2 * kPi * (row + 0.5) / size;
            directions.emplace_back(std::sqrt(u) * std::cos(phi), std::sqrt(u) * std::sin(phi), std::sqrt(1 - u));
        }
    return directions;
}

/// Three planes, in double. Positive inside; the least tells how near the direction is to an edge.
double insideness(const Corners& t, const Vec3& d, bool bothSides) {
    const Vec3 a = glm::normalize(Vec3(t.a)), b = glm::normalize(Vec3(t.b)), c = glm::normalize(Vec3(t.c));
    const double volume = glm::dot(glm::cross(b, a), c);  // positive for what faces the origin
    if (volume < 0 && !bothSides) return -1;
    const double side = volume < 0 ? -1 : 1;
    const auto edge = [&](const Vec3& p, const Vec3& q) {
        return side * glm::dot(glm::normalize(glm::cross(q, p)), d);
    };
    return std::min({edge(a, b), edge(b, c), edge(c, a)});
}

Corners randomTriangle(std::mt19937& random, double spread) {
    const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
    const auto point = [&](const Vec3& about) {
        return glm::vec3(about + spread * (2.0 * Vec3(uniform(), uniform(), uniform()) - 1.0));
    };
    const double z = 1.6 * uniform() - 0.6, phi = 2 * kPi * uniform(), s = std::sqrt(1 - z * z);
    const Vec3 about = Vec3(s * std::cos(phi), s * std::sin(phi), z) * (0.5 + uniform());
    return {point(about), point(about), point(about)};
}

constexpr double kEdge =
    2e-5;  ///< sines this close to an edge may round either way: single precision, the azimuths' margin

TEST(MaskKernel, BitsAreWhatThreePlanesSay) {
    std::mt19937 random(7);
    for (const int size : {16, 32, 64, 128}) {
        const std::vector<Vec3> directions = directionsOf(size);
        for (const double spread : {0.05, 0.3, 1.0, 3.0})
            for (int i = 0; i < 60; ++i) {
                const Corners t = randomTriangle(random, spread);
                const bool bothSides = i % 2 == 0;
                const Mask mask = drawn(size, {t}, bothSides);
                for (int row = 0; row < size; ++row)
                    for (int step = 0; step < size; ++step) {
                        const double inside =
                            insideness(t, directions[static_cast<std::size_t>(row * size + step)], bothSides);
                        if (std::abs(inside) < kEdge) continue;
                        ASSERT_EQ(bitOf(mask, size, row, step), inside > 0)
                            << "size " << size << " spread " << spread << " triangle " << i << " row " << row
                            << " step " << step;
                    }
            }
    }
}

TEST(MaskKernel, AllProcessorsGiveTheSameBits) {
    std::mt19937 random(3);
    std::vector<Corners> triangles;
    for (int i = 0; i < 333; ++i) triangles.push_back(randomTriangle(random, i % 3 == 0 ? 0.02 : 0.6));
    for (const int size : {16, 32, 64, 128}) {
        const Mask plain = drawn(size, triangles, true, VectorSet::Plain);
        EXPECT_GT(bitsOf(plain), size);
        for (const VectorSet set : {VectorSet::Avx2, VectorSet::Avx512}) {
            if (!processorHas(set)) continue;
            EXPECT_EQ(drawn(size, triangles, true, set), plain) << size;
            const MaskKernel one = maskKernel(size, VectorSet::Plain), other = maskKernel(size, set);
            std::vector<float> a(64), b(64);
            const auto tables = maskIntegrals(size, 6);
            one.integrate(*tables, plain.data(), a.data());
            other.integrate(*tables, plain.data(), b.data());
            EXPECT_EQ(a, b) << size;
        }
    }
}

/// A closed fan around the zenith and a skirt around it tile the hemisphere: no bit twice, none left out.
TEST(MaskKernel, SharedEdgesTileWithoutGapsOrOverlaps) {
    std::mt19937 random(11);
    const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
    for (const int size : {32, 64}) {
        const int around = 7;
        std::vector<glm::vec3> ring, low;
        for (int i = 0; i < around; ++i) {
            const double phi = 2 * kPi * (i + 0.6 * uniform()) / around, z = 0.3 + 0.5 * uniform();
            ring.emplace_back(std::cos(phi), std::sin(phi), z);
            low.emplace_back(std::cos(phi), std::sin(phi), -0.5);
        }
        const glm::vec3 top(0.05f, -0.03f, 1);
        std::vector<Corners> triangles;
        for (int i = 0; i < around; ++i) {
            const int k = (i + 1) % around;
            triangles.push_back({top, ring[k], ring[i]});
            triangles.push_back({ring[i], ring[k], low[k]});
            triangles.push_back({ring[i], low[k], low[i]});
        }
        int sum = 0;
        for (const Corners& t : triangles) sum += bitsOf(drawn(size, {t}, false));
        EXPECT_EQ(sum, size * size);
        EXPECT_EQ(bitsOf(drawn(size, triangles, false)), size * size);
    }
}

TEST(MaskKernel, BackFacesAreAnOption) {
    const Corners front{{-1, -1, 1}, {0, 1, 1}, {1, -1, 1}}, back{front.a, front.c, front.b};
    EXPECT_GT(bitsOf(drawn(32, {front}, false)), 0);
    EXPECT_EQ(bitsOf(drawn(32, {back}, false)), 0);
    EXPECT_EQ(drawn(32, {back}, true), drawn(32, {front}, true));
}

TEST(MaskKernel, HardTriangles) {
    const glm::vec3 o(0);
    const int whole = 32 * 32;
    // Through the eye: its plane, its edge, its corner.
    EXPECT_EQ(bitsOf(drawn(32, {{{-1, -1, 0}, {2, 0, 0}, {-1, 1, 0}}}, true)), 0);
    EXPECT_EQ(bitsOf(drawn(32, {{{-1, 0, -1}, {1, 0, 1}, {0, 1, 0}}}, true)), 0);
    EXPECT_EQ(bitsOf(drawn(32, {{o, {1, 0, 1}, {0, 1, 1}}}, true)), 0);
    // No area, and all corners at one place.
    EXPECT_EQ(bitsOf(drawn(32, {{{1, 0, 1}, {2, 0, 2}, {3, 0, 3}}}, true)), 0);
    EXPECT_EQ(bitsOf(drawn(32, {{{1, 0, 1}, {1, 0, 1}, {1, 0, 1}}}, true)), 0);
    EXPECT_EQ(bitsOf(drawn(32, {{{1, 2, 1}, {1, 2, 1}, {0, 1, 1}}}, true)), 0);
    // Below the horizon; nearly the whole hemisphere, from a plate that almost touches.
    EXPECT_EQ(bitsOf(drawn(32, {{{-1, -1, -1}, {2, 0, -1}, {-1, 1, -1}}}, true)), 0);
    EXPECT_GE(bitsOf(drawn(32, {{{-1e4f, -1e4f, 1e-3f}, {2e4f, 0, 1e-3f}, {-1e4f, 1e4f, 1e-3f}}}, true)), whole - 2);
    // The same again adds nothing.
    const Corners t{{-1, -1, 1}, {0, 1, 1}, {1, -1, 1}};
    EXPECT_EQ(drawn(32, {t, t, t}, true), drawn(32, {t}, true));
    // A sliver covers no more than its rows' width of bits, wherever it lies.
    for (double phi = 0.01; phi < 6.28; phi += 0.37) {
        const glm::vec3 d(std::cos(phi), std::sin(phi), 0.2), e(std::cos(phi + 1), std::sin(phi + 1), 0.9);
        EXPECT_LE(bitsOf(drawn(32, {{d, e, 0.5f * (d + e) + glm::vec3(0, 0, 1e-6f)}}, true)), 1) << phi;
    }
    // Vertices straight above and below.
    EXPECT_GT(bitsOf(drawn(32, {{{0, 0, 1}, {1, 0, 0.1f}, {0, 1, 0.1f}}}, true)), whole / 5);
    EXPECT_GT(bitsOf(drawn(32, {{{0, 0, -1}, {1, 0, 1}, {0, 1, 1}}}, true)), whole / 20);
}

TEST(MaskKernel, NothingDrawnNothingSet) { EXPECT_EQ(bitsOf(drawn(32, {}, true)), 0); }

/// ∫ y_lm cosθ/π over the bits: a full mask gives the open transfer; one bit the harmonic at its direction.
TEST(MaskKernel, IntegratesBits) {
    for (const int size : {16, 32, 64, 128})
        for (const int order : {0, 2, 4, 5, 6}) {
            const auto tables = maskIntegrals(size, order);
            const std::vector<double> open = openTransfer(order);
            const MaskKernel kernel = maskKernel(size);
            std::vector<float> sums(static_cast<std::size_t>(32 * tables->groups));
            Mask mask(maskWords(size), size == 16 ? 0xffffu : ~0u);
            kernel.integrate(*tables, mask.data(), sums.data());
            for (int l = 0, pair = 0; l <= order; ++l)
                for (int m = 0; m <= l; ++m, ++pair) {
                    const auto lane = static_cast<std::size_t>(pair / 16 * 32 + pair % 16);
                    EXPECT_NEAR(sums[lane], m == 0 ? open[static_cast<std::size_t>(l)] : 0, 1e-3)
                        << size << " " << l << " " << m;
                    EXPECT_NEAR(sums[lane + 16], 0, 1e-3);
                }
            if (size < 64) continue;  // a step's mean is near its middle's value
            std::fill(mask.begin(), mask.end(), 0u);
            const int row = 5, step = size / 2;
            mask[static_cast<std::size_t>(step / 32 * size + row)] = 1u << (step % 32);
            kernel.integrate(*tables, mask.data(), sums.data());
            const double u = (step + 0.5) / size, phi = 2 * kPi * (row + 0.5) / size;
            const std::vector<double> y =
                realHarmonics(order, {std::sqrt(u) * std::cos(phi), std::sqrt(u) * std::sin(phi), std::sqrt(1 - u)});
            for (int l = 0, pair = 0; l <= order; ++l)
                for (int m = 0; m <= l; ++m, ++pair) {
                    const auto lane = static_cast<std::size_t>(pair / 16 * 32 + pair % 16);
                    const double bits = size * size;
                    EXPECT_NEAR(bits * sums[lane], y[static_cast<std::size_t>(l * l + l + m)], 0.02)
                        << size << " " << l << m;
                    EXPECT_NEAR(bits * sums[lane + 16], m > 0 ? y[static_cast<std::size_t>(l * l + l - m)] : 0, 0.02);
                }
        }
}

TEST(MaskKernel, RefusesSizesAndNames) {
    EXPECT_THROW(maskKernel(48), std::invalid_argument);
    EXPECT_THROW(maskRows(0), std::invalid_argument);
    EXPECT_THROW(maskIntegrals(32, 7), std::invalid_argument);
    EXPECT_THROW(vectorSetFromString("sse"), std::invalid_argument);
    EXPECT_EQ(vectorSetFromString("avx2"), VectorSet::Avx2);
}

}  // namespace
}  // namespace nacre
