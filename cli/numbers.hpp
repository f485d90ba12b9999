// Lines of text and the numbers in them, as `nacre eval` reads them.
#pragma once

#include <functional>
#include <span>
#include <string_view>

namespace nacre::cli {

std::string_view trimmed(std::string_view text);  ///< without blanks, tabs and \r at the ends

/// Takes as many numbers, separated by commas, as there are in `values`; false when `line` holds anything else.
bool parseNumbers(std::string_view line, std::span<double> values);

/// Calls take(line) for each line of standard input, the last one with or without its line end.
/// \throws nacre::Error when it can't be read, or a line is longer than 65536 bytes
void forEachInputLine(const std::function<void(std::string_view)>& take);

}  // namespace nacre::cli
