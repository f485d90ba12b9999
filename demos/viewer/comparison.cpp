#include "demos/viewer/comparison.hpp"

#include <algorithm>

namespace nacre {

/// A view that rests for this long is traced.
constexpr std::chrono::milliseconds kRest(300);
/// n × n places a pixel, the same ones in picture and reference: what differs is neither's aliasing.
constexpr int kRays = 2;

Comparison::Comparison(ReferenceTracer tracer, std::function<void()> woken, int passes, int scale)
    : tracer_(std::move(tracer)), woken_(std::move(woken)), passes_(passes), scale_(scale) {}

/// Leaves the thread to itself: waiting for it would hold up the window.
void Comparison::stop() {
    if (job_) {
        job_->stop();
        ending_ = std::move(job_);
    }
    if (ending_ && ending_->state().done) ending_.reset();
    image_.reset();
    difference_.reset();
    taken_ = 0;
    done_ = false;
    problem_.clear();
}

void Comparison::start(ViewerSession& session) {
    const int width = std::max(1, session.width() / scale_), height = std::max(1, session.height() / scale_);
    own_ = session.pictureOf(width, height, kRays);
    job_ = std::make_unique<ReferenceJob>(
        tracer_, ReferenceView{session.scene(), session.camera, session.time, session.switches, width, height}, passes_,
        woken_);
}

void Comparison::compare(double white) {
    comparedWhite_ = white;
    comparedScale_ = differenceScale;
    comparedAs_ = shown;
    difference_ = compareImages(own_, reference_, white);
    image_ = shown == Shown::Reference ? reference_ : differenceImage(own_, reference_, white, differenceScale);
}

bool Comparison::poll(ViewerSession& session, double white) {
    if (shown == Shown::Picture) {
        const bool had = image_.has_value();
        stop();
        waitsSince_.reset();
        revision_ = -1;
        return had;
    }
    const auto now = std::chrono::steady_clock::now();
    if (revision_ != session.revision()) {
        const bool had = image_.has_value();
        stop();
        revision_ = session.revision();
        waitsSince_ = now;
        return had;
    }
    if (ending_ && ending_->state().done) ending_.reset();
    if (waitsSince_ && !ending_ && now - *waitsSince_ >= kRest && session.width() > 0 && session.height() > 0) {
        waitsSince_.reset();
        start(session);
    }
    if (!job_) return false;
    const ReferenceJob::State state = job_->state();
    done_ = state.done;
    problem_ = state.problem;
    const bool fresh = state.passes > taken_;
    if (fresh) {
        taken_ = state.passes;
        reference_ = job_->mean();
    }
    const bool other = comparedWhite_ != white || comparedScale_ != differenceScale || comparedAs_ != shown;
    if (taken_ == 0 || (!fresh && !other)) return false;
    compare(white);
    return true;
}

}  // namespace nacre
