// What the environment technique's section of the report says.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/environment_sweep.hpp"

namespace nacre::bench {

nlohmann::json environmentJson(const EnvironmentMeasurement& measurement);

/// For each chain and size: worst level's error against CPU-seconds, one curve a method, medians over the surroundings;
/// then a table of all. Empty without measurements.
std::string environmentSection(const std::vector<EnvironmentMeasurement>& measurements);

}  // namespace nacre::bench
