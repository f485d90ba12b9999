#include <gtest/gtest.h>

#include <cmath>

#include "bench/embree_transfer.hpp"
#include "bench/transfer_sweep.hpp"

namespace nacre::bench {
namespace {

TransferMesh cloth() { return transferMeshes("no/such/folder", true).meshes.at(0); }

TEST(TransferMeshes, MissingFilesAreNoted) {
    const TransferMeshList list = transferMeshes("no/such/folder", true);
    EXPECT_EQ(list.notes.size(), 4u);
    ASSERT_EQ(list.meshes.size(), 1u);
    EXPECT_EQ(list.meshes[0].frames.size(), 3u);
    EXPECT_NE(list.meshes[0].frames[0], list.meshes[0].frames[2]);
}

TEST(TransferMeshes, SubdividedHasTheSameSurface) {
    const TransferMesh mesh = cloth(), fine = subdivided(mesh);
    EXPECT_EQ(fine.mesh.triangles.size(), 4 * mesh.mesh.triangles.size());
    EXPECT_EQ(fine.mesh.vertexCount(), fine.rest.size());
    const auto area = [](const TransferMesh& m) {
        double sum = 0;
        for (const glm::uvec3& t : m.mesh.triangles) {
            const std::vector<glm::vec3>& p = m.frames[1];
            sum += 0.5 * static_cast<double>(glm::length(glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x])));
        }
        return sum;
    };
    EXPECT_NEAR(area(fine) / area(mesh), 1, 1e-4);
}

TEST(TransferRivals, MoreRaysAreNearerToTheTruthAndAllAgree) {
    const TransferMesh mesh = cloth();
    const TransferSweepOptions options{.repeats = 1, .sampled = 40, .rays = 4096};
    const std::vector<TransferMeasurement> found =
        measureTransfer(mesh, {ours(mesh, {}), papers(mesh, {}), embree(mesh, 64), embree(mesh, 512)}, options);
    EXPECT_LT(found[0].error, 0.03);
    EXPECT_LT(found[1].error, 0.1);
    EXPECT_LT(found[2].error, 0.08);
    EXPECT_LT(found[3].error, 0.4 * found[2].error);
    for (const TransferMeasurement& m : found) {
        EXPECT_EQ(m.vertices, mesh.rest.size());
        EXPECT_GT(m.cpuSeconds, 0);
        EXPECT_LT(m.noise, 0.01);
    }
    EXPECT_THROW(EmbreeTransfer(mesh.mesh, 24), std::invalid_argument);
}

TEST(TransferRivals, EmbreesCurveIsStraightInLogarithms) {
    std::vector<TransferMeasurement> curve;
    for (const double rays : {64.0, 256.0, 1024.0}) {
        TransferMeasurement m;
        m.method = "Embree", m.vertices = 10;
        m.error = 2 * std::pow(rays, -0.75), m.cpuSeconds = 1e-6 * rays;
        curve.push_back(m);
    }
    for (const double rays : {32.0, 100.0, 256.0, 4000.0})
        EXPECT_NEAR(embreeSecondsAt(curve, 2 * std::pow(rays, -0.75)) / (1e-7 * rays), 1, 1e-9) << rays;
    EXPECT_EQ(embreeSecondsAt({curve[0]}, 0.1), 0);
}

TEST(TransferSection, ShowsEveryMeasurementAndItsPlots) {
    TransferMeasurement m;
    m.mesh = "sheet & floor", m.method = "nacre", m.setting = "mask 32", m.vertices = 1000;
    m.error = 0.02, m.cpuSeconds = 0.002;
    const std::string html = transferSection({m});
    EXPECT_NE(html.find("sheet &amp; floor"), std::string::npos);
    EXPECT_NE(html.find("2 %"), std::string::npos);
    EXPECT_NE(html.find("<svg"), std::string::npos);
    EXPECT_TRUE(transferSection({}).empty());
    EXPECT_EQ(transferJson(m)["vertices_per_second"], 1e6);
}

}  // namespace
}  // namespace nacre::bench
