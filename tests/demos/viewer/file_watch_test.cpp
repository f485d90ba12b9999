#include "demos/viewer/file_watch.hpp"

#include <gmock/gmock.h>

#include "core/file.hpp"
#include "tests/core/scratch.hpp"

namespace nacre {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(FileWatch, TellsEachChangeOnce) {
    const tests::Scratch scratch;
    const auto a = scratch / "a", b = scratch / "b", absent = scratch / "c";
    writeFile(a, "1");
    writeFile(b, "1");
    FileWatch watch;
    watch.watch({a, b, absent});
    EXPECT_THAT(watch.changed(), IsEmpty());
    writeFile(b, "22");
    EXPECT_THAT(watch.changed(), ElementsAre(b));
    EXPECT_THAT(watch.changed(), IsEmpty());
    writeFile(absent, "came");
    std::filesystem::remove(a);
    EXPECT_THAT(watch.changed(), ElementsAre(a, absent));
    EXPECT_THAT(watch.changed(), IsEmpty());
}

TEST(FileWatch, WatchingAgainKeepsWhatWasNotTold) {
    const tests::Scratch scratch;
    writeFile(scratch / "a", "1");
    FileWatch watch;
    watch.watch({scratch / "a"});
    writeFile(scratch / "a", "22");
    watch.watch({scratch / "a", scratch / "b"});
    EXPECT_THAT(watch.changed(), ElementsAre(scratch / "a"));
}

TEST(FileWatch, FindsWhatAJsonFileNames) {
    const tests::Scratch scratch;
    writeFile(scratch / "mesh.obj", "v 0 0 0");
    writeFile(scratch / "inner.json", R"({"x": ["mesh.obj", "scene.json", 3]})");
    writeFile(scratch / "scene.json", R"({"a": {"import": "inner.json"}, "b": "absent.obj", "c": null})");
    EXPECT_THAT(filesNamedIn(scratch / "scene.json"),
                ElementsAre(scratch / "inner.json", scratch / "mesh.obj", scratch / "scene.json"));
    writeFile(scratch / "scene.json", "{ broken");
    EXPECT_THAT(filesNamedIn(scratch / "scene.json"), ElementsAre(scratch / "scene.json"));
    EXPECT_THAT(filesUnder(scratch / "absent"), IsEmpty());
    EXPECT_EQ(filesUnder(scratch.folder()).size(), 3u);
}

}  // namespace
}  // namespace nacre
