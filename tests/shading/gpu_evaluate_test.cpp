#include "gpu_evaluate.hpp"

#include <gtest/gtest.h>

namespace nacre {
namespace {

// Directions go in and come out bit for bit, more than a row of them, in order, in each dialect.
TEST(GpuEvaluate, PassesDirectionsThrough) {
    const std::vector<DirectionPair> pairs = test::testPairs(1000);
    for (const auto& [api, dialect] :
         {std::pair{GlApi::Core33, Glsl::V330}, {GlApi::Core45, Glsl::V450}, {GlApi::Es3, Glsl::Es300}}) {
        test::context(api);
        const auto values = test::gpuEvaluate(
            {.code = "vec4 evaluate(vec3 wi, vec3 wo) { return vec4(wi, wo.x); }\n", .dialect = dialect}, pairs);
        ASSERT_EQ(values.size(), pairs.size());
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            ASSERT_EQ(values[i], glm::vec4(glm::vec3(pairs[i].wi), static_cast<float>(pairs[i].wo.x))) << i;
        }
    }
}

TEST(GpuEvaluate, TestPairsCoverTheHorizon) {
    double lowest = 1;
    for (const DirectionPair& pair : test::testPairs(10)) {
        lowest = std::min({lowest, pair.wi.z, pair.wo.z});
        EXPECT_GT(std::min(pair.wi.z, pair.wo.z), 0);
        EXPECT_NEAR(glm::length(pair.wi), 1, 1e-12);
    }
    EXPECT_NEAR(lowest, std::cos(89.9 * kPi / 180), 1e-12);
}

}  // namespace
}  // namespace nacre
