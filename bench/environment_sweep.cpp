#include "bench/environment_sweep.hpp"

#include <fmt/format.h>
#include <time.h>

#include "bench/bars.hpp"
#include "bench/environment_gpu.hpp"
#include "bench/environment_naive.hpp"
#include "core/error.hpp"
#include "envmaps/convert.hpp"

namespace nacre::bench {

std::string toString(Chain chain) {
    switch (chain) {
        case Chain::Phong:
            return "Phong chain";
        case Chain::Ggx:
            return "GGX chain";
        case Chain::Diffuse:
            return "diffuse";
    }
    return "?";
}

std::vector<PrefilterLevel> chainLevels(Chain chain, int size) {
    require(size >= 16, "chainLevels: expected a size >= 16");
    std::vector<PrefilterLevel> out;
    switch (chain) {
        case Chain::Phong:
            for (int m = 0; size >> m >= 2; ++m)
                out.push_back({{.kind = LobeKind::Phong, .exponent = std::exp2(10 * (1 - m / 8.0) + 1)}, size >> m});
            break;
        case Chain::Ggx:
            out.push_back({{}, size});
            for (int m = 1; m <= 4; ++m)
                out.push_back({{.kind = LobeKind::Ggx, .alpha = sqr(1 - std::sqrt(1 - m / 4.0))}, size >> m});
            break;
        case Chain::Diffuse:
            out.push_back({{.kind = LobeKind::Diffuse}, size / 4});
            break;
    }
    return out;
}

double processCpuSeconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

namespace {

double texels(const PrefilterLevel& level) { return 6.0 * level.size * level.size; }

EnvironmentMeasurement begin(const ChainTruth& truth, const std::string& method, const std::string& setting) {
    EnvironmentMeasurement m;
    m.surrounding = truth.surrounding;
    m.chain = truth.chain;
    m.sourceSize = truth.source.size();
    m.method = method;
    m.setting = setting;
    m.directSeconds = truth.directSeconds;
    return m;
}

/// As reference's at texel centres: root mean square over samples and channels, as a share of the truth's mean.
EnvironmentError errorAtCentres(const std::vector<Rgb>& found, const EnvironmentSamples& samples) {
    EnvironmentError out;
    out.samples = static_cast<int>(found.size());
    double squares = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const Rgb difference = found[i] - samples.expected[i];
        squares += glm::dot(difference, difference) / 3;
        out.mean += mean(samples.expected[i]);
        out.max = std::max(out.max, maxComponent(glm::abs(difference)));
    }
    out.mean /= static_cast<double>(found.size());
    out.rmse = std::sqrt(squares / static_cast<double>(found.size())) / out.mean;
    out.max /= out.mean;
    return out;
}

/// A method that answers texel by texel, at the sampled texels; its time is theirs times all texels over the sampled.
void measureAtSamples(const ChainTruth& truth, const std::function<Rgb(const Lobe&, const Vec3&)>& filter,
                      EnvironmentMeasurement& out) {
    out.projected = true;
    for (std::size_t i = 0; i < truth.levels.size(); ++i) {
        const EnvironmentSamples& samples = truth.samples[i];
        out.levels.push_back({truth.levels[i], {}});
        if (samples.directions.empty()) continue;
        std::vector<Rgb> found;
        const double start = processCpuSeconds();
        for (std::size_t k = 0; k < samples.texels.size(); ++k)
            found.push_back(filter(truth.levels[i].lobe, samples.directions[k]));
        out.cpuSeconds += (processCpuSeconds() - start) * texels(truth.levels[i]) / static_cast<double>(found.size());
        out.levels.back().error = errorAtCentres(found, samples);
    }
}

}  // namespace

ChainTruth drawChainTruth(const BenchSurrounding& surrounding, Chain chain, int size, int samples,
                          const Progress& progress) {
    ChainTruth out{surrounding.name, chain, asCube(surrounding, size), chainLevels(chain, size), {}, samples, 0};
    const EnvironmentTruth truth(out.source);
    for (const PrefilterLevel& level : out.levels) {
        report(progress, fmt::format("truth of {} {}: {} {}", toString(chain), size, surrounding.name, level.size), 0);
        out.samples.emplace_back();
        if (level.lobe.kind == LobeKind::Mirror) continue;
        const double start = processCpuSeconds();
        out.samples.back() = drawEnvironmentSamples(EnvLayout::Cube, level.size, truth, level.lobe, samples);
        out.directSeconds += (processCpuSeconds() - start) * texels(level) / (2.0 * samples);
    }
    return out;
}

double EnvironmentMeasurement::worstRmse() const {
    double worst = 0;
    for (const LevelMeasurement& level : levels) worst = std::max(worst, level.error.rmse);
    return worst;
}

EnvironmentMeasurement measurePrefilter(const ChainTruth& truth, double tolerance, int runs) {
    EnvironmentMeasurement out = begin(truth, "nacre", fmt::format("tolerance {:g}", tolerance));
    PrefilterOptions options;
    out.usual = tolerance == options.tolerance;
    options.tolerance = tolerance;
    std::vector<double> seconds;
    Prefiltered result;
    for (int run = 0; run < runs; ++run) {
        const double start = processCpuSeconds();
        result = prefilter(truth.source, truth.levels, options);
        seconds.push_back(processCpuSeconds() - start);
    }
    out.cpuSeconds = median(seconds);
    for (std::size_t i = 0; i < truth.levels.size(); ++i) {
        out.levels.push_back({truth.levels[i], {}});
        if (!truth.samples[i].directions.empty())
            out.levels.back().error = measureEnvironment(result.levels[i], truth.samples[i]);
    }
    return out;
}

EnvironmentMeasurement measureImportance(const ChainTruth& truth, int count, bool filtered) {
    EnvironmentMeasurement out =
        begin(truth, filtered ? "importance, mips" : "importance", fmt::format("{} samples", count));
    out.usual = filtered && count == 1024;
    const double start = processCpuSeconds();
    const CubePyramid pyramid(truth.source);
    out.cpuSeconds = processCpuSeconds() - start;
    measureAtSamples(
        truth, [&](const Lobe& lobe, const Vec3& r) { return importanceSampled(pyramid, lobe, r, count, filtered); },
        out);
    return out;
}

EnvironmentMeasurement measureReducedSums(const ChainTruth& truth, int reducedSize) {
    EnvironmentMeasurement out = begin(truth, "sums, reduced", fmt::format("source reduced to {}", reducedSize));
    const double start = processCpuSeconds();
    const EnvMap reduced = convertEnv(truth.source, EnvLayout::Cube, reducedSize);
    out.cpuSeconds = processCpuSeconds() - start;
    const EnvironmentTruth sums(reduced);
    measureAtSamples(truth, sums, out);
    return out;
}

int affordableSamples(int samples, int sourceSize) {
    const double share = std::min(1.0, sqr(256.0 / sourceSize));
    return std::max(std::min(samples, 16), static_cast<int>(samples * share));
}

SweepPlan sweepPlan(int size, bool quick, bool slowGpu) {
    SweepPlan plan;
    if (quick) {
        plan = {24, false, {1e-2, 6e-4}, {64, 1024}, {8}, {}};
    } else if (size <= 256) {
        plan = {64, true, {3e-2, 1e-2, 3e-3, 6e-4, 1e-4}, {64, 256, 1024, 4096}, {2, 4, 8, 16}, {}};
    } else {
        plan = {64, false, {3e-2, 6e-4, 1e-4}, {64, 256, 1024}, {1, 2, 4, 8}, {}};
    }
    plan.samples = affordableSamples(plan.samples, size);
    const int largestReduced = size <= 256 ? 128 : 64;
    for (int reduced = 16; reduced < size && reduced <= largestReduced; reduced *= 2)
        plan.reducedSizes.push_back(reduced);
    constexpr double kDrawnByCpu = 1024;  // detail times size: more takes a CPU that draws a minute a chain
    if (slowGpu) std::erase_if(plan.details, [&](double d) { return d * size > kDrawnByCpu; });
    return plan;
}

std::vector<BenchSurrounding> decidingSurroundings(const std::vector<BenchSurrounding>& all) {
    std::vector<BenchSurrounding> out;
    std::copy_if(all.begin(), all.end(), std::back_inserter(out),
                 [](const BenchSurrounding& s) { return s.name != kSyntheticName; });
    return out.empty() ? all : out;
}

static void measureMethods(const ChainTruth& truth, const SweepPlan& plan, const EnvironmentSweepOptions& options,
                           std::vector<EnvironmentMeasurement>& out) {
    const auto say = [&](const std::string& method) {
        report(options.progress,
               fmt::format("{} on {} {}: {}", method, toString(truth.chain), truth.source.size(), truth.surrounding),
               0);
    };
    for (const double tolerance : plan.tolerances) {
        say(fmt::format("nacre, tolerance {:g}", tolerance));
        out.push_back(measurePrefilter(truth, tolerance));
    }
    for (const bool filtered : {true, false})
        for (const int count : plan.counts) {
            say(fmt::format("importance, {} samples", count));
            out.push_back(measureImportance(truth, count, filtered));
        }
    for (const int reduced : plan.reducedSizes) {
        say(fmt::format("sums over a source reduced to {}", reduced));
        out.push_back(measureReducedSums(truth, reduced));
    }
    if (!options.gpu) return;
    for (const double detail : plan.details) {
        say(fmt::format("GPU, detail {:g}", detail));
        out.push_back(options.gpu->measure(truth, detail));
    }
}

std::vector<EnvironmentMeasurement> sweepEnvironments(const std::vector<BenchSurrounding>& surroundings,
                                                      const EnvironmentSweepOptions& options) {
    const std::vector<int> sizes = !options.sizes.empty() ? options.sizes
                                   : options.quick        ? std::vector{128}
                                                          : std::vector{128, 256, 512, 1024};
    const bool slowGpu = options.gpu && options.gpu->drawnByCpu();
    std::vector<EnvironmentMeasurement> out;
    for (const int size : sizes) {
        const SweepPlan plan = sweepPlan(size, options.quick, slowGpu);
        std::vector<BenchSurrounding> maps = plan.everyMap ? surroundings : decidingSurroundings(surroundings);
        if (options.quick) maps = {surroundings.front()};
        for (const Chain chain : kChains)
            for (const BenchSurrounding& map : maps)
                measureMethods(drawChainTruth(map, chain, size, plan.samples, options.progress), plan, options, out);
    }
    return out;
}

}  // namespace nacre::bench
