// The GPU's prefilter as one more way to make a chain.
#pragma once

#include "bench/environment_sweep.hpp"
#include "shading/context.hpp"
#include "shading/program.hpp"

namespace nacre::bench {

class EnvironmentGpu {
public:
    /// \throws nacre::Error without a usable OpenGL
    EnvironmentGpu() = default;

    std::string description() const { return context_.description(); }
    bool drawnByCpu() const;  ///< llvmpipe, softpipe

    /// One chain by GpuPrefilter, 32-bit floats. cpuSeconds is wall time between two glFinish, or, where OpenGL runs on
    /// the CPU, CPU time of all threads.
    EnvironmentMeasurement measure(const ChainTruth& truth, double detail);

private:
    Context context_;
    ProgramLoader loader_;
};

}  // namespace nacre::bench
