// Standard output for data, standard error for messages and progress.
#pragma once

#include <cstdio>
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

/// Empty when `quiet`. On a terminal a line that is rewritten in place, at most ten times a second, which endProgress()
/// clears; in a file or pipe a line every ten seconds, progressLines.
Progress terminalProgress(bool quiet);
/// "nacre: tracing 40 %" on `out`, at least so many seconds after the last one, and after this call.
Progress progressLines(std::FILE* out, double seconds);
void endProgress();

/// "16.0 KiB", "312 bytes"
std::string humanBytes(std::size_t bytes);

}  // namespace nacre::cli
