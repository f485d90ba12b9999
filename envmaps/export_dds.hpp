// Cube maps for engines: DirectDraw Surface.
#pragma once

#include <span>
#include <string>

#include "envmaps/export_cube.hpp"

namespace nacre {

/// A DDS file with the DX10 header (Microsoft, "Programming Guide for DDS"): DXGI_FORMAT_R16G16B16A16_FLOAT, cube,
/// all faces +X −X +Y −Y +Z −Z, each with all its levels, finest first. Faces and directions as in ktx2Bytes. DDS has
/// no room for words: the float `scale` (radiance = scale · texel) is in dwReserved1[0] after the mark "NCRE" in
/// dwReserved1[1].
/// \throws as ktx2Bytes
std::string ddsBytes(std::span<const EnvMap> levels, const CubeExport& options = {});

}  // namespace nacre
