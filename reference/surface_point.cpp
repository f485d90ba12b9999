#include "reference/surface_point.hpp"

namespace nacre {
namespace {

template <typename T>
T interpolate(const std::vector<T>& values, const glm::uvec3& triangle, const Vec3& weight) {
    return T(static_cast<float>(weight.x)) * values[triangle.x] + T(static_cast<float>(weight.y)) * values[triangle.y] +
           T(static_cast<float>(weight.z)) * values[triangle.z];
}

Vec3 anyPerpendicular(const Vec3& n) {
    return glm::normalize(glm::cross(n, std::abs(n.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
}

}  // namespace

SurfacePoint surfaceAt(const Mesh& mesh, const RayHit& hit, const Vec3& toEye) {
    const glm::uvec3& triangle = mesh.triangles[hit.triangle];
    const Vec3 weight(1 - hit.u - hit.v, hit.u, hit.v);
    const glm::vec4 tangent = interpolate(mesh.tangents, triangle, weight);
    SurfacePoint s;
    s.toEye = toEye;
    s.position = Vec3(interpolate(mesh.positions, triangle, weight));
    s.normal = glm::normalize(Vec3(interpolate(mesh.normals, triangle, weight)));
    const Vec3 across = Vec3(tangent) - glm::dot(Vec3(tangent), s.normal) * s.normal;
    // Interpolated tangents may cancel or meet the normal: any tangent then, as good as none.
    s.tangent = glm::length(across) > 1e-9 ? glm::normalize(across) : anyPerpendicular(s.normal);
    s.bitangent = (tangent.w < 0 ? -1.0 : 1.0) * glm::cross(s.normal, s.tangent);
    if (mesh.uvs.size() == mesh.positions.size()) s.uv = Vec2(interpolate(mesh.uvs, triangle, weight));
    return s;
}

}  // namespace nacre
