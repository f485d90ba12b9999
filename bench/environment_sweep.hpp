// Prefiltered environments: chains, the ways to make them, and seconds and error of each.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/environment_maps.hpp"
#include "core/progress.hpp"
#include "envmaps/prefilter.hpp"
#include "reference/environment_error.hpp"

namespace nacre::bench {

class EnvironmentGpu;

enum class Chain { Phong, Ggx, Diffuse };
inline constexpr Chain kChains[] = {Chain::Phong, Chain::Ggx, Chain::Diffuse};
std::string toString(Chain chain);

/// Levels of a chain made of a cube of `size`:
///   Phong    faces size, size/2 … 2; exponent 2^(10(1 − m/8) + 1) at level m
///   Ggx      faces size … size/16; alpha = p² with p(2 − p) = m/4, so a mirror, 0.018, 0.0858, 0.25, 1
///   Diffuse  one level, faces of size/4
std::vector<PrefilterLevel> chainLevels(Chain chain, int size);

/// CPU time of all threads of this process [s].
double processCpuSeconds();

/// A chain's levels with the truth at some of their texels; mirror levels, which are copies, have none.
struct ChainTruth {
    std::string surrounding;
    Chain chain = Chain::Phong;
    EnvMap source;  ///< the cube
    std::vector<PrefilterLevel> levels;
    std::vector<EnvironmentSamples> samples;  ///< of each level; without directions: a mirror
    int samplesALevel = 0;
    double directSeconds = 0;  ///< CPU time of the sum over every texel, from the texels that were sampled
};
ChainTruth drawChainTruth(const BenchSurrounding& surrounding, Chain chain, int size, int samples,
                          const Progress& progress = {});

struct LevelMeasurement {
    PrefilterLevel level;
    EnvironmentError error;  ///< a mirror's is 0; without a map only the errors at texel centres are known
};

struct EnvironmentMeasurement {
    std::string surrounding;
    Chain chain = Chain::Phong;
    int sourceSize = 0;
    std::string method, setting;
    bool usual = false;        ///< what its kind of tool does when nothing is said
    double cpuSeconds = 0;     ///< of the chain
    bool projected = false;    ///< cpuSeconds: from the sampled texels to all
    double directSeconds = 0;  ///< what the sum over every texel takes
    std::vector<LevelMeasurement> levels;
    double worstRmse() const;
};

/// nacre::prefilter, the median of `runs`.
EnvironmentMeasurement measurePrefilter(const ChainTruth& truth, double tolerance, int runs = 1);
/// importanceSampled (bench/environment_naive.hpp) at the sampled texels.
EnvironmentMeasurement measureImportance(const ChainTruth& truth, int count, bool filtered);
/// The sum over every texel of the source reduced to `reducedSize`, at the sampled texels.
EnvironmentMeasurement measureReducedSums(const ChainTruth& truth, int reducedSize);

struct EnvironmentSweepOptions {
    bool quick = false;             ///< one size and the synthetic surrounding alone
    std::vector<int> sizes = {};    ///< of the source; empty: 128, 256, 512, 1024, or 128 alone when quick
    EnvironmentGpu* gpu = nullptr;  ///< null: no OpenGL, no curve of it
    Progress progress{};
};
/// What is measured of a source of one size.
struct SweepPlan {
    int samples = 0;        ///< a level
    bool everyMap = false;  ///< or the deciding ones
    std::vector<double> tolerances;
    std::vector<int> counts;
    std::vector<double> details;  ///< of the GPU
    std::vector<int> reducedSizes;
};
/// Everything up to 256; beyond, where a truth and a chain take up to a minute, fewer settings on the deciding maps.
/// \param slowGpu  drawn by the CPU: coarser settings the larger the source
SweepPlan sweepPlan(int size, bool quick, bool slowGpu);

/// The measured maps, without the synthetic one unless it is all there is.
std::vector<BenchSurrounding> decidingSurroundings(const std::vector<BenchSurrounding>& all);

/// Every method at every setting of the plan on every chain and size. A full run takes about ten minutes on two cores.
std::vector<EnvironmentMeasurement> sweepEnvironments(const std::vector<BenchSurrounding>& surroundings,
                                                      const EnvironmentSweepOptions& options);

/// Samples a level that keep the truth's cost for a source of this size that of 256: the truth grows with size².
int affordableSamples(int samples, int sourceSize);

}  // namespace nacre::bench
