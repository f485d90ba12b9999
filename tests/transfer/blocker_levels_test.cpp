// Levels of detail cover what they stand for.
#include "transfer/blocker_levels.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "transfer/chess.hpp"
#include "transfer/self_transfer.hpp"

namespace nacre {
namespace {

struct Moving {
    WeldedMesh mesh;
    std::vector<glm::vec3> rest;
};

Moving chess() {
    const AnimatedMesh animation = chessAnimation(turnedChessSet(), {.frames = 1});
    Moving out{weldMesh(animation, "chess"), {}};
    out.rest = weldedPositions(out.mesh, animation.frames[0]);
    return out;
}

/// A flat board becomes few long triangles, some of which lie over a patch without a corner in it: left out there, they
/// were a hole in the board.
TEST(BlockerLevels, PatchesHaveWhatStandsForTheirVertices) {
    const Moving m = chess();
    for (const std::size_t coarse : {150, 300, 400, 500}) {
        const BlockerLevels levels = makeBlockerLevels(m.mesh, m.rest, {coarse});
        ASSERT_GT(levels.levels.size(), 1u);
        for (const BlockerLevels::Patch& patch : levels.patches)
            for (std::size_t level = 1; level < levels.levels.size(); ++level)
                for (const std::uint32_t v : patch.vertices)
                    ASSERT_EQ(std::count(patch.triangles[level].begin(), patch.triangles[level].end(),
                                         levels.levels[level].triangleOf[v]),
                              1)
                        << "coarse " << coarse << ", level " << level << ", vertex " << v;
    }
}

/// What is open at rest and dark in a pose is drawn finer once the pose is known.
TEST(BlockerLevels, PosesTellWhichVerticesAreDark) {
    const Moving m = chess();
    std::vector<glm::vec3> apart = m.rest;  // the pieces far above each other: nothing is dark
    const std::vector<std::uint32_t> part = connectedParts(m.mesh.triangles, m.rest.size());
    for (std::size_t v = 0; v < apart.size(); ++v) apart[v].y += static_cast<float>(part[v]);
    const std::vector<std::vector<glm::vec3>> poses = {m.rest};
    const SelfTransferOptions levels{.coarse = kUsualCoarse};
    const SelfTransfer unaware(m.mesh, apart, levels), aware(m.mesh, apart, levels, poses);
    EXPECT_GT(aware.compute(m.rest).listed, unaware.compute(m.rest).listed);
    EXPECT_NE(aware.key(), unaware.key()) << "other groups: sets of blockers of one mean nothing to the other";
}

}  // namespace
}  // namespace nacre
