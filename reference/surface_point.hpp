// Where a ray met a mesh: the frame that the shaders use.
#pragma once

#include "core/scene.hpp"
#include "reference/embree_scene.hpp"

namespace nacre {

/// A point that a ray hit; directions unit, the frame orthonormal.
struct SurfacePoint {
    Vec3 position, normal, tangent, bitangent;
    Vec3 toEye;
    Vec2 uv{0};  ///< (0, 0) where the mesh has none
};

/// n = the interpolated normal, normalised; t = the interpolated tangent made orthogonal to n, or any perpendicular
/// where none is left; b = w · n × t.
SurfacePoint surfaceAt(const Mesh& mesh, const RayHit& hit, const Vec3& toEye);

/// A world direction in the point's frame.
inline Vec3 toLocal(const SurfacePoint& s, const Vec3& v) {
    return {glm::dot(s.tangent, v), glm::dot(s.bitangent, v), glm::dot(s.normal, v)};
}

}  // namespace nacre
