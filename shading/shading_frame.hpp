// The shading frame of a surface point in C++: what shaders/nacre/frame.glsl computes.
#pragma once

#include "core/math.hpp"

namespace nacre {

/// Columns tangent, bitangent, normal; orthonormal. \param normal  interpolated, any length > 0
/// \param tangent  interpolated xyz, made orthogonal to the normal (Gram–Schmidt), and w: bitangent =
///                 sign(w) · cross(normal, tangent). Where no tangent is left any perpendicular serves.
Mat3 shadingFrame(const Vec3& normal, const Vec4& tangent);

/// The frame of a bumped normal, given in `mesh` = shadingFrame(…) with that handedness. A normal that faces away from
/// a viewer who sees the surface is tilted towards them until n·v is about min(mesh n·v, 0.05); seen from behind,
/// `mesh` stays. \param normal, toEye  unit; the second in the world.  Twin: nacre_bump_frame (shaders/nacre/bump.glsl)
Mat3 bumpedFrame(const Mat3& mesh, double handedness, const Vec3& normal, const Vec3& toEye);

}  // namespace nacre
