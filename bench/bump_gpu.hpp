// What shadows cost a bump-mapped surface.
#pragma once

#include "shading/gpu_bump.hpp"
#include "shading/lit_pass.hpp"
#include "shading/program.hpp"

namespace nacre::bench {

/// Frame times as multiples of plain bump mapping's.
struct BumpCost {
    double plainMs = 0;  ///< normals, no shadows
    double smooth = 0;   ///< no relief at all
    double hardEllipse = 0, ellipse = 0;
    double hardHorizon = 0, horizon = 0;  ///< 0 where the maps have no horizons
};

struct BumpFrame {
    int pixels = 384;  ///< edge of the picture
    int lights = 1;
    double tiles = 2;  ///< on a square that fills the picture
    int repeats = 15;
};

/// One interleaved run with Torrance-Sparrow (Beckmann, Smith, dielectric) evaluated in the shader, vectors made per
/// pixel. A context must be current.
BumpCost bumpCost(ProgramLoader& loader, const GpuBump& map, const BumpFrame& frame = {});

}  // namespace nacre::bench
