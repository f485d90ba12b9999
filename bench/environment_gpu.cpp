#include "bench/environment_gpu.hpp"

#include <fmt/format.h>

#include <chrono>

#include "shading/gpu_prefilter.hpp"

namespace nacre::bench {

bool EnvironmentGpu::drawnByCpu() const {
    const std::string renderer = description();
    return renderer.find("llvmpipe") != std::string::npos || renderer.find("softpipe") != std::string::npos;
}

EnvironmentMeasurement EnvironmentGpu::measure(const ChainTruth& truth, double detail) {
    context_.makeCurrent();
    const bool onCpu = drawnByCpu();
    const auto seconds = [onCpu] {
        return onCpu ? processCpuSeconds()
                     : std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    };
    GpuPrefilterOptions options;
    EnvironmentMeasurement out;
    out.usual = detail == options.detail;
    options.detail = detail;
    options.color = ColorFormat::Rgba32F;
    const TextureName source;
    uploadCube(truth.source, source);
    GpuPrefilter prefilter(loader_, truth.source.size(), truth.levels, options);
    const double start = seconds();
    while (!prefilter.update(source.name(), 1000)) {
    }
    out.cpuSeconds = seconds() - start;
    out.surrounding = truth.surrounding;
    out.chain = truth.chain;
    out.sourceSize = truth.source.size();
    out.method = "GPU";
    out.setting = fmt::format("detail {:g}{}", detail, onCpu ? ", drawn by the CPU" : "");
    out.directSeconds = truth.directSeconds;
    for (std::size_t i = 0; i < truth.levels.size(); ++i) {
        out.levels.push_back({truth.levels[i], {}});
        if (!truth.samples[i].directions.empty())
            out.levels.back().error = measureEnvironment(prefilter.read(static_cast<int>(i)), truth.samples[i]);
    }
    return out;
}

}  // namespace nacre::bench
