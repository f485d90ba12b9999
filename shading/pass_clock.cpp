#include "shading/pass_clock.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace nacre {

void PassClock::start(bool on) {
    on_ = on;
    times.clear();
    next_ = 0;
}

void PassClock::operator()(const char* name, const std::function<void()>& work) {
    if (!on_) return work();
    const bool queries = epoxy_is_desktop_gl();
    if (queries && next_ == queries_.size()) queries_.emplace_back();
    glFinish();
    const auto begin = std::chrono::steady_clock::now();
    if (queries) glBeginQuery(GL_TIME_ELAPSED, queries_[next_].name());
    work();
    if (queries) glEndQuery(GL_TIME_ELAPSED);
    glFinish();
    PassTime time{name, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), NAN};
    if (queries) {
        GLuint64 nanoseconds = 0;
        glGetQueryObjectui64v(queries_[next_++].name(), GL_QUERY_RESULT, &nanoseconds);
        time.gpuSeconds = static_cast<double>(nanoseconds) * 1e-9;
    }
    const auto before = std::find_if(times.begin(), times.end(), [&](const PassTime& t) { return t.name == name; });
    if (before == times.end()) {
        times.push_back(std::move(time));
    } else {  // another view's
        before->wallSeconds += time.wallSeconds;
        before->gpuSeconds += time.gpuSeconds;
    }
}

}  // namespace nacre
