// PR94's map of the refracted picture of a face onto its picture before (equations 1 to 5, A1 to A5).
#pragma once

#include <array>

#include "core/math.hpp"

namespace nacre {

/// The corners of a quadrilateral, one after the other around it.
using Quad = std::array<Vec2, 4>;

/// The plane projective map (column vectors, homogeneous) of the unit square onto a quadrilateral: (0,0), (1,0), (1,1)
/// and (0,1) become its corners. Heckbert 1989, as A2 to A4 have it; the text lost signs and indices there:
///   Σ = p0 − p1 + p2 − p3,  Δ1 = p1 − p2,  Δ2 = p3 − p2,
///   g = |Σ Δ2| / |Δ1 Δ2|,  h = |Δ1 Σ| / |Δ1 Δ2|,
///   columns  (p1 − p0 + g p1, g),  (p3 − p0 + h p3, h),  (p0, 1).
/// \throws std::invalid_argument for a degenerate quadrilateral: three corners on one line
glm::dmat3 squareToQuad(const Quad& quad);

/// Of one quadrilateral onto another (A1): square-to-quad after the adjoint of the other's.
/// \throws as above
glm::dmat3 quadToQuad(const Quad& from, const Quad& to);

/// The same for clip coordinates, depths cleared: x, y and w are mapped, z becomes 0 (A5).
glm::dmat4 flatteningMap(const glm::dmat3& map);

}  // namespace nacre
