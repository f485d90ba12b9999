// The reliefs that bump is measured on.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bump/height_map.hpp"

namespace nacre::bench {

struct BenchRelief {
    std::string name;
    HeightMap map;  ///< repeats
};

struct ReliefList {
    std::vector<BenchRelief> reliefs;
    std::vector<std::string> notes;  ///< what was missing
};

/// Fractal ground, courses of bricks and a dome, size² texels: what no file is needed for.
HeightMap syntheticRelief(int size);

/// The synthetic one (256), then rockwall and terrain from the first folder that has each: $NACRE_HEIGHTS, then
/// build/data/heights. Their codes rise to a tenth of their width.
ReliefList benchReliefs();
ReliefList benchReliefs(const std::vector<std::filesystem::path>& folders);

}  // namespace nacre::bench
