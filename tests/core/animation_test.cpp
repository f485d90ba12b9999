#include "core/animation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace nacre
