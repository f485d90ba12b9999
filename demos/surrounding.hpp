// The surroundings that exhibits stand in: maps that fetch.sh took from a Debian package, or a made-up sky.
#pragma once

#include <filesystem>
#include <string>

#include "core/environment.hpp"

namespace nacre {

struct Surrounding {
    EnvMap map;         ///< latitude-longitude
    std::string file;   ///< what a command line names; empty for the made-up sky
    std::string words;  ///< for a reader
    std::string note;   ///< not empty when the made-up sky stands in
};

/// NAME.exr in `folder`; when it isn't there, syntheticSky. \throws nacre::Error when it is there but broken
Surrounding openSurrounding(const std::string& name, const std::filesystem::path& folder);

/// A sky from a formula, 2·size × size: blue overhead, bright at the horizon, brown ground, a sun of one degree at
/// 20 000 times the sky, a window-like lamp to the left (−x) and two small coloured ones behind (+z).
EnvMap syntheticSky(int size = 256);

}  // namespace nacre
