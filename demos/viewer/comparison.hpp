// The picture against its reference: traced again once the view stands still, compared whenever either is new.
#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "demos/viewer/reference_job.hpp"
#include "demos/viewer/session.hpp"
#include "reference/image_compare.hpp"

namespace nacre {

/// What the window shows.
enum class Shown { Picture, Reference, Difference };

class Comparison {
public:
    /// \param woken  called on another thread when poll() has something to do
    /// \param scale  the reference has 1/scale of the picture's edges
    Comparison(ReferenceTracer tracer, std::function<void()> woken, int passes, int scale);

    Shown shown = Shown::Picture;
    double differenceScale = 0.1;  ///< difference of sRGB values that is drawn white

    /// To be called once a turn. Starts, stops and takes over what the reference job made. \return whether image() is
    /// another one
    bool poll(ViewerSession& session, double white);
    /// What to show instead of the picture; none: the picture (nothing is asked for, or nothing is there yet).
    const std::optional<Image>& image() const { return image_; }
    /// Whether poll() waits for the view to stand still.
    bool waits() const { return waitsSince_.has_value(); }

    const std::optional<ImageDifference>& difference() const { return difference_; }
    int passes() const { return taken_; }
    int passesAsked() const { return passes_; }
    bool done() const { return done_; }
    const std::string& problem() const { return problem_; }

private:
    void start(ViewerSession& session);
    void stop();
    void compare(double white);

    ReferenceTracer tracer_;
    std::function<void()> woken_;
    int passes_, scale_;
    std::unique_ptr<ReferenceJob> job_, ending_;  ///< ending_: stopped, and not yet ended
    int revision_ = -1;                           ///< of the session, that the job traces or that was seen last
    std::optional<std::chrono::steady_clock::time_point> waitsSince_;
    Image own_, reference_;  ///< of one size
    std::optional<Image> image_;
    std::optional<ImageDifference> difference_;
    int taken_ = 0;
    bool done_ = false;
    std::string problem_;
    double comparedWhite_ = 0, comparedScale_ = 0;
    Shown comparedAs_ = Shown::Picture;
};

}  // namespace nacre
