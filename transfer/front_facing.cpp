#include "transfer/front_facing.hpp"

#include "core/error.hpp"

namespace nacre {

std::vector<std::uint8_t> frontFacing(const WeldedMesh& mesh, std::span<const glm::vec3> positions, const Vec3& eye) {
    require(positions.size() == mesh.vertexCount(), "front-facing vertices: expected one position a vertex");
    std::vector<std::uint8_t> out(positions.size(), 0);
    for (const glm::uvec3& t : mesh.triangles) {
        const Vec3 a = positions[t.x], b = positions[t.y], c = positions[t.z];
        if (glm::dot(glm::cross(b - a, c - a), eye - a) > 0) out[t.x] = out[t.y] = out[t.z] = 1;
    }
    return out;
}

}  // namespace nacre
