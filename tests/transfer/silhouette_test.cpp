// What silhouettes hide against the same triangles drawn one by one.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "core/math.hpp"
#include "transfer/silhouette_blockers.hpp"

namespace nacre {
namespace {

using Words = std::vector<std::uint32_t>;

/// Triangles in their places.
struct Shape {
    std::vector<glm::vec3> points;
    std::vector<glm::uvec3> triangles;
};

Words bySilhouettes(const Shape& shape, std::span<const Receiver> receivers, std::size_t which, int size, bool backs,
                    VectorSet set = VectorSet::Widest, float nearby = std::numeric_limits<float>::infinity()) {
    const std::vector<std::vector<glm::uvec3>> levels = {shape.triangles};
    const std::vector<std::vector<BackSides>> sides = {
        std::vector<BackSides>(shape.triangles.size(), backs ? BackSides::All : BackSides::None)};
    const SilhouetteMesh mesh(levels, shape.points, sides);
    const SilhouetteKernel kernel = silhouetteKernel(size, set);
    SilhouetteMesh::Frame frame;
    mesh.place(shape.points, kernel, 1, frame);
    SilhouetteMesh::Seen seen;
    for (std::size_t c = 0; c < mesh.clusterCount(); ++c) seen.members.push_back(mesh.all(c));
    const std::vector<std::span<const std::uint32_t>> corners(receivers.size());
    std::vector<glm::vec3> points;
    for (const Receiver& r : receivers) points.push_back(r.point);
    std::vector<std::uint32_t> group(points.size());
    std::iota(group.begin(), group.end(), 0u);
    mesh.see(frame, kernel, receivers, boxOfGroup(group, points), corners, 0, nearby, seen);
    std::vector<std::int16_t> layers(layerCounts(size), 0);
    kernel.add(*maskRows(size), frame.edges.data(), receivers[which], &seen.dealt.items[seen.dealt.room * which],
               seen.dealt.counts[which], layers.data());
    Words mask(maskWords(size), 0);
    kernel.finish(layers.data(), seen.poles[which], mask.data());
    return mask;
}

Words oneByOne(const Shape& shape, const Receiver& receiver, int size, bool backs) {
    std::vector<BlockerRow> rows;
    for (const glm::uvec3& t : shape.triangles)
        rows.push_back(blockerRow(shape.points[t.x], shape.points[t.y], shape.points[t.z]));
    std::vector<std::uint32_t> indices(rows.size() + kLanes);
    std::iota(indices.begin(), indices.end(), 0u);
    Words mask(maskWords(size), 0);
    maskKernel(size).draw(*maskRows(size), rows.data(), receiver, backs, indices.data(), rows.size(), mask.data());
    return mask;
}

int setBits(const Words& mask) {
    return std::accumulate(mask.begin(), mask.end(), 0, [](int n, std::uint32_t w) { return n + std::popcount(w); });
}

/// Bits that the two differ in: few, as a row that an edge's end nearly lies in the middle of may count or not.
int differing(const Shape& shape, const Receiver& receiver, int size, bool backs) {
    const Receiver receivers[] = {receiver};
    const Words a = bySilhouettes(shape, receivers, 0, size, backs), b = oneByOne(shape, receiver, size, backs);
    int bits = 0;
    for (std::size_t w = 0; w < a.size(); ++w) bits += std::popcount(a[w] ^ b[w]);
    return bits;
}

Shape soup(int triangles, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    Shape shape;
    for (int t = 0; t < triangles; ++t) {
        const glm::vec3 middle = 0.3f * glm::vec3(normal(random), normal(random), normal(random));
        for (int c = 0; c < 3; ++c)
            shape.points.push_back(middle + 0.1f * glm::vec3(normal(random), normal(random), normal(random)));
        shape.triangles.push_back(glm::uvec3(3 * t) + glm::uvec3(0, 1, 2));
    }
    return shape;
}

/// Seen from inside when `inwards`, else from outside.
Shape sphere(const glm::vec3& middle, float radius, bool inwards) {
    constexpr std::uint32_t kAlong = 24, kAcross = 12;
    Shape shape;
    for (std::uint32_t j = 0; j <= kAcross; ++j)
        for (std::uint32_t i = 0; i < kAlong; ++i) {
            const double theta = kPi * j / kAcross, phi = 2 * kPi * i / kAlong;
            const Vec3 d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
            shape.points.push_back(middle + radius * glm::vec3(d));
        }
    for (std::uint32_t j = 0; j < kAcross; ++j)
        for (std::uint32_t i = 0; i < kAlong; ++i) {
            const std::uint32_t a = kAlong * j + i, b = kAlong * j + (i + 1) % kAlong;
            for (glm::uvec3 t : {glm::uvec3(a, a + kAlong, b), glm::uvec3(b, a + kAlong, b + kAlong)}) {
                if (inwards) std::swap(t.y, t.z);
                shape.triangles.push_back(t);
            }
        }
    return shape;
}

/// A roof of 2 n × 2 n squares, corners on whole tenths, seen from below.
Shape roof(std::uint32_t n) {
    Shape shape;
    const std::uint32_t side = 2 * n + 1;
    for (std::uint32_t j = 0; j < side; ++j)
        for (std::uint32_t i = 0; i < side; ++i)
            shape.points.emplace_back(0.125f * (static_cast<float>(i) - static_cast<float>(n)),
                                      0.125f * (static_cast<float>(j) - static_cast<float>(n)), 0.25f);
    for (std::uint32_t j = 0; j + 1 < side; ++j)
        for (std::uint32_t i = 0; i + 1 < side; ++i) {
            const std::uint32_t a = side * j + i;
            shape.triangles.emplace_back(a, a + side, a + 1);
            shape.triangles.emplace_back(a + 1, a + side, a + side + 1);
        }
    return shape;
}

TEST(Silhouettes, SoupsHideWhatTheirTrianglesDo) {
    for (const int size : {16, 32, 64, 128})
        for (const bool backs : {false, true})
            for (unsigned seed = 1; seed < 9; ++seed) {
                const Shape shape = soup(200, seed);
                const Receiver receiver = receiverAt(glm::vec3(0.02f, -0.01f, 0.03f), glm::vec3(0.6f, 0, 0.8f));
                EXPECT_LE(differing(shape, receiver, size, backs), size * size / 400) << size << backs << seed;
                EXPECT_GT(setBits(oneByOne(shape, receiver, size, backs)), size * size / 10);
            }
}

TEST(Silhouettes, ClosedSurfacesFromOutsideWithinAndBelow) {
    for (const int size : {32, 64})
        for (const glm::vec3& middle : {glm::vec3(0, 0, 0.5f), {0.4f, 0.1f, 0.1f}, {0, 0, -0.5f}, {0.3f, 0, 0}}) {
            const Receiver receiver = receiverAt(glm::vec3(0), glm::vec3(0, 0, 1));
            const Shape shape = sphere(middle, 0.25f, false);
            EXPECT_LE(differing(shape, receiver, size, false), size * size / 200) << middle.x << ' ' << middle.z;
        }
    const Receiver within = receiverAt(glm::vec3(0.05f, 0.02f, -0.1f), glm::vec3(0, 0.6f, 0.8f));
    EXPECT_EQ(setBits(bySilhouettes(sphere(glm::vec3(0), 0.4f, true), std::array{within}, 0, 32, false)), 32 * 32);
    EXPECT_EQ(setBits(bySilhouettes(sphere(glm::vec3(0), 0.4f, false), std::array{within}, 0, 32, false)), 0);
}

TEST(Silhouettes, EdgesAndCornersRightOverhead) {  // every pole lies on an edge or is a corner, which is in no triangle
    const Shape shape = roof(3);
    for (const float x : {0.0f, 0.0625f, 0.125f})
        for (const float y : {0.0f, 0.0625f, -0.125f})
            for (const Receiver& receiver :
                 {receiverAt({x, y, 0}, {0, 0, 1}), Receiver{{x, y, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},
                  Receiver{{x, y, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}})
                EXPECT_LE(differing(shape, receiver, 32, false), 8) << x << ' ' << y;
}

TEST(Silhouettes, ManyLayersAreOne) {  // more than a byte counts, and all edges the same
    const Shape one = soup(6, 3);
    Shape many = one;
    for (int layer = 1; layer < 700; ++layer)
        for (const glm::uvec3& t : one.triangles) {
            const auto first = static_cast<std::uint32_t>(many.points.size());
            for (int c = 0; c < 3; ++c) many.points.push_back(one.points[t[c]]);
            many.triangles.push_back(glm::uvec3(first) + glm::uvec3(0, 1, 2));
        }
    const Receiver receivers[] = {receiverAt(glm::vec3(0), glm::vec3(0, 0, 1))};
    EXPECT_EQ(bySilhouettes(many, receivers, 0, 32, true), bySilhouettes(one, receivers, 0, 32, true));
}

TEST(Silhouettes, EachOfAGroupSeesAsAlone) {
    const Shape shape = soup(300, 5);
    std::vector<Receiver> receivers;
    std::mt19937 random(2);
    std::normal_distribution<float> normal;
    for (std::size_t k = 0; k < kLanes; ++k)
        receivers.push_back(receiverAt(0.2f * glm::vec3(normal(random), normal(random), normal(random)),
                                       glm::normalize(glm::vec3(normal(random), normal(random), normal(random)))));
    for (std::size_t k = 0; k < kLanes; ++k) {
        const Receiver alone[] = {receivers[k]};
        EXPECT_EQ(bySilhouettes(shape, receivers, k, 32, true), bySilhouettes(shape, alone, 0, 32, true)) << k;
    }
}

// Some triangles are taken for the wrong side, also right overhead, where one layer too many would hide all.
TEST(Silhouettes, WhatAGroupSharesErrsLittle) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> within(-1, 1);
    int wrong = 0, all = 0, poles = 0;
    for (int round = 0; round < 40; ++round) {
        const glm::vec3 middle(0.3f * within(random), 0.3f * within(random), 0.5f + 0.1f * within(random));
        const float radius = 0.2f;
        const Shape shape = sphere(middle, radius, false);
        std::vector<Receiver> receivers;
        for (std::size_t k = 0; k < kLanes; ++k) {
            const glm::vec3 point = 0.05f * glm::vec3(within(random), within(random), within(random));
            // Every pole within a hundredth of the limb.
            const glm::vec3 d = middle - point, side = glm::normalize(glm::cross(d, glm::vec3(1, within(random), 0)));
            const float limb = radius / std::sqrt(glm::dot(d, d) - radius * radius) * (1 + 0.05f * within(random));
            receivers.push_back(receiverAt(point, glm::normalize(glm::normalize(d) + limb * side)));
        }
        for (std::size_t k = 0; k < kLanes; ++k) {
            const Words each = bySilhouettes(shape, receivers, k, 32, false);
            const Words shared = bySilhouettes(shape, receivers, k, 32, false, VectorSet::Widest, 2.0f);
            int bits = 0;
            for (std::size_t w = 0; w < each.size(); ++w) bits += std::popcount(each[w] ^ shared[w]);
            EXPECT_LE(bits, 32) << round << ' ' << k;
            wrong += bits;
            all += setBits(each);
            poles += static_cast<int>(each[0] & 1);
        }
    }
    EXPECT_GT(wrong, 0);
    EXPECT_LT(wrong, all / 100);
    EXPECT_GT(poles, 200);  // of 640
    EXPECT_LT(poles, 440);
}

TEST(Silhouettes, SameBitsForAnyVectors) {
    const Receiver receivers[] = {receiverAt(glm::vec3(0), glm::vec3(0, 0.8f, 0.6f))};
    for (const Shape& shape : {soup(200, 7), sphere({0.1f, 0.1f, 0.4f}, 0.3f, false), roof(2)})
        for (const int size : {16, 32, 64, 128}) {
            const Words expected = bySilhouettes(shape, receivers, 0, size, true, VectorSet::Plain);
            for (const VectorSet set : {VectorSet::Avx2, VectorSet::Avx512}) {
                if (!processorHas(set)) continue;
                EXPECT_EQ(bySilhouettes(shape, receivers, 0, size, true, set), expected) << size;
            }
        }
}

TEST(Silhouettes, WhatTouchesAFaceHasItBelow) {
    const Shape ground{{{-1, -1, 0}, {1, -1, 0}, {0, 2, 0}}, {{0, 1, 2}}};
    const auto hidden = [](const Shape& shape, const glm::vec3& point, const glm::vec3& normal) {
        const Receiver receivers[] = {receiverAt(point, normal)};
        return setBits(bySilhouettes(shape, receivers, 0, 32, false));
    };
    for (const float height : {0.0f, 5e-8f, -5e-8f}) {
        EXPECT_EQ(hidden(ground, {0, 0.1f, height}, {0, 0, -1}), 32 * 32) << height;
        EXPECT_EQ(hidden(ground, {0, 0.1f, height}, {0, 0, 1}), 0) << height;
    }
    Shape sheet = ground;  // both its sides, and a point on it that looks along it or a little away
    sheet.triangles.emplace_back(0, 2, 1);
    for (const glm::vec3& normal : {glm::vec3(1, 0, 0.05f), glm::vec3(1, 0, -0.05f), glm::vec3(0, -1, 0.01f)})
        EXPECT_NEAR(hidden(sheet, {0, 0.1f, 0}, glm::normalize(normal)), 32 * 16, 64) << normal.z;
}

TEST(Silhouettes, NothingHidesNothing) {
    const Receiver receivers[] = {receiverAt(glm::vec3(0), glm::vec3(0, 0, 1))};
    const Shape flat{{{0, 0, 0.5f}, {0.1f, 0, 0.5f}, {0.2f, 0, 0.5f}}, {{0, 1, 2}}};  // without area
    EXPECT_EQ(setBits(bySilhouettes(flat, receivers, 0, 32, true)), 0);
    EXPECT_EQ(setBits(bySilhouettes(sphere({0, 0, -1}, 0.5f, false), receivers, 0, 32, true)), 0);
}

}  // namespace
}  // namespace nacre
