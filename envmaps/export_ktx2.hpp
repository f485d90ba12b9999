// Cube maps for engines: KTX 2.0.
#pragma once

#include <span>
#include <string>

#include "envmaps/export_cube.hpp"

namespace nacre {

/// A KTX 2.0 file (Khronos, "KTX File Format Specification", version 2.0): VK_FORMAT_R16G16B16A16_SFLOAT, six faces,
/// all levels in one file, no supercompression. Faces lie as OpenGL, Vulkan and Direct3D look them up, so that a
/// lookup with the direction (x, y, z) of our right-handed, y-up world finds that direction's radiance; an engine
/// with a left-handed world has to negate one axis as it does with every other direction. Metadata: KTXorientation
/// rd, KTXwriter, and `nacre` with JSON {"scale": S}: radiance = S · texel.
/// \param levels  cubes, finest first, each half as large as the one before
/// \throws std::invalid_argument on other levels; StorageError on values that half floats can't hold
std::string ktx2Bytes(std::span<const EnvMap> levels, const CubeExport& options = {});

}  // namespace nacre
