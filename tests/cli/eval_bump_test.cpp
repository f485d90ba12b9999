// nacre eval of what nacre bump writes: light, points seen, normals, and the truth beside them.
#include "tests/cli/bump_command.hpp"

namespace nacre {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace tests::bump;
using tests::nacre;
using tests::Outcome;
using tests::Scratch;

TEST(CommandBumpEval, TruthComesFromTheSourceOrTheAssetOrIsNan) {
    const Scratch scratch;
    const std::string source = relief(scratch, 20, 20, bumps);
    const std::string lines = "u,v,lx,ly,lz\n# one\n0.5,0.25,0.6,0,0.8\n\n0.1,0.1,1e300,0,1e298\n";
    ASSERT_EQ(nacre(bake(source, scratch / "a.exr", {"--ellipses", "--scale", "2"})).code, 0);
    EXPECT_THAT(eval(scratch / "a.exr", lines).out, HasSubstr(",nan\n"));
    const Outcome with = eval(scratch / "a.exr", lines, {"--source", source});
    ASSERT_EQ(with.code, 0) << with.err;
    ASSERT_EQ(nacre(bake(source, scratch / "b.exr", {"--ellipses", "--scale", "2", "--heights"})).code, 0);
    EXPECT_EQ(eval(scratch / "b.exr", lines).out, with.out);
    EXPECT_EQ(std::count(with.out.begin(), with.out.end(), '\n'), 2);
    relief(scratch, 20, 20, flat);
    EXPECT_THAT(eval(scratch / "a.exr", lines, {"--source", source}).err, HasSubstr("baked from other bytes"));
    relief(scratch, 5, 5, flat);
    expectFailure(eval(scratch / "a.exr", lines, {"--source", source}), 1, {"20 x 20", "5 x 5"});
}

TEST(CommandBumpEval, SeenPointsAgreeWithTheRaysAtTexelsAndStoredDirections) {
    const Scratch scratch;
    const json meta =
        baked(relief(scratch, 24, 24, bumps), scratch / "a.exr", {"--scatter", "8", "--heights", "--json"});
    std::string lines;
    for (const json& d : meta["directions"])
        for (int i = 0; i < 24; ++i)
            lines += fmt::format("{:.17g},{:.17g},{},{},{}\n", (i + 0.5) / 24, ((7 * i) % 24 + 0.5) / 24,
                                 d[0].get<double>(), d[1].get<double>(), d[2].get<double>());
    const Outcome outcome = eval(scratch / "a.exr", lines, {"--seen"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, IsEmpty());
    std::istringstream answers(outcome.out);
    int hits = 0, wrong = 0, apart = 0, count = 0;
    for (std::string line; std::getline(answers, line); ++count) {
        double v[6];
        ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf", v, v + 1, v + 2, v + 3, v + 4, v + 5), 6)
            << line;
        wrong += v[0] != v[3];
        if (v[0] != 1 || v[3] != 1) continue;
        ++hits;
        apart += 24 * std::hypot(v[1] - v[4], v[2] - v[5]) > 1;
    }
    EXPECT_EQ(count, 8 * 24);
    EXPECT_GT(hits, 10);
    EXPECT_LE(wrong, 2);
    EXPECT_LE(apart, 1);
    EXPECT_THAT(eval(scratch / "a.exr", "0.5,0.5,0.1234,0.2,1\n0.5,0.5,1,0.2,1\n", {"--seen"}).err,
                HasSubstr("nearest"));
}

TEST(CommandBumpEval, WrongQuestionsAreNamed) {
    const Scratch scratch;
    const std::string out = (scratch / "a.exr").string();
    ASSERT_EQ(nacre(bake(relief(scratch, 8, 8, bumps), out, {"--normals"})).code, 0);
    expectFailure(eval(out, "0,0,0,0,1\n"), 1, {"ellipses or horizons", "--normal"});
    expectFailure(eval(out, "0,0,0,0,1\n", {"--seen"}), 1, {"scatter map"});
    expectFailure(eval(out, "0,0\n", {"--seen", "--normal"}), 2, {"both"});
    expectFailure(eval(out, "0,0,0\n", {"--normal"}), 1, {"line 1", "u,v"});
    ASSERT_EQ(nacre(bake(relief(scratch, 8, 8, bumps), out, {"--ellipses"})).code, 0);
    expectFailure(eval(out, "0,0,0,0,0\n"), 1, {"line 1", "not 0"});
    expectFailure(eval(out, "0,nan,0,0,1\n"), 1, {"line 1", "finite"});
    expectFailure(eval(out, "0,0,1\n"), 1, {"line 1", "five numbers"});
    const std::string brdf = (scratch / "brdf.exr").string();
    ASSERT_EQ(nacre({"factorize", "lambert", "-o", brdf, "--size", "4"}).code, 0);
    expectFailure(eval(brdf, "", {"--seen"}), 2, {"--seen", "bump"});
}

}  // namespace
}  // namespace nacre
