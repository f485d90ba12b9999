#include "cli/render_pipes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "cli/mpi_link.hpp"
#include "cli/output_file.hpp"
#include "cli/terminal.hpp"
#include "core/error.hpp"

namespace nacre::cli {
namespace {

using nlohmann::json;

constexpr const char* kPasses[] = {"shadow", "indirect", "direct", "specular", "composite"};

double medianOf(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
}

/// Frames one after the other, each with the time that it took: with latency until the next one is drawn.
struct Frames {
    std::vector<double> seconds;
    json passes = json::object();  ///< sums over frames
    HybridFrame last;
    int taken = 0;

    void take(HybridFrame frame) {
        if (++taken == 2) passes = json::object();  // the first compiles programs
        const json now = secondsByPass(frame.report);
        for (const char* pass : kPasses) passes[pass] = passes.value(pass, 0.0) + now[pass].get<double>();
        last = std::move(frame);
    }

    json toJson() const {
        double all = 0;
        for (const char* pass : kPasses) all += passes[pass].get<double>();
        json shares;
        for (const char* pass : kPasses) shares[pass] = passes[pass].get<double>() / all;
        const auto first = seconds.begin() + (seconds.size() > 1 ? 1 : 0);
        return {{"frames", seconds.size()}, {"frame_seconds", medianOf({first, seconds.end()})}, {"shares", shares}};
    }
};

}  // namespace

json secondsByPass(const HybridReport& report) {
    json out;
    for (const char* pass : kPasses) out[pass] = 0.0;
    for (const PassTime& stage : report.stages) {
        const bool specular = stage.name == "tags" || stage.name == "traced";
        const char* pass = stage.name == "composite"                            ? "composite"
                           : specular                                           ? "specular"
                           : stage.name == "shadows"                            ? "shadow"
                           : stage.name == "direct" || stage.name == "geometry" ? "direct"
                                                                                : "indirect";
        out[pass] = out[pass].get<double>() + stage.wallSeconds;
    }
    out["shadow"] = out["shadow"].get<double>() + report.shadowSeconds;
    out["direct"] = out["direct"].get<double>() - report.shadowSeconds;
    return out;
}

std::vector<Option> pipeOptions(PipeSettings& s) {
    const auto dependent = [&s](const char* flag, std::function<void(const std::string&)> take) {
        return [&s, flag, take = std::move(take)](const std::string& text) {
            if (s.dependent.empty()) s.dependent = flag;
            take(text);
        };
    };
    return {{"--pipes", "N", "Processes with an OpenGL context each that share a frame's samples and virtual lights",
             integerInto([&s](long long v) { s.count = static_cast<int>(v); }, 1, kMostPipes)},
            {"--mpi", "", "Pipes are the ranks that mpirun started this command as", into(s.mpi)},
            {"--compositing", "METHOD",
             "Of pipes' images: binary-swap (default), halves added by the pipelines, or software, by threads",
             dependent("--compositing",
                       [&s](const std::string& text) {
                           if (text != "binary-swap" && text != "software")
                               throw UsageError(fmt::format("expected binary-swap or software, found '{}'", text));
                           s.crew.compositing = text == "software" ? Compositing::Software : Compositing::BinarySwap;
                       })},
            {"--latency", "", "Put a frame's images together while the next one is drawn",
             dependent("--latency", into(s.latency))},
            {"--repeat", "N",
             "Draw the frame so many times again, and print frames/s of the fastest; pipes: so often, and the median",
             integerInto([&s](long long v) { s.repeat = static_cast<int>(v); }, 1, 1000000)},
            {"--patience", "S", "A pipe that is so much later than the first is left out (default 30)",
             dependent("--patience", positiveInto([&s](double v) { s.crew.patience = v; }))}};
}

RenderPipes::RenderPipes(const Context& context, const PipeSettings& s) : settings_(s) {
    if (!s.count && !s.mpi) {
        if (!s.dependent.empty())
            throw UsageError(s.dependent + ": expected --pipes or --mpi beside it, found neither");
        return;
    }
    if (s.count && s.mpi) throw UsageError("--pipes: expected none beside --mpi, whose ranks are the pipes");
    if (s.latency && s.crew.compositing != Compositing::Software)
        throw UsageError("--latency: expected --compositing software beside it, found binary-swap");
    if (s.mpi) {
        own_ = mpiLink();
        if (own_->count() == 1) tell("--mpi: found one rank, this process; mpirun -n N starts more");
    } else {
        own_ = inheritedPipe();
        if (!own_) processes_ = std::make_unique<PipeProcesses>(context.arguments, *s.count);
    }
    link_ = own_ ? own_.get() : &processes_->link();
}

std::string RenderPipes::notesOf(PipeCrew& crew) {
    std::string out;
    for (const std::string& note : crew.takeNotes()) {
        out += note;
        const int pipe = std::atoi(note.c_str() + std::string("pipe ").size());
        const std::string words = processes_ ? processes_->lastWords(pipe) : "";
        out += words.empty() ? "; " : ": " + words + "; ";
    }
    return out;  // "…; …; "
}

PipedFrame RenderPipes::draw(HybridRenderer& renderer, const FrameRequest& r) {
    PipedFrame out;
    if (!link_) {
        out.frame.picture = renderer.draw(r.width, r.height, r.options, r.time);
        out.frame.report = renderer.report();
        return out;
    }
    PipeCrew crew(*link_, settings_.crew);
    Frames frames;
    std::string notes;
    std::future<HybridFrame> before;
    for (int left = std::max(1, settings_.repeat) + settings_.latency; left > 0; --left) {
        const Stopwatch watch;
        crew.begin(r.time);
        std::future<HybridFrame> now = renderer.start(r.width, r.height, r.options, r.time, crew);
        if (!settings_.latency) frames.take(now.get());
        if (before.valid()) frames.take(before.get());
        before = std::move(now);
        frames.seconds.push_back(watch.seconds());
        notes += notesOf(crew);
    }
    if (before.valid()) frames.take(before.get());
    notes += notesOf(crew);
    if (!notes.empty()) notes.resize(notes.size() - 2);
    out.frame = std::move(frames.last);
    const std::vector<double>& drew = out.frame.report.pipes;
    if (std::any_of(drew.begin(), drew.end(), [](double seconds) { return seconds < 0; }))
        out.lacking = notes.empty() ? "some pipes were lost before" : notes;
    else if (!notes.empty())
        tell(notes);
    out.data = frames.toJson();
    out.data["count"] = link_->count();
    out.data["compositing"] = settings_.crew.compositing == Compositing::Software ? "software" : "binary-swap";
    out.data["latency"] = settings_.latency;
    out.data["draw_seconds"] = drew;
    if (!notes.empty()) out.data["lost"] = notes;
    const char* threads = std::getenv("LP_NUM_THREADS");
    out.data["rasterizer_threads"] = threads ? threads : "as it comes";
    return out;
}

void RenderPipes::serve(HybridRenderer& renderer, const FrameRequest& r) {
    PipeCrew crew(*link_, settings_.crew);
    while (const auto time = crew.await()) renderer.drawShare(r.width, r.height, r.options, *time, crew);
}

}  // namespace nacre::cli
