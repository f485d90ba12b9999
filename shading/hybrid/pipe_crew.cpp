#include "shading/hybrid/pipe_crew.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/error.hpp"

namespace nacre {
namespace {

constexpr PipeClock::time_point kNever = PipeClock::time_point::max();

constexpr const char* kTogether = "putting images together, so that it is drawn again";

std::uint64_t bitOf(int pipe) { return std::uint64_t(1) << pipe; }

}  // namespace

PipeCrew::PipeCrew(PipeLink& link, const CrewOptions& options) : link_(link), options_(options) {
    require(link.count() >= 1 && link.count() <= kMostPipes, fmt::format("pipes: expected 1 to {}", kMostPipes));
    require(options.patience > 0, "pipes: expected a patience > 0");
    present_ = ~std::uint64_t(0) >> (64 - link.count());
    order_.pipes = present_;
    weights_.fill(1);
    cut();
}

PipeCrew::~PipeCrew() {
    if (!leads()) return;
    const Order last;
    for (const int pipe : members())
        if (pipe != 0) link_.exchange(pipe, PipeWay::Order, bytesIn(last), {}, deadline());
}

std::vector<int> PipeCrew::members() const {
    std::vector<int> out;
    const std::uint64_t present = leads() ? present_.load() : order_.pipes;
    for (int pipe = 0; pipe < link_.count(); ++pipe)
        if (present & bitOf(pipe)) out.push_back(pipe);
    return out;
}

int PipeCrew::present() const { return static_cast<int>(members().size()); }

DrawShare PipeCrew::share(int pipe) const {
    const auto at = static_cast<std::size_t>(pipe);
    return {order_.cuts[at], order_.cuts[at + 1]};
}

/// Shares of those that are there, by their weights. The leader's begins at 0.
void PipeCrew::cut() {
    const std::lock_guard lock(mutex_);
    double sum = 0;
    for (const int pipe : members()) sum += weights_[static_cast<std::size_t>(pipe)];
    double until = 0;
    for (int pipe = 0; pipe < kMostPipes; ++pipe) {
        const auto at = static_cast<std::size_t>(pipe);
        if (order_.pipes & bitOf(pipe)) until += weights_[at] / sum;
        order_.cuts[at + 1] = until;
    }
    for (double& cut : order_.cuts)
        if (cut == until) cut = 1;  // but for rounding
}

/// Where all take the same time, nothing changes. Half of the way, as samples are few and times vary.
void PipeCrew::learn(const std::vector<double>& seconds) {
    double sum = 0;
    int count = 0;
    for (const double s : seconds)
        if (s > 0) sum += s, ++count;
    if (count < 2) return;
    const std::lock_guard lock(mutex_);
    for (std::size_t i = 0; i < seconds.size(); ++i)
        if (seconds[i] > 0) weights_[i] = std::clamp(weights_[i] * std::sqrt(sum / count / seconds[i]), 0.2, 5.0);
}

PipeClock::time_point PipeCrew::deadline(double times) const {
    return PipeClock::now() +
           std::chrono::duration_cast<PipeClock::duration>(std::chrono::duration<double>(times * options_.patience));
}

void PipeCrew::lose(int pipe, const char* doing, std::uint64_t frame) {
    if (!(present_.fetch_and(~bitOf(pipe)) & bitOf(pipe))) return;
    const std::lock_guard lock(mutex_);
    notes_.push_back(fmt::format("pipe {} of {} is gone or later than {:g} s ({}): frame {} comes without it", pipe,
                                 link_.count(), options_.patience, doing, frame));
}

std::vector<std::string> PipeCrew::takeNotes() {
    const std::lock_guard lock(mutex_);
    return std::exchange(notes_, {});
}

void PipeCrew::begin(double time) {
    order_.pipes = present_, order_.time = time, ++order_.frame;
    cut();
    for (const int pipe : members())
        if (pipe != 0 && !link_.exchange(pipe, PipeWay::Order, bytesIn(order_), {}, deadline()))
            lose(pipe, "at its start");
}

std::optional<double> PipeCrew::await() {
    if (!link_.exchange(0, PipeWay::Order, {}, roomIn(order_), kNever))
        throw Error(fmt::format("pipe {}: expected a frame to draw, found the first pipe gone", link_.self()));
    if (order_.pipes == 0) return {};
    return order_.time;
}

void PipeCrew::gather(std::vector<ElementPower>& sources, std::size_t elements) {
    const auto sharedBy = [&](int pipe) {
        std::vector<std::size_t> out;
        for (std::size_t i = 0; i < sources.size() && elements > 0; ++i)
            if (share(pipe).takes(i)) out.push_back(i);
        return out;
    };
    if (!leads()) {
        for (const std::size_t i : sharedBy(link_.self()))
            link_.exchange(0, PipeWay::Order, bytesIn(sources[i]), {}, kNever);
        return;
    }
    for (const int pipe : members()) {
        const PipeClock::time_point until = deadline();
        for (const std::size_t i : pipe == 0 ? std::vector<std::size_t>() : sharedBy(pipe)) {
            sources[i].resize(elements);
            if (link_.exchange(pipe, PipeWay::Order, {}, roomIn(sources[i]), until)) continue;
            sources[i].clear();
            lose(pipe, "with what it found to reflect light");
            break;
        }
    }
}

void PipeCrew::spread(VirtualLights& lights) {
    std::uint64_t count = lights.lights.size();
    if (!leads()) {
        link_.exchange(0, PipeWay::Order, {}, roomIn(count), kNever);
        lights.lights.resize(count);
        link_.exchange(0, PipeWay::Order, {}, roomIn(lights.lights), kNever);
        return;
    }
    for (const int pipe : members())
        if (pipe != 0 && !(link_.exchange(pipe, PipeWay::Order, bytesIn(count), {}, deadline()) &&
                           link_.exchange(pipe, PipeWay::Order, bytesIn(lights.lights), {}, deadline())))
            lose(pipe, "before its virtual lights");
}

/// Of each pipe, as long as nothing has come from it.
std::vector<double> PipeCrew::secondsBefore() const {
    std::vector<double> out;
    for (int pipe = 0; pipe < link_.count(); ++pipe)
        out.push_back(order_.pipes & bitOf(pipe) ? -1 : std::numeric_limits<double>::quiet_NaN());
    return out;
}

/// Who is done drawing, and in what time: the leader then tells all who take part in the swap.
std::vector<double> PipeCrew::rollCall(double seconds) {
    std::vector<double> out = secondsBefore();
    out[static_cast<std::size_t>(link_.self())] = seconds;
    if (!leads()) {
        link_.exchange(0, PipeWay::Image, bytesIn(seconds), {}, kNever);
        link_.exchange(0, PipeWay::Image, {}, roomIn(order_.pipes), kNever);
        return out;
    }
    const PipeClock::time_point until = deadline();
    for (const int pipe : members()) {
        double& theirs = out[static_cast<std::size_t>(pipe)];
        if (pipe == 0 || link_.exchange(pipe, PipeWay::Image, {}, roomIn(theirs), until)) continue;
        theirs = -1;
        lose(pipe, "drawing");
    }
    learn(out);
    order_.pipes = present_;
    for (const int pipe : members())
        if (pipe != 0) link_.exchange(pipe, PipeWay::Image, bytesIn(order_.pipes), {}, deadline());
    return out;
}

/// The leader's: each pipe's rows after the swap. \param good  what binarySwap said \return whether all are there
bool PipeCrew::collectRows(std::span<const RenderTarget* const> targets, bool good, std::vector<Image>& images) {
    const int width = targets[0]->width(), height = targets[0]->height();
    const std::vector<int> pipes = members();
    const std::size_t row = 4 * static_cast<std::size_t>(width), image = row * static_cast<std::size_t>(height);
    std::vector<float> all(image * targets.size());
    std::vector<int> without;  // a partner's half
    for (std::size_t i = 0; i < pipes.size(); ++i) {
        const ImageRows rows = rowsAfterSwap(height, static_cast<int>(i), static_cast<int>(pipes.size()));
        const std::size_t size = row * static_cast<std::size_t>(rows.count);
        std::vector<float> pixels(size * targets.size());
        std::uint8_t theirs = good;
        if (i == 0)
            pixels = readRows(targets, rows);
        else if (!link_.exchange(pipes[i], PipeWay::Image, {}, roomIn(theirs), deadline(2)) ||  // it waited itself
                 !link_.exchange(pipes[i], PipeWay::Image, {}, roomIn(pixels), deadline()))
            lose(pipes[i], kTogether);
        if (!theirs) without.push_back(pipes[i]);
        for (std::size_t t = 0; t < targets.size(); ++t)
            std::copy_n(
                pixels.begin() + static_cast<std::ptrdiff_t>(t * size), size,
                all.begin() + static_cast<std::ptrdiff_t>(t * image + row * static_cast<std::size_t>(rows.first)));
    }
    if (members() == pipes && without.empty()) {
        for (std::size_t t = 0; t < targets.size(); ++t)
            images.push_back(imageOf(std::span(all).subspan(t * image, image), width, height));
        return true;
    }
    for (const int pipe : members() == pipes ? without : std::vector<int>())  // there, but some don't reach each other
        if (pipe != 0 || without.size() == 1) lose(pipe != 0 ? pipe : pipes[1], kTogether);
    return false;
}

CompositedFrame PipeCrew::compositeSwapped(ProgramLoader& loader, std::span<const RenderTarget* const> targets,
                                           double seconds, bool& again) {
    CompositedFrame out;
    out.drawSeconds = rollCall(seconds);
    const std::vector<int> pipes = members();
    std::uint8_t good = binarySwap(loader, link_, pipes, targets, deadline());
    Order verdict;
    if (leads()) {
        again = !collectRows(targets, good, out.images);
        if (again) order_.pipes = present_, cut();
        verdict = order_;
        verdict.frame = again;
        for (const int pipe : members())
            if (pipe != 0) link_.exchange(pipe, PipeWay::Image, bytesIn(verdict), {}, deadline());
        return out;
    }
    const auto index = static_cast<int>(std::find(pipes.begin(), pipes.end(), link_.self()) - pipes.begin());
    const ImageRows rows = rowsAfterSwap(targets[0]->height(), index, static_cast<int>(pipes.size()));
    link_.exchange(0, PipeWay::Image, bytesIn(good), {}, kNever);
    link_.exchange(0, PipeWay::Image, bytesIn(readRows(targets, rows)), {}, kNever);
    again = link_.exchange(0, PipeWay::Image, {}, roomIn(verdict), kNever) && verdict.frame != 0;
    if (again) order_.pipes = verdict.pipes, order_.cuts = verdict.cuts;
    return out;
}

CompositedFrame PipeCrew::addInSoftware(CompositedFrame out, std::vector<float> mine, std::size_t targets, int width,
                                        int height, const std::vector<int>& pipes, std::uint64_t frame) {
    std::vector<std::vector<float>> images;
    const PipeClock::time_point until = deadline();
    for (const int pipe : pipes) {
        if (pipe == 0) continue;
        double& theirs = out.drawSeconds[static_cast<std::size_t>(pipe)];
        std::vector<float> image(mine.size());
        if (link_.exchange(pipe, PipeWay::Image, {}, roomIn(theirs), until) &&
            link_.exchange(pipe, PipeWay::Image, {}, roomIn(image), until)) {
            images.push_back(std::move(image));
            continue;
        }
        theirs = -1;
        lose(pipe, "drawing", frame);
    }
    learn(out.drawSeconds);
    addImages(mine, images);
    const std::size_t size = mine.size() / targets;
    for (std::size_t t = 0; t < targets; ++t)
        out.images.push_back(imageOf(std::span(mine).subspan(t * size, size), width, height));
    return out;
}

std::function<CompositedFrame()> PipeCrew::composite(ProgramLoader& loader,
                                                     std::span<const RenderTarget* const> targets, double seconds,
                                                     bool& again) {
    again = false;
    if (options_.compositing == Compositing::BinarySwap) {
        CompositedFrame out = compositeSwapped(loader, targets, seconds, again);
        return [out = std::move(out)]() mutable { return std::move(out); };
    }
    const int width = targets[0]->width(), height = targets[0]->height();
    std::vector<float> mine = readRows(targets, {0, height});
    if (!leads()) {
        link_.exchange(0, PipeWay::Image, bytesIn(seconds), {}, kNever);
        link_.exchange(0, PipeWay::Image, bytesIn(mine), {}, kNever);
        return {};
    }
    CompositedFrame out{{}, secondsBefore()};
    out.drawSeconds[0] = seconds;
    return [this, out = std::move(out), mine = std::move(mine), count = targets.size(), width, height,
            pipes = members(), frame = order_.frame]() mutable {
        return addInSoftware(std::move(out), std::move(mine), count, width, height, pipes, frame);
    };
}

}  // namespace nacre
