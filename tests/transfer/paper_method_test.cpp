#include "transfer/paper_method.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "core/math.hpp"
#include "reference/transfer_trace.hpp"
#include "transfer/plane_table.hpp"

namespace nacre {
namespace {

struct Triangle {
    glm::vec3 a, b, c;
};

/// Triangles about the origin that cross the horizon, lie high and lie low, facing it or not.
std::vector<Triangle> someTriangles(std::size_t count) {
    std::mt19937 random(7);
    const auto uniform = [&] { return static_cast<float>(2 * static_cast<double>(random()) / 4294967296.0 - 1); };
    const auto point = [&] { return glm::vec3(uniform(), uniform(), uniform()); };
    std::vector<Triangle> out;
    while (out.size() < count) {
        const glm::vec3 p = 1.5f * point();
        out.push_back({p + 0.6f * point(), p + 0.6f * point(), p + 0.6f * point()});
    }
    return out;
}

DiskMask drawn(const PlaneTable* table, const Triangle& t, bool bothSides) {
    const BlockerRow row = blockerRow(t.a, t.b, t.c);
    std::uint32_t indices[kLanes] = {0};
    DiskMask mask;
    diskKernel().draw(table, &row, Receiver{}, bothSides, indices, 1, mask);
    return mask;
}

/// Whether the ray from the origin meets the triangle: Cramer's rule in double, no planes.
bool meets(const Triangle& t, const Vec3& s) {
    const Vec3 a(t.a), b(t.b), c(t.c);
    const double volume = glm::dot(a, glm::cross(b, c));
    const double u = glm::dot(s, glm::cross(b, c)) / volume, v = glm::dot(a, glm::cross(s, c)) / volume,
                 w = glm::dot(a, glm::cross(b, s)) / volume;
    return u >= 0 && v >= 0 && w >= 0;
}

/// Share of the bits of all triangles that are wrong, of those that are set or should be.
double wrongBits(const PlaneTable* table, bool bothSides) {
    const DiskGrid& grid = diskGrid();
    std::size_t wrong = 0, set = 0;
    for (const Triangle& t : someTriangles(300)) {
        const bool facing = glm::dot(Vec3(t.a), glm::cross(Vec3(t.b), Vec3(t.c))) < 0;
        const DiskMask mask = drawn(table, t, bothSides);
        for (int j = 0; j < kDiskSize; ++j)
            for (int i = 0; i < kDiskSize; ++i) {
                if (!grid.inside.at(i, j)) continue;
                const bool truth = (facing || bothSides) && meets(t, {grid.x[i], grid.y[j], grid.z[j][i]});
                wrong += mask.at(i, j) != truth;
                set += mask.at(i, j) || truth;
            }
    }
    return static_cast<double>(wrong) / static_cast<double>(set);
}

TEST(PlaneTable, ExactPlanesAreRays) {
    for (const bool bothSides : {false, true}) EXPECT_LT(wrongBits(nullptr, bothSides), 1e-4);  // float against double
}

TEST(PlaneTable, WrongBitsFallWithTheTexels) {
    double before = 1;
    for (const int size : {16, 32, 64, 128, 256}) {
        const double wrong = wrongBits(planeTable(size).get(), false);
        EXPECT_LT(wrong, 0.75 * before) << size;
        EXPECT_GT(wrong, 0) << size;
        before = wrong;
    }
    EXPECT_LT(before, 0.025);  // measured 20, 12, 6.2, 3.1, 2.2 %
}

TEST(PlaneTable, EveryPlaneFindsATexelNearIt) {
    const auto table = planeTable(64);
    const DiskGrid& grid = diskGrid();
    for (const Triangle& t : someTriangles(100)) {
        const glm::vec3 n = glm::normalize(t.a);
        const DiskMask& mask = table->masks[table->indexOf(n)];
        for (int j = 0; j < kDiskSize; ++j)
            for (int i = 0; i < kDiskSize; ++i) {
                const float above = n.x * grid.x[i] + n.y * grid.y[j] + n.z * grid.z[j][i];
                if (grid.inside.at(i, j) && std::abs(above) > 0.03f) {  // a texel's half diagonal: √2/64
                    EXPECT_EQ(mask.at(i, j), above > 0);
                }
            }
    }
}

TEST(PlaneTable, ASharedEdgeLeavesNoGap) {
    const auto table = planeTable(32);
    const glm::vec3 a(-0.5f, -0.3f, 0.9f), b(0.6f, -0.2f, 0.8f), c(0.3f, 0.7f, 0.7f), d(-0.4f, 0.5f, 0.9f);
    const DiskMask one = drawn(table.get(), {a, c, b}, false), other = drawn(table.get(), {a, d, c}, false);
    const DiskMask bd = drawn(table.get(), {b, d, c}, false), ad = drawn(table.get(), {b, a, d}, false);
    int holes = 0;
    for (int j = 8; j < 24; ++j)
        for (int i = 10; i < 22; ++i) {
            const bool first = one.at(i, j) || other.at(i, j), second = bd.at(i, j) || ad.at(i, j);
            const Vec3 s(diskGrid().x[i], diskGrid().y[j], diskGrid().z[j][i]);
            if (meets({a, b, c}, s) || meets({a, c, d}, s)) holes += !first && second;
        }
    EXPECT_EQ(holes, 0);
}

TEST(PlaneTable, DegenerateTrianglesSetNothing) {
    const glm::vec3 a(0.2f, 0.1f, 0.5f), b(-0.3f, 0.2f, 0.4f);
    for (const Triangle& t : {Triangle{a, a, b}, {a, b, b}, {a, a, a}, {glm::vec3(0), a, b}}) {
        const auto table = planeTable(32);
        for (const bool bothSides : {false, true}) {
            const DiskMask mask = drawn(table.get(), t, bothSides), exact = drawn(nullptr, t, bothSides);
            for (int j = 0; j < kDiskSize; ++j) EXPECT_EQ(mask.rows[j] | exact.rows[j], 0u);
        }
    }
}

TEST(PlaneTable, SameBitsForAllVectors) {
    const auto table = planeTable(32);
    DiskIntegrals integrals;
    for (std::size_t b = 0; b < kDiskBlocks; ++b)
        for (std::size_t c = 0; c < 2 * kLanes; ++c) integrals.perBit[b][c] = 0.01f * static_cast<float>(b * 7 + c * c);
    std::vector<BlockerRow> rows;
    const std::vector<Triangle> triangles = someTriangles(300);
    std::vector<std::uint32_t> indices(triangles.size() + kLanes);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        rows.push_back(blockerRow(0.2f * triangles[t].a, 0.3f * triangles[t].b, triangles[t].c));
        indices[t] = static_cast<std::uint32_t>(t);
    }
    for (const PlaneTable* planes : {table.get(), static_cast<const PlaneTable*>(nullptr)}) {
        std::vector<std::uint32_t> first;
        float firstSums[2 * kLanes];
        for (const VectorSet set : {VectorSet::Plain, VectorSet::Avx2, VectorSet::Avx512}) {
            if (!processorHas(set)) continue;
            DiskMask mask;
            float sums[2 * kLanes];
            diskKernel(set).draw(planes, rows.data(), Receiver{}, false, indices.data(), 29, mask);
            diskKernel(set).integrate(integrals, mask, sums);
            const std::vector<std::uint32_t> bits(mask.rows, mask.rows + kDiskSize);
            if (first.empty()) first = bits, std::copy_n(sums, 2 * kLanes, firstSums);
            EXPECT_EQ(bits, first);
            for (int c = 0; c < 2 * kLanes; ++c) EXPECT_EQ(sums[c], firstSums[c]);
        }
        EXPECT_NE(first, std::vector<std::uint32_t>(kDiskSize, 0));
    }
}

TEST(PlaneTable, AnEdgeSeenEndOnIsAtMostALine) {
    const auto table = planeTable(128);
    for (const Triangle& t : someTriangles(2000))
        for (const PlaneTable* planes : {table.get(), static_cast<const PlaneTable*>(nullptr)}) {
            const DiskMask mask = drawn(planes, {t.c, t.a, 2.0f * t.a}, true);
            int bits = 0;
            for (int j = 0; j < kDiskSize; ++j) bits += std::popcount(mask.rows[j] & diskGrid().inside.rows[j]);
            EXPECT_LE(bits, kDiskSize);
        }
}

TEST(PlaneTable, RefusesSizes) {
    EXPECT_THROW(planeTable(0), std::invalid_argument);
    EXPECT_THROW(planeTable(513), std::invalid_argument);
}

/// A torus whose tube is thin on one side and fat on the other: closed, shadows itself.
WeldedMesh torus(int around, int along, std::vector<glm::vec3>& positions) {
    AnimatedMesh a;
    a.frames.resize(1);
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < along; ++j) {
            const double u = 2 * kPi * i / around, v = 2 * kPi * j / along, tube = 0.5 + 0.2 * std::cos(2 * u);
            const double r = 1 + tube * std::cos(v);
            a.frames[0].emplace_back(r * std::cos(u), tube * std::sin(v), r * std::sin(u));
        }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i % around * along + j % along); };
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < along; ++j) {
            a.triangles.emplace_back(at(i, j), at(i, j + 1), at(i + 1, j + 1));
            a.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i + 1, j));
        }
    const WeldedMesh mesh = weldMesh(a, "torus");
    positions = weldedPositions(mesh, a.frames[0]);
    return mesh;
}

double errorOf(const WeldedMesh& mesh, std::span<const glm::vec3> positions, const PaperMethodOptions& options) {
    const TransferFrame frame = PaperMethod(mesh, positions, options).compute(positions);
    std::vector<std::uint32_t> vertices;
    std::vector<float> found;
    for (std::uint32_t v = 0; v < positions.size(); v += 7) {
        vertices.push_back(v);
        found.insert(found.end(), &frame.coefficients[25 * v], &frame.coefficients[25 * v] + 25);
    }
    return transferError(found, tracedTransfer(mesh.triangles, positions, frame.normals, vertices, 4, 4096), 25).mean;
}

// Measured 4.6, 2.3 and 2.0 %.
TEST(PaperMethod, IsNearRays) {
    std::vector<glm::vec3> positions;
    const WeldedMesh mesh = torus(48, 24, positions);
    ASSERT_TRUE(mesh.closed);
    const double printed = errorOf(mesh, positions, {}), means = errorOf(mesh, positions, {.sampledBlocks = false});
    const double fine = errorOf(mesh, positions, {.table = 0, .coarse = 0, .sampledBlocks = false});
    EXPECT_LT(printed, 0.06);  // HEMI table 1: 2.5 to 7.9 %
    EXPECT_LT(means, 0.03);
    EXPECT_LT(fine, 0.025);
}

TEST(PaperMethod, SameBitsForAnyThreads) {
    std::vector<glm::vec3> positions;
    const WeldedMesh mesh = torus(24, 12, positions);
    const TransferFrame one =
        PaperMethod(mesh, positions, {.table = 32, .coarse = 100, .threads = 1}).compute(positions);
    const TransferFrame many =
        PaperMethod(mesh, positions, {.table = 32, .coarse = 100, .threads = 5}).compute(positions);
    EXPECT_EQ(one.coefficients, many.coefficients);
    EXPECT_EQ(one.computed, positions.size());
    EXPECT_GT(one.listed, 100);
    EXPECT_LT(one.drawn, one.listed);
}

TEST(PaperMethod, RefusesWhatItCannotDo) {
    std::vector<glm::vec3> positions;
    const WeldedMesh mesh = torus(8, 6, positions);
    EXPECT_THROW(PaperMethod(mesh, positions, {.rings = 3}), std::invalid_argument);
    EXPECT_THROW(PaperMethod(mesh, positions, {.table = -1}), std::invalid_argument);
    const PaperMethod method(mesh, positions, {.table = 8});
    EXPECT_THROW(method.compute(std::span<const glm::vec3>(positions).first(3)), std::invalid_argument);
    positions[0].x = NAN;
    EXPECT_THROW(method.compute(positions), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
