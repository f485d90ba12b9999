// Standard output for data, standard error for messages, progress only where somebody watches.
#pragma once

#include <string>
#include <string_view>

#include "core/progress.hpp"

namespace nacre::cli {

/// \throws nacre::Error when standard output can't take it (a full disk)
void putData(std::string_view text);
/// Writes out what is buffered. \throws nacre::Error as putData
void flushData();

/// One line "nacre: …" on standard error.
void tell(std::string_view message);

/// A line that is rewritten in place, at most ten times a second; empty when `quiet` or when standard error is no
/// terminal. endProgress() clears the line.
Progress terminalProgress(bool quiet);
void endProgress();

/// "16.0 KiB", "312 bytes"
std::string humanBytes(std::size_t bytes);

}  // namespace nacre::cli
