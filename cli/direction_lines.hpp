// The text that `nacre eval` reads: lines wix,wiy,wiz,wox,woy,woz.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "core/directions.hpp"

namespace nacre::cli {

/// Reads pairs line by line. Blank lines and lines that start with # are skipped, and so is the first other line when
/// it starts with a letter and is no number (a header). Directions must have length 1 within kUnitTolerance; they are
/// not normalised.
class DirectionReader {
public:
    static constexpr double kUnitTolerance = 1e-3;

    /// Appends the pair of `line` (without its line end) to `pairs`, or skips it.
    /// \throws nacre::Error "standard input: line N: expected …, found …"
    void take(std::string_view line, std::vector<DirectionPair>& pairs);

private:
    std::size_t lineNumber_ = 0;
    bool sawContent_ = false;
};

}  // namespace nacre::cli
