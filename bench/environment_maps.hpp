// The surroundings that the environment technique is measured on.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/environment.hpp"

namespace nacre::bench {

struct BenchSurrounding {
    std::string name;
    EnvMap map;  ///< latitude-longitude, finite, none negative
};

struct SurroundingList {
    std::vector<BenchSurrounding> surroundings;
    std::vector<std::string> notes;  ///< what was missing or mended
};

inline constexpr const char* kSyntheticName = "synthetic";

/// Sky, ground, a rectangular lamp and a sun of one texel at 26 000 times the mean: what no file is needed for.
EnvMap syntheticSurrounding(int size = 256);

/// The synthetic one, then forest (even), studio (lamps) and city (a sun) from the first folder that has each:
/// $NACRE_ENVIRONMENTS, build/data/environments, Debian's blender-data. Negative and non-finite texels become 0.
SurroundingList benchSurroundings();
SurroundingList benchSurroundings(const std::vector<std::filesystem::path>& folders);

/// The map as a cube, area-filtered.
EnvMap asCube(const BenchSurrounding& surrounding, int size);

}  // namespace nacre::bench
