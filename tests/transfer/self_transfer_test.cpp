#include "transfer/self_transfer.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "core/math.hpp"
#include "envmaps/spherical_harmonics.hpp"
#include "reference/transfer_trace.hpp"

namespace nacre {
namespace {

AnimatedMesh sphere(int rings, int sides, float radius = 1, glm::vec3 centre = {}) {
    AnimatedMesh a;
    a.frames.resize(1);
    std::vector<glm::vec3>& p = a.frames[0];
    for (int i = 1; i < rings; ++i)
        for (int j = 0; j < sides; ++j) {
            const double theta = kPi * i / rings, phi = 2 * kPi * j / sides;
            p.push_back(centre + radius * glm::vec3(std::sin(theta) * std::cos(phi), std::cos(theta),
                                                    std::sin(theta) * std::sin(phi)));
        }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>((i - 1) * sides + j % sides); };
    for (int i = 1; i + 1 < rings; ++i)
        for (int j = 0; j < sides; ++j) {
            a.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
            a.triangles.push_back({at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
        }
    const auto top = static_cast<std::uint32_t>(p.size());
    p.push_back(centre + glm::vec3(0, radius, 0));
    p.push_back(centre - glm::vec3(0, radius, 0));
    for (int j = 0; j < sides; ++j) {
        a.triangles.push_back({top, at(1, j + 1), at(1, j)});
        a.triangles.push_back({top + 1, at(rings - 1, j), at(rings - 1, j + 1)});
    }
    return a;
}

/// A bent tube whose ends come near each other: folds, near and far blockers.
AnimatedMesh hook(int rings, int sides, double bend = 4.2) {
    AnimatedMesh a;
    a.frames.resize(1);
    for (int i = 0; i < rings; ++i) {
        const double s = bend * i / (rings - 1), r = 0.3 + 0.08 * std::sin(9 * s);
        const Vec3 centre(std::cos(s), 0.15 * s, std::sin(s)), out(std::cos(s), 0, std::sin(s));
        for (int j = 0; j < sides; ++j) {
            const double phi = 2 * kPi * j / sides;
            a.frames[0].emplace_back(centre + r * (std::cos(phi) * out + Vec3(0, std::sin(phi), 0)));
        }
    }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * sides + j % sides); };
    for (int i = 0; i + 1 < rings; ++i)
        for (int j = 0; j < sides; ++j) {
            a.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
            a.triangles.push_back({at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
        }
    const auto first = static_cast<std::uint32_t>(a.frames[0].size());
    for (const int end : {0, rings - 1}) {
        glm::vec3 middle(0);
        for (int j = 0; j < sides; ++j) middle += a.frames[0][at(end, j)] / static_cast<float>(sides);
        a.frames[0].push_back(middle);
    }
    for (int j = 0; j < sides; ++j) {
        a.triangles.push_back({first, at(0, j + 1), at(0, j)});
        a.triangles.push_back({first + 1, at(rings - 1, j), at(rings - 1, j + 1)});
    }
    return a;
}

struct Case {
    WeldedMesh mesh;
    std::vector<glm::vec3> positions;
    TransferFrame frame;
};

Case computed(const AnimatedMesh& a, const SelfTransferOptions& options = {}) {
    const WeldedMesh mesh = weldMesh(a, "mesh");
    std::vector<glm::vec3> positions = weldedPositions(mesh, a.frames[0]);
    const SelfTransfer transfer(mesh, positions, options);
    return {mesh, positions, transfer.compute(positions)};
}

TransferError errorOf(const Case& c, int order = 4, std::size_t rays = 4096) {
    std::vector<std::uint32_t> all(c.positions.size());
    std::iota(all.begin(), all.end(), 0u);
    const std::vector<double> truth = tracedTransfer(c.mesh.triangles, c.positions, c.frame.normals, all, order, rays);
    return transferError(c.frame.coefficients, truth, static_cast<std::size_t>((order + 1) * (order + 1)));
}

SelfTransferOptions withCoarse(std::size_t coarse) {
    SelfTransferOptions o;
    o.coarse = coarse;
    return o;
}

TEST(SelfTransfer, ASphereShadowsNothing) {
    const Case c = computed(sphere(12, 20), withCoarse(0));
    ASSERT_TRUE(c.mesh.closed);
    EXPECT_EQ(c.frame.listed, static_cast<double>(c.mesh.triangles.size()));
    const std::vector<double> open = openTransfer(4);
    for (std::size_t v = 0; v < c.positions.size(); ++v) {
        const std::vector<double> y = realHarmonics(4, c.frame.normals[v]);
        for (int l = 0; l <= 4; ++l)
            for (int m = -l; m <= l; ++m) {
                const auto i = static_cast<std::size_t>(l * l + l + m);
                const double expected = open[static_cast<std::size_t>(l)] * std::sqrt(4 * kPi / (2 * l + 1)) * y[i];
                ASSERT_NEAR(c.frame.coefficients[25 * v + i], expected, 1e-5) << v << " " << l << " " << m;
            }
    }
}

TEST(SelfTransfer, AgreesWithRays) {  // issue's bars for the mesh itself; a margin on 3 % for levels
    const AnimatedMesh mesh = hook(40, 24);
    EXPECT_LT(errorOf(computed(mesh, withCoarse(0))).mean, 0.015);
    SelfTransferOptions fine = withCoarse(0);
    fine.mask = 64;
    EXPECT_LT(errorOf(computed(mesh, fine)).mean, 0.007);
    SelfTransferOptions coarse = withCoarse(200);
    coarse.lodAngle = 0.5;
    const Case c = computed(mesh, coarse);
    EXPECT_LT(errorOf(c).mean, 0.04);
    EXPECT_LT(c.frame.drawn, c.frame.listed);
    EXPECT_LT(c.frame.listed, 0.6 * static_cast<double>(mesh.triangles.size()));
}

TEST(SelfTransfer, OrdersAgreeInTheirCommonBands) {
    SelfTransferOptions high = withCoarse(0), low = high;
    high.order = 6;
    low.order = 2;
    const AnimatedMesh mesh = hook(20, 12);
    const Case a = computed(mesh, high), b = computed(mesh, low);
    for (std::size_t v = 0; v < a.positions.size(); ++v)
        for (std::size_t i = 0; i < 9; ++i)
            ASSERT_NEAR(a.frame.coefficients[49 * v + i], b.frame.coefficients[9 * v + i], 2e-5) << v << " " << i;
    EXPECT_LT(errorOf(a, 6).mean, 0.02);
}

TEST(SelfTransfer, SameBitsForAnyThreadsAndVectors) {
    const AnimatedMesh mesh = hook(30, 16);
    SelfTransferOptions o = withCoarse(150);
    o.threads = 1;
    o.vectors = VectorSet::Plain;
    const TransferFrame one = computed(mesh, o).frame;
    for (const VectorSet set : {VectorSet::Plain, VectorSet::Avx2, VectorSet::Avx512}) {
        if (!processorHas(set)) continue;
        o.vectors = set;
        o.threads = 7;
        EXPECT_EQ(computed(mesh, o).frame.coefficients, one.coefficients) << static_cast<int>(set);
    }
}

TEST(SelfTransfer, MeshesThatAreNotClosedBlockByBothSides) {
    AnimatedMesh a = hook(30, 16);  // without its ends, so that one sees the inside
    a.triangles.resize(a.triangles.size() - 32);
    const Case c = computed(a, withCoarse(0));
    EXPECT_FALSE(c.mesh.closed);
    EXPECT_LT(errorOf(c).mean, 0.02);
}

TEST(SelfTransfer, OnlyWantedVerticesAreComputed) {
    const AnimatedMesh a = hook(20, 12);
    const WeldedMesh mesh = weldMesh(a, "mesh");
    const std::vector<glm::vec3> positions = weldedPositions(mesh, a.frames[0]);
    const SelfTransfer transfer(mesh, positions, withCoarse(0));
    std::vector<std::uint8_t> wanted(positions.size(), 0);
    for (std::size_t v = 0; v < wanted.size(); v += 3) wanted[v] = 1;
    const TransferFrame all = transfer.compute(positions), some = transfer.compute(positions, wanted);
    EXPECT_EQ(some.computed, (positions.size() + 2) / 3);
    for (std::size_t v = 0; v < wanted.size(); ++v)
        for (std::size_t i = 0; i < 25; ++i)
            ASSERT_NEAR(some.coefficients[25 * v + i], wanted[v] ? all.coefficients[25 * v + i] : 0.0f, 1e-6) << v;
}

TEST(SelfTransfer, FarFromTheOriginIsTheSame) {
    AnimatedMesh a = hook(20, 12), b = a;
    for (glm::vec3& p : a.frames[0])
        p = glm::vec3(std::round(p.x * 1024), std::round(p.y * 1024), std::round(p.z * 1024)) / 1024.0f;
    b.frames[0] = a.frames[0];
    for (glm::vec3& p : b.frames[0]) p += glm::vec3(2048, -1024, 512);
    EXPECT_EQ(computed(a, withCoarse(0)).frame.coefficients, computed(b, withCoarse(0)).frame.coefficients);
}

TEST(SelfTransfer, AnyScaleIsTheSame) {
    AnimatedMesh a = hook(20, 12), b = a;
    const std::vector<float> expected = computed(a, withCoarse(0)).frame.coefficients;
    for (const float scale : {0x1p-110f, 0x1p33f, 0x1p47f, 0x1p110f}) {
        for (std::size_t v = 0; v < a.frames[0].size(); ++v) b.frames[0][v] = scale * a.frames[0][v];
        EXPECT_EQ(computed(b, withCoarse(0)).frame.coefficients, expected) << scale;
    }
}

TEST(SelfTransfer, EverythingBlockedIsZero) {  // inside a closed shell that faces it
    AnimatedMesh a = sphere(8, 12, 0.2f);
    const AnimatedMesh shell = sphere(10, 16, 5);
    const auto first = static_cast<std::uint32_t>(a.frames[0].size());
    a.frames[0].insert(a.frames[0].end(), shell.frames[0].begin(), shell.frames[0].end());
    for (const glm::uvec3& t : shell.triangles) a.triangles.push_back({first + t.x, first + t.z, first + t.y});
    const Case c = computed(a, withCoarse(0));
    for (std::size_t i = 0; i < 25 * std::size_t{first}; ++i) ASSERT_NEAR(c.frame.coefficients[i], 0, 4e-3) << i;
}

TEST(SelfTransfer, HardMeshes) {
    const auto finite = [](const Case& c) {
        for (const float x : c.frame.coefficients) ASSERT_TRUE(std::isfinite(x));
    };
    AnimatedMesh one;  // one triangle, and one vertex that no triangle has
    one.frames = {{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {5, 5, 5}}};
    one.triangles = {{0, 2, 1}};
    const Case single = computed(one);
    finite(single);
    EXPECT_EQ(single.frame.computed, 3u);
    for (std::size_t i = 75; i < 100; ++i) EXPECT_EQ(single.frame.coefficients[i], 0) << "no normal, no transfer";
    AnimatedMesh flat = hook(20, 12);  // triangles without area and twice the same
    for (std::size_t t = 0; t < 50; ++t) flat.triangles.push_back(flat.triangles[t]);
    flat.triangles.push_back({0, 0, 1});
    flat.frames[0][7] = flat.frames[0][8];
    finite(computed(flat));
    finite(computed(flat, withCoarse(100)));
    AnimatedMesh point;  // all at one place
    point.frames = {std::vector<glm::vec3>(3, glm::vec3(1))};
    point.triangles = {{0, 1, 2}};
    EXPECT_EQ(computed(point).frame.computed, 0u);
}

TEST(SelfTransfer, FollowsDeformation) {  // levels made at rest serve a pose that is bent much further
    const AnimatedMesh rest = hook(40, 24, 2.0), bent = hook(40, 24, 4.2);
    const WeldedMesh mesh = weldMesh(rest, "mesh");
    const std::vector<glm::vec3> positions = weldedPositions(mesh, rest.frames[0]),
                                 now = weldedPositions(mesh, bent.frames[0]);
    SelfTransferOptions o = withCoarse(200);
    o.lodAngle = 0.5;
    const SelfTransfer transfer(mesh, positions, o);
    EXPECT_LT(errorOf({mesh, now, transfer.compute(now)}).mean, 0.05);
}

TEST(SelfTransfer, LevelsErrAsMuchAsIsLetTo) {
    const AnimatedMesh mesh = hook(40, 24);
    double before = 0, drawn = 1e9;
    for (const double error : {0.0, 0.05, 0.3}) {
        SelfTransferOptions o = withCoarse(300);
        o.lodError = error;
        const Case c = computed(mesh, o);
        const double found = errorOf(c).mean;
        EXPECT_GE(found, before) << error;
        EXPECT_LT(c.frame.drawn, drawn) << error;
        EXPECT_LT(found, 0.02 + 0.3 * error) << error;
        before = found, drawn = c.frame.drawn;
    }
}

TEST(SelfTransfer, RefusesWhatItCannotCompute) {
    const AnimatedMesh a = hook(20, 12);
    const WeldedMesh mesh = weldMesh(a, "mesh");
    std::vector<glm::vec3> positions = weldedPositions(mesh, a.frames[0]);
    SelfTransferOptions o;
    for (const auto change :
         {+[](SelfTransferOptions& x) { x.mask = 48; }, +[](SelfTransferOptions& x) { x.order = 7; },
          +[](SelfTransferOptions& x) { x.rings = 3; }, +[](SelfTransferOptions& x) { x.lodAngle = -1; },
          +[](SelfTransferOptions& x) { x.nearby = 0.5; }, +[](SelfTransferOptions& x) { x.lodError = -0.1; }}) {
        o = {};
        change(o);
        EXPECT_THROW(SelfTransfer(mesh, positions, o), std::invalid_argument);
    }
    const SelfTransfer transfer(mesh, positions, {});
    positions[3].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(transfer.compute(positions), std::invalid_argument);
    EXPECT_THROW(transfer.compute(std::span(positions).first(5)), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
