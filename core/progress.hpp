// Progress of long work. Bakers call it; the command line decides whether anyone sees it.
#pragma once

#include <functional>
#include <string>

namespace nacre {

/// Called with what is being done and the share done, 0 to 1. Empty = nobody listens.
using Progress = std::function<void(const std::string& what, double share)>;

inline void report(const Progress& progress, const std::string& what, double share) {
    if (progress) progress(what, share);
}

}  // namespace nacre
