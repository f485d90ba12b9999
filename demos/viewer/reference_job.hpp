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
    int rays = 1;       ///< n × n a pixel, on a regular grid
    int materials = 0;  ///< version of what the scene's materials and assets are: same number, same truths
};

/// One pass: a picture with its own random numbers, whose mean over passes is the reference.
/// \param pass  0, 1, … seeds it. \param stopped  to be asked often; true: return soon, with anything
using ReferenceTracer = std::function<Image(const ReferenceView& view, int pass, const std::function<bool()>& stopped)>;

/// Traces with reference/scene_trace.hpp. What the assets approximate is opened once for each version of the materials.
/// A stopped pass ends by an exception within a few rows. One job at a time.
/// \param threads  0 = all cores
ReferenceTracer sceneTracer(unsigned threads);

class ReferenceJob {
public:
    /// \param woken  called on the job's thread whenever there is news
    ReferenceJob(ReferenceTracer tracer, ReferenceView view, int passes, std::function<void()> woken);
    /// stop(), and waits until the tracer has seen it.
    ~ReferenceJob();
    ReferenceJob(const ReferenceJob&) = delete;
    ReferenceJob& operator=(const ReferenceJob&) = delete;

    /// Asks the tracer to end; state().done says when it has.
    void stop();

    struct State {
        int passes = 0;       ///< done
        bool done = false;    ///< all of them, failed, or stopped
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
