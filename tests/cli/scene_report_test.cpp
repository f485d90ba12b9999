// nacre info of a scene, from outside.
#include <gmock/gmock.h>

#include "core/file.hpp"
#include "tests/cli/process.hpp"

namespace nacre {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using tests::nacre;
using tests::Outcome;
using tests::Scratch;

TEST(CommandInfo, TellsOfFacesThatScatterAndOfAreas) {
    const Scratch scratch;
    writeFile(scratch / "s.json", R"({
        "nacre_scene": 1,
        "meshes": {"square": {"quad": {"size": 2}}},
        "materials": {"frosted": {"specular": {"ior": 1.5, "spread": 0.05, "surface": 0.25, "filter": {"colors": {"r": [1, 0, 0]}, "rows": ["rr", "rr"]}}},
                      "rough": {"specular": {"roughness": 0.1}, "ambient": [0, 0.5, 0]}},
        "nodes": {"a": {"mesh": "square", "material": "frosted"}, "b": {"mesh": "square", "material": "rough"}},
        "lights": {"lamp": {"type": "point", "shadow": true, "area": {"u": [0.3, 0, 0], "v": [0, 0, 0.2]}}}
    })");
    const Outcome run = nacre({"info", scratch / "s.json"});
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(run.out, AllOf(HasSubstr("specular index 1.5 (filter 2 x 2, surface 0.25, spread 0.05)"),
                               HasSubstr("ambient 0/0.5/0, specular mirror (roughness 0.1)"),
                               HasSubstr("point, area 0.6 x 0.4, shadow")));
}

}  // namespace
}  // namespace nacre
