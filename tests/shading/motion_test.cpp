#include "shading/motion.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "core/file.hpp"
#include "tests/core/scratch.hpp"

namespace nacre {
namespace {

using ::testing::HasSubstr;
using tests::messageOf;

TEST(Motion, OpensWhatIsBuiltIn) {
    MotionOptions options;
    options.frames = 3;
    EXPECT_EQ(loadMotion("cloth", options).vertexCount(), 1378u);
    EXPECT_EQ(loadMotion("chess", options).frames.size(), 3u);
}

TEST(Motion, OpensFiles) {
    const tests::Scratch scratch;
    writeFile(scratch / "t.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    EXPECT_EQ(loadMotion((scratch / "t.off").string()).vertexCount(), 3u);
}

TEST(Motion, UnknownNamesListWhatIsBuiltIn) {
    EXPECT_THAT(messageOf<Error>([] { loadMotion("clotj"); }),
                HasSubstr("clotj: expected a file, or one of cloth, chess"));
    MotionOptions options;
    options.clip = "run";
    EXPECT_THROW(loadMotion("cloth", options), std::invalid_argument);
    options = {};
    options.chessPieces = "/nowhere";
    EXPECT_THAT(messageOf<Error>([&] { loadMotion("chess", options); }), HasSubstr("/nowhere/king.obj"));
}

}  // namespace
}  // namespace nacre
