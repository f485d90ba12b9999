#include "cli/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace nacre::cli {

std::string_view trimmed(std::string_view text) {
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

bool parseNumbers(std::string_view line, std::span<double> values) {
    if (static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')) + 1 != values.size()) return false;
    for (double& value : values)
        if (!takeNumber(line, value)) return false;
    return true;
}

void forEachInputLine(const std::function<void(std::string_view)>& take) {
    static constexpr std::size_t kBlock = 1 << 16;  // bytes read at once
    static constexpr std::size_t kMaxLine = 1 << 16;
    std::string pending;
    std::vector<char> block(kBlock);
    while (const std::size_t count = std::fread(block.data(), 1, block.size(), stdin)) {
        pending.append(block.data(), count);
        std::size_t begin = 0;
        for (std::size_t end; (end = pending.find('\n', begin)) != std::string::npos; begin = end + 1)
            take(std::string_view(pending).substr(begin, end - begin));
        pending.erase(0, begin);
        if (pending.size() > kMaxLine)
            throw Error(
                fmt::format("standard input: expected lines of at most {} bytes, found a longer one", kMaxLine));
    }
    if (std::ferror(stdin)) throw Error(fmt::format("standard input: can't read: {}", std::strerror(errno)));
    if (!pending.empty()) take(pending);
}

}  // namespace nacre::cli
