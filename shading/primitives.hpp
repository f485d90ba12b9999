// Meshes made from formulas, with exact normals and tangents: the shapes of HSE figures 2 and 3.
#pragma once

#include "core/scene.hpp"

namespace nacre {

/// The way the tangent runs, which is the way grooves run on an anisotropic surface (HSE figure 3).
/// Circular: around the shape's axis. Radial: from the axis (or pole) outwards. Both with w = 1.
enum class TangentDirection { Circular, Radial };

/// All throw std::invalid_argument when a count is below its least or a length is not finite and > 0.
/// Triangles are counter-clockwise from outside; none is degenerate.

/// About the y axis: circle of radius `ring` swept by a tube of radius `tube` [world units]. rings >= 3 steps around
/// the axis, sides >= 3 around the tube. Circular: along the sweep; radial: around the tube.
Mesh makeTorus(float ring = 1.0f, float tube = 0.4f, int rings = 200, int sides = 200,
               TangentDirection tangents = TangentDirection::Circular);

/// About the origin, poles on the y axis. segments >= 3 around it, stacks >= 2 from pole to pole. Circular: along the
/// parallels, t = normalize(y × n), uv.x running with it; radial: along the meridians, away from the north pole. The
/// poles' vertices are one a segment, so that each has a tangent.
Mesh makeSphere(float radius = 1.0f, int segments = 128, int stacks = 64,
                TangentDirection tangents = TangentDirection::Circular);

/// In the plane z = 0, facing +z, centre at the origin; rings >= 1, segments >= 3. Circular: around the centre,
/// counter-clockwise; radial: away from it.
Mesh makeDisk(float radius = 1.0f, int segments = 128, int rings = 32,
              TangentDirection tangents = TangentDirection::Circular);

/// Square of edge `size` in the plane z = 0, facing +z, tangent +x, in steps × steps squares (steps >= 1).
Mesh makeQuad(float size = 2.0f, int steps = 1);

}  // namespace nacre
