// Levels of quality and what moves among them, without OpenGL: frames take what the test says.
#include "shading/multipass/quality.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace nacre {
namespace {

TEST(Quality, LevelsGiveUpMoreAndMoreAndNeverAdd) {
    SceneSwitches best;
    EXPECT_EQ(atQuality(best, 0).specular, best.specular);
    for (int level = 1; level < kQualityLevels; ++level) {
        const SceneSwitches a = atQuality(best, level - 1), b = atQuality(best, level);
        EXPECT_LE(b.specular.depth, a.specular.depth);
        EXPECT_LE(b.specular.shears, a.specular.shears);
        EXPECT_LE(b.lightPoints, a.lightPoints);
        EXPECT_LE(b.specular.partial, a.specular.partial);
        EXPECT_EQ(qualityFromString(qualityName(level)), level);
    }
    best.specular.depth = 1;
    best.specular.shears = 1;
    EXPECT_EQ(atQuality(best, 1).specular.depth, 1);
    EXPECT_EQ(atQuality(best, 1).specular.shears, 1);
    EXPECT_THROW(qualityFromString("best"), std::invalid_argument);
}

/// Seconds a frame at each level.
using Costs = std::array<double, kQualityLevels>;

void run(QualityControl& control, const Costs& costs, int frames, bool moves = true) {
    for (int i = 0; i < frames; ++i) {
        const int level = control.next(moves);
        control.took(costs[static_cast<std::size_t>(level)]);
    }
}

TEST(Quality, FindsTheBestLevelWithinTheTarget) {
    const Costs costs = {0.5, 0.2, 0.08, 0.03, 0.01};
    QualityControl control(0.1);
    run(control, costs, 10);
    EXPECT_EQ(control.level(), 2);
    run(control, costs, 10);
    EXPECT_EQ(control.level(), 2) << "and stays";
    QualityControl fast(1), never(1e-4);
    run(fast, costs, 10);
    run(never, costs, 10);
    EXPECT_EQ(fast.level(), 0);
    EXPECT_EQ(never.level(), kQualityLevels - 1);
}

TEST(Quality, RefinesAtRestAndGoesOnWhereItMoved) {
    const Costs costs = {0.5, 0.2, 0.08, 0.03, 0.01};
    QualityControl control(0.05);
    run(control, costs, 10);
    EXPECT_EQ(control.level(), 3);
    for (int level = 2; level >= 0; --level) {
        EXPECT_TRUE(control.refines());
        run(control, costs, 1, false);
        EXPECT_EQ(control.level(), level);
    }
    EXPECT_FALSE(control.refines());
    EXPECT_EQ(control.next(true), 3) << "no slow frame first";
}

/// Where the scene becomes cheaper it takes better levels again.
TEST(Quality, FollowsWhatFramesTake) {
    QualityControl control(0.1);
    run(control, {0.5, 0.2, 0.15, 0.12, 0.06}, 10);
    EXPECT_EQ(control.level(), 4);
    run(control, {0.05, 0.02, 0.015, 0.012, 0.006}, 10);
    EXPECT_EQ(control.level(), 0);
}

TEST(Quality, RefusesTargetsThatAreNoTime) {
    for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(QualityControl control(bad), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
