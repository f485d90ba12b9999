#include "transfer/cloth.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/error.hpp"

namespace nacre {
namespace {

constexpr std::size_t kCloth = 33 * 33;
constexpr double kGravity = 9.81, kStretch = 1.05;

/// Kinetic and potential energy of the cloth between two frames, for each kilogram [J/kg].
double energyAt(const AnimatedMesh& mesh, std::size_t frame) {
    double sum = 0;
    for (std::size_t v = 0; v < kCloth; ++v) {
        const Vec3 speed = Vec3(mesh.frames[frame + 1][v] - mesh.frames[frame][v]) * mesh.framesPerSecond;
        sum += 0.5 * glm::dot(speed, speed) + kGravity * mesh.frames[frame][v].y;
    }
    return sum / kCloth;
}

TEST(Cloth, IsThePapersModel) {
    ClothOptions options;
    options.frames = 1;
    const AnimatedMesh mesh = clothAnimation(options);
    EXPECT_EQ(mesh.vertexCount(), 1378u);
    EXPECT_EQ(mesh.triangles.size(), 2560u);
    EXPECT_NO_THROW(checkAnimation(mesh, "cloth"));
    for (const glm::uvec3& t : mesh.triangles)  // both faces look up at first
        EXPECT_GT(glm::cross(mesh.frames[0][t.y] - mesh.frames[0][t.x], mesh.frames[0][t.z] - mesh.frames[0][t.x]).y,
                  0);
}

TEST(Cloth, AThousandFramesHoldTogether) {
    ClothOptions options;
    options.frames = 1000;
    const AnimatedMesh mesh = clothAnimation(options);
    const double first = kGravity * options.height;
    double stretch = 0;
    for (std::size_t f = 0; f < mesh.frames.size(); ++f) {
        if (f + 1 < mesh.frames.size()) {
            EXPECT_LT(energyAt(mesh, f), first + 0.5 * sqr(options.breeze)) << f;
        }
        for (std::size_t v = 0; v < kCloth; ++v) {
            ASSERT_GT(mesh.frames[f][v].y, 0) << f;
            ASSERT_GT(glm::length(Vec3(mesh.frames[f][v]) - options.ball), options.ballRadius) << f;
            if (v % 33 != 32)
                stretch = std::max(stretch, double(glm::length(mesh.frames[f][v + 1] - mesh.frames[f][v])));
            if (v + 33 < kCloth)
                stretch = std::max(stretch, double(glm::length(mesh.frames[f][v + 33] - mesh.frames[f][v])));
        }
    }
    EXPECT_LT(stretch / (options.clothEdge / 32), kStretch);
}

TEST(Cloth, IsStableAtAnyStep) {
    for (const double rate : {0.1, 1.0, 10.0, 1e4})
        for (const double breeze : {0.0, 1.5, 1000.0}) {
            ClothOptions options;
            options.frames = 50;
            options.framesPerSecond = rate;
            options.stepsPerFrame = 1;
            options.breeze = breeze;
            const AnimatedMesh mesh = clothAnimation(options);
            for (const std::vector<glm::vec3>& frame : mesh.frames)
                for (std::size_t v = 0; v < kCloth; ++v) {
                    ASSERT_TRUE(isFinite(Vec3(frame[v]))) << rate << " " << breeze;
                    ASSERT_GE(frame[v].y, 0);
                }
            if (breeze == 0) {
                EXPECT_LT(energyAt(mesh, 48), kGravity * options.height * 1.01) << rate;
            }
        }
}

TEST(Cloth, SameBitsAndSeeds) {
    ClothOptions options;
    options.frames = 40;
    const AnimatedMesh a = clothAnimation(options), b = clothAnimation(options);
    EXPECT_EQ(a.frames, b.frames);
    options.seed = 2;
    EXPECT_NE(clothAnimation(options).frames, a.frames);
}

TEST(Cloth, RefusesWhatIsNoCloth) {
    const auto refused = [](auto change) {
        ClothOptions options;
        change(options);
        EXPECT_THROW(clothAnimation(options), std::invalid_argument);
    };
    refused([](ClothOptions& o) { o.clothVertices = 1; });
    refused([](ClothOptions& o) { o.frames = 0; });
    refused([](ClothOptions& o) { o.stepsPerFrame = 0; });
    refused([](ClothOptions& o) { o.framesPerSecond = 0; });
    refused([](ClothOptions& o) { o.breeze = std::numeric_limits<double>::quiet_NaN(); });
    refused([](ClothOptions& o) { o.height = -1; });
}

}  // namespace
}  // namespace nacre
