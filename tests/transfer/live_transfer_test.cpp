#include "transfer/live_transfer.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "core/error.hpp"
#include "tests/core/scratch.hpp"
#include "transfer/cloth.hpp"
#include "transfer/front_facing.hpp"

namespace nacre {
namespace {

using ::testing::HasSubstr;

/// Three frames of the draped cloth: it moves, stands, and is nowhere in the fourth.
AnimatedMesh stopping() {
    AnimatedMesh out = clothAnimation({.clothVertices = 17, .floorVertices = 9, .frames = 53});
    out.frames.erase(out.frames.begin(), out.frames.end() - 3);
    out.frames.push_back(out.frames[2]);
    out.frames.push_back(out.frames[2]);
    out.frames[4][7].y = std::numeric_limits<float>::quiet_NaN();
    return out;
}

/// Which level of detail stands for a blocker depends on the vertices that are computed together.
constexpr double kGroups = 0.1;

double relative(const std::vector<float>& found, const std::vector<float>& truth) {
    EXPECT_EQ(found.size(), truth.size());
    double off = 0, all = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        off += sqr(found[i] - truth[i]);
        all += sqr(truth[i]);
    }
    return std::sqrt(off / all);
}

TEST(LiveTransfer, IsSelfTransferOfWhatFacesTheEye) {
    LiveTransfer live(stopping(), "cloth");
    const Vec3 eye(0, 4, 4);
    live.show(1, eye);
    const auto wanted = frontFacing(live.transfer().mesh(), live.frames()[1], eye);
    EXPECT_EQ(live.coefficients(), live.transfer().compute(live.frames()[1], wanted).coefficients);
    EXPECT_EQ(live.positions(), live.frames()[1]);
    EXPECT_EQ(live.computed(), static_cast<std::size_t>(std::count(wanted.begin(), wanted.end(), 1)));
    EXPECT_LT(live.computed(), live.positions().size());
    live.show(1, std::nullopt);
    EXPECT_LT(relative(live.coefficients(), live.transfer().compute(live.frames()[1]).coefficients), kGroups);
}

TEST(LiveTransfer, StandingFramesComputeOnlyWhatComesIntoView) {
    LiveTransfer live(stopping(), "cloth");
    const Vec3 eye(0, 0.5, 9), other(0, 0.5, -9);
    live.show(2, eye);
    const std::size_t first = live.computed();
    EXPECT_GT(first, 0u);
    live.show(3, eye);
    EXPECT_EQ(live.computed(), 0u);
    live.show(3, other);
    EXPECT_GT(live.computed(), 0u);
    const auto a = frontFacing(live.transfer().mesh(), live.positions(), eye),
               b = frontFacing(live.transfer().mesh(), live.positions(), other);
    std::vector<std::uint8_t> either(a.size());
    for (std::size_t v = 0; v < a.size(); ++v) either[v] = a[v] || b[v];
    EXPECT_EQ(live.computed() + first, static_cast<std::size_t>(std::count(either.begin(), either.end(), 1)));
    EXPECT_LT(relative(live.coefficients(), live.transfer().compute(live.positions(), either).coefficients), kGroups);
    live.show(3, eye);
    EXPECT_EQ(live.computed(), 0u);
    live.show(1, eye);
    EXPECT_GT(live.computed(), 0u) << "it moved";
}

TEST(LiveTransfer, AFrameWithNanIsRefusedByItsNumberAndTheLastOneStays) {
    LiveTransfer live(stopping(), "cloth");
    live.show(3, std::nullopt);
    const std::vector<float> before = live.coefficients();
    EXPECT_THAT(tests::messageOf<Error>([&] { live.show(4, std::nullopt); }), HasSubstr("in frame 4"));
    EXPECT_EQ(live.coefficients(), before);
    EXPECT_THROW(live.show(5, std::nullopt), std::invalid_argument);
    AnimatedMesh nowhere = stopping();
    nowhere.frames = {nowhere.frames[4]};
    EXPECT_THROW(LiveTransfer(nowhere, "nowhere"), Error);
}

}  // namespace
}  // namespace nacre
