// The Utah teapot (Newell, "The Utilization of Procedure Models in Digital Image Synthesis", PhD thesis, Utah 1975):
// bicubic Bézier patches with analytic normals, for scenes that must not depend on a downloaded mesh.
#pragma once

#include "core/scene.hpp"

namespace nacre {

/// The 32 patches, lid and bottom included, with Newell's proportions: y up, the bottom's centre at the origin, 3.15
/// high, handle towards −x, spout towards +x. The parts are not joined (handle and spout run into the body), as in the
/// original. Tangents follow the patches' u direction: around the pot's axis, and around handle and spout.
/// Normals are exact; they exist at the poles of lid and bottom too, where ∂P/∂u vanishes.
/// \param segments  edges of a patch along each direction, ≥ 1; 10 gives 6400 triangles less the poles' degenerate ones
/// \throws std::invalid_argument when segments < 1
Mesh makeTeapot(int segments = 10);

}  // namespace nacre
