#include "core/animation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/error.hpp"

namespace nacre {
namespace {

AnimatedMesh twoFrames() {
    AnimatedMesh a;
    a.triangles = {{0, 1, 2}};
    a.frames = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}};
    return a;
}

template <class Change>
void expectError(Change change, const char* part) {
    AnimatedMesh a = twoFrames();
    change(a);
    try {
        checkAnimation(a, "x.md2");
        FAIL() << "accepted: " << part;
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr(part));
        EXPECT_THAT(error.what(), testing::StartsWith("x.md2: "));
    }
}

TEST(Animation, AcceptsOneTopology) { EXPECT_NO_THROW(checkAnimation(twoFrames(), "x.md2")); }

TEST(Animation, RefusesWhatIsNoAnimation) {
    expectError([](AnimatedMesh& a) { a.frames.clear(); }, "at least one frame");
    expectError([](AnimatedMesh& a) { a.frames[1].pop_back(); },
                "topology changes: expected 3 vertices as in frame 0, found 2 in frame 1");
    expectError([](AnimatedMesh& a) { a.triangles[0].y = 3; }, "found 3 in triangle 0");
    expectError([](AnimatedMesh& a) { a.uvs.resize(2); }, "expected 3 uv coordinates, found 2");
}

TEST(Animation, ResamplingIsLinearBetweenFrames) {
    AnimatedMesh a = twoFrames();
    a.framesPerSecond = 10;
    const AnimatedMesh b = resampled(a, 40, "x");
    ASSERT_EQ(b.frames.size(), 5u);
    for (std::size_t f = 0; f < 5; ++f) EXPECT_FLOAT_EQ(b.frames[f][1].z, 0.25f * static_cast<float>(f));
    EXPECT_EQ(resampled(a, 10, "x").frames, a.frames);
    EXPECT_EQ(resampled(a, 5, "x").frames.size(), 1u);  // the next would be after the end
    EXPECT_THROW(resampled(a, 0, "x"), std::invalid_argument);
    EXPECT_THROW(resampled(a, 1e9, "x"), Error);
}

TEST(Animation, ABrokenFrameStaysAloneWhenResampled) {
    AnimatedMesh a = twoFrames();
    a.frames[1][0].x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(resampled(a, 60, "x").frames[0], a.frames[0]);
}

TEST(Animation, RigidBodiesKeepTheirOrderAndShape) {
    MovingBody body{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 1, 2}}, {glm::dmat4(1), glm::dmat4(1)}};
    body.frames[1][3] = {5, 0, 0, 1};
    MovingBody still = body;
    still.frames[1] = glm::dmat4(1);
    still.uvs.assign(3, glm::vec2(1));
    const AnimatedMesh a = rigidAnimation({body, still}, 25, "x");
    EXPECT_EQ(a.framesPerSecond, 25);
    EXPECT_EQ(a.triangles[1], glm::uvec3(3, 4, 5));
    EXPECT_EQ(a.frames[1][1], glm::vec3(6, 0, 0));
    EXPECT_EQ(a.frames[1][4], glm::vec3(1, 0, 0));
    EXPECT_EQ(a.uvs[0], glm::vec2(0));
    EXPECT_EQ(a.uvs[3], glm::vec2(1));
    still.frames.pop_back();
    EXPECT_THROW(rigidAnimation({body, still}, 25, "x"), std::invalid_argument);
    body.frames[0][0][0] = -1;  // a mirror
    EXPECT_THROW(rigidAnimation({body}, 25, "x"), std::invalid_argument);
    EXPECT_THROW(rigidAnimation({}, 25, "x"), Error);
}

}  // namespace
}  // namespace nacre
