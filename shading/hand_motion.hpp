// A motion for rigged hands that come without one.
#pragma once

#include "shading/rig.hpp"

namespace nacre {

inline constexpr char kCurlClip[] = "nacre-curl";

/// Adds the clip "nacre-curl", made up by nacre, to a hand without clips whose joints have the names and frames of
/// WebXR's hands (bones along −z, backs of fingers +y): every finger joint bends about its x axis and back, so that the
/// hand closes and opens once in two seconds. Other rigs are left as they are. \return whether it did
bool addCurl(Rig& rig);

}  // namespace nacre
