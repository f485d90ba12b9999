#include "transfer/chess.hpp"

#include <gtest/gtest.h>

#include "transfer/surface.hpp"

namespace nacre {
namespace {

double volumeOf(const Mesh& mesh) {
    double sum = 0;
    for (const glm::uvec3& t : mesh.triangles)
        sum +=
            glm::dot(Vec3(mesh.positions[t.x]), glm::cross(Vec3(mesh.positions[t.y]), Vec3(mesh.positions[t.z]))) / 6;
    return sum;
}

TEST(Chess, TurnedPiecesAreClosedAndFaceOutwards) {
    for (const Mesh& mesh : turnedChessSet()) {
        AnimatedMesh still{mesh.triangles, {}, {mesh.positions}};
        EXPECT_TRUE(weldMesh(still, "piece").closed);
        EXPECT_GT(volumeOf(mesh), 0);
    }
    EXPECT_THROW(turnedChessSet(2), std::invalid_argument);
}

TEST(Chess, PiecesAreRigidAndEndWhereTheGameEnds) {
    const AnimatedMesh mesh = chessAnimation(turnedChessSet());
    EXPECT_EQ(mesh.frames.size(), 316u);
    for (const std::vector<glm::vec3>& frame : mesh.frames)
        for (const glm::uvec3& t : mesh.triangles)
            ASSERT_NEAR(glm::length(frame[t.x] - frame[t.y]), glm::length(mesh.frames[0][t.x] - mesh.frames[0][t.y]),
                        1e-5);
    const auto bodyAt = [&](const std::vector<glm::vec3>& frame, double x, double z) {  // highest point over a square
        float top = 0;
        for (const glm::vec3& p : frame)
            if (std::abs(p.x - x) < 0.45 && std::abs(p.z - z) < 0.45) top = std::max(top, p.y);
        return top;
    };
    const auto &first = mesh.frames.front(), &last = mesh.frames.back();
    EXPECT_GT(bodyAt(first, -1.5, 0.5), 1);  // the queen on c4 …
    EXPECT_EQ(bodyAt(last, -1.5, 0.5), 0);
    EXPECT_EQ(bodyAt(first, 1.5, -2.5), 0);  // … and the knight's mate on f7
    EXPECT_GT(bodyAt(last, 1.5, -2.5), 1);
    EXPECT_GT(bodyAt(last, 3.5, -3.5), 1);  // the king it mates, on h8
}

TEST(Chess, FinePiecesAreSimplified) {
    ChessOptions options;
    options.frames = 1;
    const AnimatedMesh mesh = chessAnimation(turnedChessSet(96), options);
    EXPECT_LE(mesh.triangles.size(), 2 * 16 * 16 + 11 * options.triangles);
    EXPECT_GT(mesh.triangles.size(), 2 * 16 * 16 + 11 * options.triangles / 2);
}

TEST(Chess, RefusesWhatIsNoGame) {
    ChessSet set = turnedChessSet();
    EXPECT_THROW(chessAnimation(set, {0, 0, 17, 260}), std::invalid_argument);
    EXPECT_THROW(chessAnimation(set, {30, -1, 17, 260}), std::invalid_argument);
    EXPECT_THROW(chessAnimation(set, {30, 0, 1, 260}), std::invalid_argument);
    set[0] = {};
    EXPECT_THROW(chessAnimation(set), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
