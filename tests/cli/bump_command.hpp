// Reliefs, and the command that bakes and asks them.
#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "tests/cli/process.hpp"
#include "tests/core/exr_files.hpp"

namespace nacre::tests::bump {

using Field = std::function<double(int, int)>;

inline std::string relief(const Scratch& scratch, int width, int height, const Field& z) {
    Image image(width, height, 1);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image.at(x, y, 0) = static_cast<float>(z(x, y));
    const std::string path = (scratch / "heights.exr").string();
    writeExr(image, path);
    return path;
}

inline double bumps(int x, int y) { return 3 * std::sin(0.7 * x) * std::cos(0.5 * y) + 0.1 * ((x * 7 + y * 13) % 5); }
inline double flat(int, int) { return 4; }
inline double spike(int x, int y) { return x == 8 && y == 8 ? 10 : 0; }
inline double step(int x, int) { return x < 8 ? 5 : 0; }

inline std::vector<std::string> bake(const std::string& source, const std::filesystem::path& output,
                                     std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"bump", source, "-o", output.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

inline const std::vector<std::string> kEverything = {"--normals", "--roughness", "--ellipses", "--directions",
                                                     "32",        "--horizon",   "6",          "--scatter",
                                                     "5",         "--heights",   "--json"};

inline void expectFailure(const Outcome& outcome, int code, const std::vector<std::string>& fragments) {
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    for (const std::string& fragment : fragments) EXPECT_THAT(outcome.err, ::testing::HasSubstr(fragment));
    EXPECT_THAT(outcome.out, ::testing::IsEmpty());
}

inline nlohmann::json baked(const std::string& source, const std::filesystem::path& output,
                            std::vector<std::string> more = {}) {
    const Outcome outcome = nacre(bake(source, output, std::move(more)));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome.code == 0 ? nlohmann::json::parse(outcome.out) : nlohmann::json();
}

inline Outcome eval(const std::filesystem::path& file, const std::string& lines, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"eval", file.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return nacre(arguments, {lines, {}, RLIM_INFINITY, false});
}

}  // namespace nacre::tests::bump
