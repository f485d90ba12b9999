// Inside: the time that the methods' splits are made of.
#pragma once

#include <ctime>

namespace nacre {

/// Of this thread [s]: what waits for a processor isn't work. Costs about a microsecond.
inline double threadSeconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace nacre
