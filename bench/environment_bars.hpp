// The figures that prefiltering promises to hold.
#pragma once

#include "bench/bars.hpp"
#include "bench/environment_sweep.hpp"

namespace nacre::bench {

struct EnvironmentBarOptions {
    int samples = 300;  ///< a level, of a 256 source; fewer of larger ones (affordableSamples)
    bool large = true;  ///< the 512 source too
    Progress progress{};
};

/// Bakes each chain three times on each surrounding and fills the table.
std::vector<Bar> measureEnvironmentBars(const std::vector<BenchSurrounding>& surroundings,
                                        const EnvironmentBarOptions& options,
                                        std::vector<EnvironmentMeasurement>* measurements = nullptr);

/// The rows of the chains from measurements at the usual tolerance, the worst surrounding and level deciding.
std::vector<Bar> chainBars(const std::vector<EnvironmentMeasurement>& measurements);

}  // namespace nacre::bench
