#include "cli/direction_lines.hpp"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <charconv>

#include "core/error.hpp"

namespace nacre::cli {

static std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r')) text.remove_suffix(1);
    return text;
}

/// Takes the number up to the next comma off `rest`; false when it is none.
static bool takeNumber(std::string_view& rest, double& value) {
    const std::size_t comma = rest.find(',');
    const std::string_view field = trimmed(rest.substr(0, comma));
    rest = comma == std::string_view::npos ? std::string_view{} : rest.substr(comma + 1);
    const auto [end, failure] = std::from_chars(field.data(), field.data() + field.size(), value);
    return failure == std::errc{} && end == field.data() + field.size();
}

static bool parse(std::string_view line, std::array<double, 6>& values) {
    if (std::count(line.begin(), line.end(), ',') != 5) return false;
    for (double& value : values)
        if (!takeNumber(line, value)) return false;
    return true;
}

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
    if (!parse(line, v)) {
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
