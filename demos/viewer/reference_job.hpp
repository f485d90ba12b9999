// The reference of one view, traced beside the viewer: pass after pass on a thread, each making the picture better.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/image.hpp"
#include "core/scene_description.hpp"
#include "shading/scene_programs.hpp"

namespace nacre {

/// What is traced.
struct ReferenceView {
    SceneDescription scene;
    Camera camera;
    double time = 0;
    SceneSwitches switches;
    int width = 0, height = 0;
};

/// One pass: a picture with its own random numbers, whose mean over passes is the reference.
/// \param pass  0, 1, … seeds it. \param stopped  to be asked often; true: return soon, with anything
using ReferenceTracer = std::function<Image(const ReferenceView& view, int pass, const std::function<bool()>& stopped)>;

class ReferenceJob {
public:
    /// \param woken  called on the job's thread whenever there is news
    ReferenceJob(ReferenceTracer tracer, ReferenceView view, int passes, std::function<void()> woken);
    /// Stops the thread: waits until the tracer has seen it.
    ~ReferenceJob();
    ReferenceJob(const ReferenceJob&) = delete;
    ReferenceJob& operator=(const ReferenceJob&) = delete;

    struct State {
        int passes = 0;       ///< done
        bool done = false;    ///< all of them, or failed
        std::string problem;  ///< why it failed
    };
    State state() const;
    /// The mean of the passes so far; empty before the first.
    Image mean() const;
    int passes() const;  ///< asked for

private:
    struct Shared;
    std::unique_ptr<Shared> shared_;
};

}  // namespace nacre
