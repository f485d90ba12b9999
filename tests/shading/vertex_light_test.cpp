// Vertices with a radiance as the rasteriser draws them against rays at the same pixels.
#include <gtest/gtest.h>

#include "gpu_evaluate.hpp"
#include "reference/raytrace.hpp"
#include "shading/primitives.hpp"
#include "shading/vertex_light_pass.hpp"

namespace nacre {
namespace {

constexpr int kSize = 96;
constexpr double kFloat = 2e-4;  // of values up to 6; a hit moves by 1e-5 where the mesh is seen at a slant

/// Affine in the position, so that interpolating over a triangle changes nothing; below 0 and above 1 too.
glm::vec3 colorAt(const Vec3& p) { return {3 + 2 * p.x + p.y, -1 + 0.5 * p.z, 2 * p.y}; }

Camera lookingAt(double side) {
    Camera camera;
    camera.eye = side * Vec3(1.5, 2.0, 2.5);
    camera.fovY = 0.8;
    camera.near = 0.5;
    camera.far = 8;
    return camera;
}

/// A torus has its seams' vertices twice: numbered backwards here, each place once.
struct Welded {
    Mesh mesh = makeTorus(1, 0.4f, 24, 16);
    std::vector<std::uint32_t> weldOf;
    std::vector<glm::vec3> positions, colors;

    Welded() {
        std::vector<std::uint32_t> found;
        for (const glm::vec3& p : mesh.positions) {
            const auto at = std::find_if(positions.begin(), positions.end(),
                                         [&](const glm::vec3& q) { return glm::length(p - q) < 1e-5f; });
            found.push_back(static_cast<std::uint32_t>(at - positions.begin()));
            if (at == positions.end()) positions.push_back(p);
        }
        for (const std::uint32_t w : found) weldOf.push_back(static_cast<std::uint32_t>(positions.size()) - 1 - w);
        std::reverse(positions.begin(), positions.end());
        for (const glm::vec3& p : positions) colors.push_back(colorAt(p));
    }
};

RenderTarget draw(const GpuVertexLight& gpu, const Camera& camera) {
    ProgramLoader loader;
    RenderTarget target({.width = kSize, .height = kSize});
    target.clear();
    renderVertexLight(loader, target, gpu, camera);
    return target;
}

/// Worst difference from colorAt where rays hit, over pixels that both cover.
double worstDifference(const Mesh& mesh, const Camera& camera, const Image& picture) {
    const TracedSurface truth = traceSurface(mesh, camera, {.width = kSize, .height = kSize});
    double worst = 0;
    int counted = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const SurfacePoint& p = truth.points[static_cast<std::size_t>(y * kSize + x)];
            if (!TracedSurface::hit(p) || picture.at(x, y, 3) == 0) continue;
            if (glm::dot(p.normal, p.toEye) < 0.1) continue;  // at outlines the two may see different triangles
            ++counted;
            const glm::vec3 expected = colorAt(p.position);
            for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(1.0 * picture.at(x, y, c) - expected[c]));
        }
    EXPECT_GT(counted, 1500);
    return worst;
}

TEST(VertexLight, IsEachVertexsRadianceInterpolated) {
    test::context();
    const Welded w;
    EXPECT_LT(w.positions.size(), w.mesh.positions.size());
    GpuVertexLight gpu(w.mesh.triangles, w.weldOf);
    gpu.update(w.positions, w.colors);
    EXPECT_LT(worstDifference(w.mesh, lookingAt(1), draw(gpu, lookingAt(1)).read(4)), kFloat);
}

TEST(VertexLight, TheNextFrameReplacesPositionsAndRadiance) {
    test::context();
    Welded w;
    GpuVertexLight gpu(w.mesh.triangles, w.weldOf);
    gpu.update(w.positions, std::vector<glm::vec3>(w.positions.size(), glm::vec3(9)));
    draw(gpu, lookingAt(1));
    const auto moved = [](const glm::vec3& p) { return glm::vec3(0.9f * p.z, p.x, 0.8f * p.y); };
    for (glm::vec3& p : w.mesh.positions) p = moved(p);
    for (std::size_t i = 0; i < w.positions.size(); ++i) {
        w.positions[i] = moved(w.positions[i]);
        w.colors[i] = colorAt(w.positions[i]);
    }
    gpu.update(w.positions, w.colors);
    EXPECT_LT(worstDifference(w.mesh, lookingAt(1), draw(gpu, lookingAt(1)).read(4)), kFloat);
}

TEST(VertexLight, BackFacesAreBlack) {
    test::context();
    const std::vector<glm::vec3> positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, white(3, glm::vec3(1));
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}};
    const std::vector<std::uint32_t> weldOf = {0, 1, 2};
    GpuVertexLight gpu(triangles, weldOf);
    gpu.update(positions, white);
    for (const double side : {1.0, -1.0}) {
        const Image picture = draw(gpu, lookingAt(side)).read(4);
        EXPECT_EQ(picture.at(kSize / 2, kSize / 2, 0), side > 0 ? 1 : 0);
        EXPECT_EQ(picture.at(kSize / 2, kSize / 2, 3), 1);
    }
}

TEST(VertexLight, WrongSizesAreRefused) {
    test::context();
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}}, wrong = {{0, 1, 3}};
    const std::vector<std::uint32_t> weldOf = {0, 1, 2};
    EXPECT_THROW(GpuVertexLight({}, weldOf), std::invalid_argument);
    EXPECT_THROW(GpuVertexLight(wrong, weldOf), std::invalid_argument);
    GpuVertexLight gpu(triangles, weldOf);
    EXPECT_THROW(gpu.draw(), std::invalid_argument);
    const std::vector<glm::vec3> three(3), two(2);
    EXPECT_THROW(gpu.update(three, two), std::invalid_argument);
    EXPECT_THROW(gpu.update(two, three), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
