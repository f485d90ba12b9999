// Pipes as processes: this one, and children that run the same command line. On a software rasterizer threads would
// share one set of rasterizer threads, and wait for each other there.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/child_process.hpp"
#include "shading/hybrid/pipe_link.hpp"

namespace nacre::cli {

class PipeProcesses {
public:
    /// Starts count − 1 children, which find their ways by inheritedPipe(). Gives each pipe its part of the cores as
    /// rasterizer threads, unless LP_NUM_THREADS says otherwise: to be called before the first context.
    /// \param arguments  of this command, without the program's name  \throws nacre::Error
    PipeProcesses(const std::vector<std::string>& arguments, int count);
    PipeLink& link() { return *link_; }
    /// What a pipe has said on standard error, its last line: why it ended.
    std::string lastWords(int pipe);

private:
    std::vector<std::unique_ptr<ChildProcess>> children_;
    std::unique_ptr<PipeLink> link_;  ///< goes first: children end when their ways do
};

/// The link of a process that PipeProcesses started; null in others.
std::unique_ptr<PipeLink> inheritedPipe();

/// LP_NUM_THREADS for one of `pipes` on this machine, unless it is set.
void shareRasterizerThreads(int pipes);

}  // namespace nacre::cli
