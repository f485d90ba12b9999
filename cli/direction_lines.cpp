#include "cli/direction_lines.hpp"

#include <fmt/format.h>

#include <array>

#include "cli/numbers.hpp"
#include "core/error.hpp"

namespace nacre::cli {

void DirectionReader::take(std::string_view line, std::vector<DirectionPair>& pairs) {
    ++lineNumber_;
    line = trimmed(line);
    if (line.empty() || line.front() == '#') return;
    const bool first = !sawContent_;
    sawContent_ = true;
    std::array<double, 6> v{};
    const auto fail = [&](const std::string& expected, std::string_view found) {
        throw Error(fmt::format("standard input: line {}: expected {}, found '{}'", lineNumber_, expected,
                                found.size() > 80 ? found.substr(0, 80) : found));
    };
    if (!parseNumbers(line, v)) {
        if (first && line.substr(0, 3) == "wix") return;  // a header; a typo in a number is none
        fail("six numbers wix,wiy,wiz,wox,woy,woz", line);
    }
    const DirectionPair pair{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
    for (const auto& [name, direction] : {std::pair{"wi", pair.wi}, std::pair{"wo", pair.wo}})
        if (!(std::abs(glm::length(direction) - 1) <= kUnitTolerance))
            fail(fmt::format("{} of length 1 within {}", name, kUnitTolerance), line);
    pairs.push_back(pair);
}

}  // namespace nacre::cli
