// Pieces of HTML that every section of the page is made of.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

namespace nacre::bench {

inline std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
    return out;
}

/// Cells are HTML already.
inline std::string row(const std::vector<std::string>& cells, const char* tag = "td") {
    std::string out = "<tr>";
    for (const std::string& cell : cells) out += fmt::format("<{0}>{1}</{0}>", tag, cell);
    return out + "</tr>\n";
}

inline std::string table(const std::vector<std::string>& head, const std::string& rows) {
    return "<div class=\"wide\"><table>\n<thead>" + row(head, "th") + "</thead><tbody>\n" + rows +
           "</tbody></table></div>\n";
}

inline std::string percent(double share) { return fmt::format("{:.3g} %", 100 * share); }

}  // namespace nacre::bench
