#include "core/version.hpp"

namespace nacre {

std::string nacreVersion() { return NACRE_VERSION; }

}  // namespace nacre
