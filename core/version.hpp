// The version of this build, as CMakeLists.txt states it; written into every asset.
#pragma once

#include <string>

namespace nacre {

std::string nacreVersion();  ///< for instance 0.1.0

}  // namespace nacre
