// The regression corpus in every test run: each file as it is, cut, and changed a few hundred times.
#include <gtest/gtest.h>

#include "tests/fuzz/targets.hpp"

namespace nacre::tests {
namespace {

class Corpus : public ::testing::TestWithParam<FuzzTarget> {};

constexpr std::uint64_t kChanges = 100;  // a file; ./dev fuzz does more, and follows what reaches new code

TEST_P(Corpus, FilesCutsAndChangesAreReadOrRefused) {
    const auto files = corpusOf(NACRE_SOURCE_DIR "/tests/fuzz/corpus", GetParam().name);
    ASSERT_FALSE(files.empty()) << "a target without a corpus tests nothing";
    for (const auto& file : files) {
        EXPECT_NO_THROW(feed(GetParam(), file));
        for (std::size_t part = 0; part < 16; ++part)
            EXPECT_NO_THROW(feed(GetParam(), std::span(file).first(file.size() * part / 16)));
        for (std::uint64_t seed = 0; seed < kChanges; ++seed)
            EXPECT_NO_THROW(feed(GetParam(), mutated(file, files[seed % files.size()], seed))) << "seed " << seed;
    }
}

INSTANTIATE_TEST_SUITE_P(Readers, Corpus, ::testing::ValuesIn(fuzzTargets()),
                         [](const auto& target) { return target.param.name; });

TEST(Mutated, IsDeterministicAndDiffers) {
    const std::vector<std::uint8_t> bytes(100, 7), other(50, 9);
    EXPECT_EQ(mutated(bytes, other, 1), mutated(bytes, other, 1));
    int same = 0;
    for (std::uint64_t seed = 0; seed < 100; ++seed) same += mutated(bytes, other, seed) == bytes;
    EXPECT_LT(same, 5);
    EXPECT_NO_THROW(mutated({}, {}, 3));
}

}  // namespace
}  // namespace nacre::tests
