// Simulated micro-geometry by name: `micro:ridges,slope=1,left=0.1/0.2/0.8,right=0.8/0.1/0.1`.
#pragma once

#include <string>
#include <vector>

#include "factorize/models/models.hpp"
#include "factorize/reflectance.hpp"

namespace nacre {

inline constexpr const char* kMicroPrefix = "micro:";

/// Every relief openMicro knows, named as they are typed (`micro:ridges`), in the order they are shown.
std::vector<ModelInfo> listMicro();

/// \param text  `micro:`, a relief's name, then comma-separated key=value
/// Simulates (0.2 to 2 s of one core) and answers from the table: linear between 24² directions a side, held beyond
/// 87°. Measured for the default ridges, against finer settings: facets 0.6 %, table 1.3 % (root mean square). \throws
/// std::invalid_argument for unknown reliefs, parameters, or values out of range; lists the known ones
Reflectance openMicro(const std::string& text, unsigned threads = 0);

}  // namespace nacre
