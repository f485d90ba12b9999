// What the parts of a frame take.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "shading/gl_objects.hpp"

namespace nacre {

/// What a part of a frame took: `relief light`, `shadow maps` or `shadow volumes` (made), `surfaces`, `light` (with
/// volumes counted), `volumes`, `sky`.
struct PassTime {
    std::string name;
    double wallSeconds = 0;  ///< between two glFinish
    double gpuSeconds = 0;   ///< GL_TIME_ELAPSED; NaN where the context has none (OpenGL ES)
};

/// Times the parts of a frame, when asked to. Parts don't contain each other.
class PassClock {
public:
    void start(bool on);
    /// Runs `work`; parts of one name add up.
    void operator()(const char* name, const std::function<void()>& work);
    std::vector<PassTime> times;

private:
    bool on_ = false;
    std::size_t next_ = 0;
    std::vector<Query> queries_;  ///< kept from frame to frame
};

}  // namespace nacre
