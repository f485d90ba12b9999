#include "cli/frame_range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "cli/verb.hpp"

namespace nacre::cli {

FrameRange parseFrames(const std::string& text) {
    const std::size_t colon = text.find(':');
    const auto wrong = [&] {
        return UsageError(fmt::format("expected A:B, frames A to B - 1 with 0 <= A < B, found '{}'", text));
    };
    if (colon == std::string::npos) throw wrong();
    const auto number = [&](std::string_view part) {
        int value = 0;
        if (part.empty()) return value;
        const auto [end, failure] = std::from_chars(part.data(), part.data() + part.size(), value);
        if (failure != std::errc{} || end != part.data() + part.size() || value < 0) throw wrong();
        return value;
    };
    const FrameRange out{number(std::string_view(text).substr(0, colon)),
                         number(std::string_view(text).substr(colon + 1))};
    const bool open = colon + 1 == text.size();
    if (!open && out.end <= out.first) throw wrong();
    return out;
}

std::string numberedName(const std::string& pattern, int number) {
    const std::size_t begin = pattern.find('#');
    if (begin == std::string::npos) return pattern;
    const std::size_t end = std::min(pattern.find_first_not_of('#', begin), pattern.size());
    return pattern.substr(0, begin) + fmt::format("{:0{}}", number, end - begin) + pattern.substr(end);
}

}  // namespace nacre::cli
