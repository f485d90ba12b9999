#include "core/math.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/error.hpp"

namespace nacre {
namespace {

TEST(Math, Scalars) {
    EXPECT_EQ(sqr(-3), 9);
    EXPECT_EQ(clamp01(-1), 0);
    EXPECT_EQ(clamp01(2), 1);
    EXPECT_EQ(clamp01(0.25), 0.25);
}

TEST(Math, Colours) {
    EXPECT_NEAR(luminance(Rgb(1)), 1, 1e-15) << "Rec. 709 weights sum to one";
    EXPECT_EQ(maxComponent({1, 5, 3}), 5);
    EXPECT_EQ(mean({1, 5, 3}), 3);
}

TEST(Math, IsFiniteSeesEveryComponent) {
    const double bad = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(isFinite({1, 2, 3}));
    EXPECT_FALSE(isFinite({bad, 2, 3}));
    EXPECT_FALSE(isFinite({1, inf, 3}));
    EXPECT_FALSE(isFinite({1, 2, -inf}));
}

TEST(Require, ThrowsInvalidArgumentWithTheMessage) {
    EXPECT_NO_THROW(require(true, "fine"));
    EXPECT_THROW(require(false, "not fine"), std::invalid_argument);
    EXPECT_THROW(require(false, std::string("not fine")), std::invalid_argument);
}

}  // namespace
}  // namespace nacre
