// Frames of `nacre render` by several pipes: processes of this machine, or MPI's ranks.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/pipe_processes.hpp"
#include "cli/verb.hpp"
#include "shading/hybrid/hybrid_renderer.hpp"

namespace nacre::cli {

struct PipeSettings {
    std::optional<int> count;
    bool mpi = false;  ///< pipes are ranks
    CrewOptions crew{};
    bool latency = false;
    int repeat = 0;
    std::string dependent;  ///< the first option given that needs one of the two above
};

/// \param s  outlives them
std::vector<Option> pipeOptions(PipeSettings& s);

/// What of a frame is asked for.
struct FrameRequest {
    int width = 512, height = 512;
    HybridOptions options;
    double time = 0;
};

/// A frame, and what drawing it took.
struct PipedFrame {
    HybridFrame frame;
    nlohmann::json data;  ///< none with one pipe that nobody asked for
    std::string lacking;  ///< which pipes the frame comes without, and why; empty: none
};

/// The pipes of this command.
class RenderPipes {
public:
    /// Starts the others. To be made before the first context: each pipe gets its part of the cores.
    /// \throws UsageError, nacre::Error
    RenderPipes(const Context& context, const PipeSettings& s);
    /// The first pipe, which writes and prints; the others serve.
    bool leads() const { return !link_ || link_->self() == 0; }
    PipedFrame draw(HybridRenderer& renderer, const FrameRequest& request);
    void serve(HybridRenderer& renderer, const FrameRequest& request);

private:
    std::string notesOf(PipeCrew& crew);
    const PipeSettings& settings_;
    std::unique_ptr<PipeProcesses> processes_;
    std::unique_ptr<PipeLink> own_;  ///< a child's, or MPI's
    PipeLink* link_ = nullptr;
};

/// A frame's time by table 2's columns of HYBRID, in seconds of the first pipe: shadow, indirect, direct, specular,
/// composite, which contains the wait for the others.
nlohmann::json secondsByPass(const HybridReport& report);

}  // namespace nacre::cli
