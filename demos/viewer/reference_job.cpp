#include "demos/viewer/reference_job.hpp"

#include <atomic>
#include <mutex>
#include <thread>

#include "core/error.hpp"

namespace nacre {

struct ReferenceJob::Shared {
    ReferenceTracer tracer;
    ReferenceView view;
    int passes;
    std::function<void()> woken;
    std::atomic<bool> stop = false;
    mutable std::mutex mutex;  ///< of the two below
    State state;
    Image sum;
    std::thread thread;  ///< last: starts when the rest is there

    void run() {
        std::string problem;
        try {
            for (int pass = 0; pass < passes && !stop; ++pass) {
                const Image picture = tracer(view, pass, [this] { return stop.load(); });
                if (stop) break;
                add(picture);
                woken();
            }
        } catch (const std::exception& error) {
            if (!stop) problem = error.what();
        }
        {
            const std::lock_guard lock(mutex);
            state.done = true;
            state.problem = problem;
        }
        woken();
    }

    void add(const Image& picture) {
        const std::lock_guard lock(mutex);
        if (state.passes++ == 0) {
            sum = picture;
            return;
        }
        for (int y = 0; y < sum.height(); ++y)
            for (int x = 0; x < sum.width(); ++x)
                for (int c = 0; c < sum.channels(); ++c) sum.at(x, y, c) += picture.at(x, y, c);
    }
};

ReferenceJob::ReferenceJob(ReferenceTracer tracer, ReferenceView view, int passes, std::function<void()> woken)
    : shared_(std::make_unique<Shared>()) {
    require(passes >= 1 && view.width >= 1 && view.height >= 1, "ReferenceJob: expected passes and pixels");
    shared_->tracer = std::move(tracer);
    shared_->view = std::move(view);
    shared_->passes = passes;
    shared_->woken = std::move(woken);
    shared_->thread = std::thread([job = shared_.get()] { job->run(); });
}

ReferenceJob::~ReferenceJob() {
    stop();
    shared_->thread.join();
}

void ReferenceJob::stop() { shared_->stop = true; }

ReferenceJob::State ReferenceJob::state() const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->state;
}

int ReferenceJob::passes() const { return shared_->passes; }

Image ReferenceJob::mean() const {
    const std::lock_guard lock(shared_->mutex);
    Image out = shared_->sum;
    const float scale = shared_->state.passes > 0 ? 1.0f / static_cast<float>(shared_->state.passes) : 0;
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x)
            for (int c = 0; c < out.channels(); ++c) out.at(x, y, c) *= scale;
    return out;
}

}  // namespace nacre
