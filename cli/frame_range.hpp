// Frames as command lines name them.
#pragma once

#include <string>

namespace nacre::cli {

struct FrameRange {
    int first = 0;
    int end = 0;  ///< one past the last; 0: to the last there is
};

/// "A:B", "A:", ":B", frames A to B − 1. \throws UsageError
FrameRange parseFrames(const std::string& text);

/// `pattern` with its # … # replaced by the number, with as many digits at least. Without any # as it is.
std::string numberedName(const std::string& pattern, int number);

}  // namespace nacre::cli
