// nacre eval for the tables that nacre fresnel writes.
#pragma once

#include <string>

#include "core/asset.hpp"

namespace nacre::cli {

bool isTable(const Asset& asset);  ///< of kind fresnel or scale_bias

/// What a shader fetches, for each line of standard input. fresnel: cos in, r,g,b out; scale_bias: cos,roughness in
/// (the perceptual one, √alpha), scale,bias out. \throws nacre::Error "standard input: line N: expected …, found …", or
/// naming the file when its texture isn't the kind's
void evalTable(const Asset& asset, const std::string& file);

}  // namespace nacre::cli
