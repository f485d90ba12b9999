// The shading frame of a surface point in C++: what shaders/nacre/frame.glsl computes.
#pragma once

#include "core/math.hpp"

namespace nacre {

/// Columns tangent, bitangent, normal; orthonormal. \param normal  interpolated, any length > 0
/// \param tangent  interpolated xyz, made orthogonal to the normal (Gram–Schmidt), and w: bitangent =
///                 sign(w) · cross(normal, tangent). Where no tangent is left any perpendicular serves.
Mat3 shadingFrame(const Vec3& normal, const Vec4& tangent);

}  // namespace nacre
