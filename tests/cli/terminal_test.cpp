#include "cli/terminal.hpp"

#include <gtest/gtest.h>

#include "tests/cli/process.hpp"

namespace nacre::cli {
namespace {

std::string linesOf(double seconds) {
    const tests::Scratch scratch;
    std::FILE* file = std::fopen((scratch / "lines").c_str(), "w");
    const Progress progress = progressLines(file, seconds);
    progress("tracing", 0.25);
    progress("tracing", 0.5);
    std::fclose(file);
    return tests::contents(scratch / "lines");
}

TEST(Terminal, ProgressInAFileIsALineNowAndThen) {
    EXPECT_EQ(linesOf(0), "nacre: tracing 25 %\nnacre: tracing 50 %\n");
    EXPECT_EQ(linesOf(3600), "");
}

TEST(Terminal, QuietHasNoProgress) {
    EXPECT_FALSE(terminalProgress(true));
    EXPECT_TRUE(terminalProgress(false));
}

}  // namespace
}  // namespace nacre::cli
