#include "transfer/vertex_detail.hpp"

#include <gtest/gtest.h>

namespace nacre {
namespace {

using enum VertexDetail;

std::vector<VertexDetail> within(double error, const std::vector<std::vector<float>>& poses) {
    MeasuredDetail measured(poses[0].size() / 4);
    for (const std::vector<float>& pose : poses) {  // two coefficients of each vertex by angle, then the coarsest's
        const std::span<const float> all = pose;
        measured.add(all.first(all.size() / 2), all.last(all.size() / 2), 1.0);
    }
    return measured.within(error);
}

TEST(VertexDetail, TheCoarsestDoesWhereItIsOffByLittle) {
    const std::vector<std::vector<float>> poses = {{0.8f, 0, 0.8f, 0, 0.83f, 0, 0.8f, 0.1f}};
    EXPECT_EQ(within(0.05, poses), (std::vector{Coarsest, ByAngle}));
    EXPECT_EQ(within(0.2, poses), (std::vector{Coarsest, Coarsest}));
    EXPECT_EQ(within(0, poses), (std::vector{ByAngle, ByAngle}));
}

TEST(VertexDetail, ExactlyAlikeIsNotEnoughWhenNothingIsLetTo) {
    EXPECT_EQ(within(0, {{0.8f, 0, 0.8f, 0}}), (std::vector{ByAngle}));
}

TEST(VertexDetail, TheWorstPoseDecides) {  // off by 0.06 in the light, where that is 6 %; in another it would be 12 %
    EXPECT_EQ(within(0.1, {{1.0f, 0, 1.06f, 0}, {0.5f, 0, 0.5f, 0}}), (std::vector{ByAngle}));
    EXPECT_EQ(within(0.1, {{1.0f, 0, 1.06f, 0}, {0.9f, 0, 0.9f, 0}}), (std::vector{Coarsest}));
}

TEST(VertexDetail, DarkInOnePoseIsFine) {
    EXPECT_EQ(within(0.1, {{0.9f, 0, 0.9f, 0}, {0.05f, 0, 0.05f, 0}}), (std::vector{Fine}));
    EXPECT_EQ(within(0, {{0.9f, 0, 0.9f, 0}, {0.05f, 0, 0.05f, 0}}), (std::vector{Fine}));
}

}  // namespace
}  // namespace nacre
