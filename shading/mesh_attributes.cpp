#include "shading/mesh_attributes.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <unordered_map>

#include "core/directions.hpp"
#include "core/error.hpp"

namespace nacre {
namespace {

struct PositionHash {
    std::size_t operator()(const glm::vec3& p) const {
        std::size_t hash = 1469598103934665603u;
        for (int c = 0; c < 3; ++c) {
            const float value = p[c] == 0.0f ? 0.0f : p[c];  // -0 equals 0, so it must hash alike
            std::uint32_t bits = 0;
            std::memcpy(&bits, &value, sizeof(bits));
            hash = (hash ^ bits) * 1099511628211u;
        }
        return hash;
    }
};

/// Number of the first vertex at the same position, for each vertex.
std::vector<std::uint32_t> weldByPosition(const Mesh& mesh) {
    std::unordered_map<glm::vec3, std::uint32_t, PositionHash> first;
    std::vector<std::uint32_t> out;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        out.push_back(first.try_emplace(mesh.positions[i], static_cast<std::uint32_t>(i)).first->second);
    return out;
}

std::array<Vec3, 3> corners(const Mesh& mesh, const glm::uvec3& t) {
    return {Vec3(mesh.positions[t.x]), Vec3(mesh.positions[t.y]), Vec3(mesh.positions[t.z])};
}

}  // namespace

std::size_t removeDegenerateTriangles(Mesh& mesh) {
    const auto count = mesh.positions.size();
    for (const glm::uvec3& t : mesh.triangles)
        require(t.x < count && t.y < count && t.z < count, "removeDegenerateTriangles: vertex index out of range");
    return std::erase_if(mesh.triangles, [&mesh](const glm::uvec3& t) {
        const auto [a, b, c] = corners(mesh, t);
        const Vec3 cross = glm::cross(b - a, c - a);
        // corners are floats: below this share of the edges' product the area is rounding
        return !(glm::length(cross) > 1e-12 * glm::length(b - a) * glm::length(c - a));
    });
}

std::size_t makeNormals(Mesh& mesh) {
    const std::vector<std::uint32_t> welded = weldByPosition(mesh);
    std::vector<Vec3> sums(mesh.positions.size(), Vec3(0));
    for (const glm::uvec3& t : mesh.triangles) {
        const auto p = corners(mesh, t);
        const Vec3 cross = glm::cross(p[1] - p[0], p[2] - p[0]);
        const double length = glm::length(cross);
        if (length == 0) continue;
        for (int k = 0; k < 3; ++k) {
            const Vec3 e = p[(k + 1) % 3] - p[k], f = p[(k + 2) % 3] - p[k];
            sums[welded[t[k]]] += cross / length * angleBetween(glm::normalize(e), glm::normalize(f));
        }
    }
    std::size_t without = 0;
    mesh.normals.resize(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3& sum = sums[welded[i]];
        const double length = glm::length(sum);
        if (length < 1e-9) ++without;  // angles are radians: anything real is far above
        mesh.normals[i] = length < 1e-9 ? glm::vec3(0, 0, 1) : glm::vec3(sum / length);
    }
    return without;
}

bool hasUv(const Mesh& mesh) {
    return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&mesh](const glm::uvec3& t) {
        const Vec2 a(mesh.uvs.at(t.x)), ab = Vec2(mesh.uvs.at(t.y)) - a, ac = Vec2(mesh.uvs.at(t.z)) - a;
        return ab.x * ac.y != ab.y * ac.x;
    });
}

void makeTangents(Mesh& mesh) {
    require(mesh.normals.size() == mesh.positions.size(), "makeTangents: needs a normal for each vertex");
    std::vector<Vec3> sums(mesh.positions.size(), Vec3(0));
    std::vector<double> areas(mesh.positions.size(), 0);
    if (mesh.uvs.size() == mesh.positions.size())
        for (const glm::uvec3& t : mesh.triangles) {
            const auto [a, b, c] = corners(mesh, t);
            const Vec2 s = Vec2(mesh.uvs[t.y]) - Vec2(mesh.uvs[t.x]), r = Vec2(mesh.uvs[t.z]) - Vec2(mesh.uvs[t.x]);
            const double area = s.x * r.y - r.x * s.y;
            if (area == 0) continue;
            const Vec3 dPdu = ((b - a) * r.y - (c - a) * s.y) * (area > 0 ? 1.0 : -1.0);
            for (int k = 0; k < 3; ++k) {
                sums[t[k]] += dPdu;
                areas[t[k]] += area;
            }
        }
    mesh.tangents.resize(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3 n(mesh.normals[i]);
        const Vec3 flat = sums[i] - n * glm::dot(n, sums[i]);
        const double length = glm::length(flat);
        const bool known = length > 1e-6 * glm::length(sums[i]) && length > 0;
        mesh.tangents[i] =
            known ? glm::vec4(glm::vec3(flat / length), areas[i] < 0 ? -1.0f : 1.0f) : tangentAround(mesh.normals[i]);
    }
}

glm::vec4 tangentAround(const glm::vec3& normal) {
    const Vec3 along(normal.z, 0, -normal.x);  // y × n
    const double length = glm::length(along);
    return length < 1e-6 ? glm::vec4(1, 0, 0, 1) : glm::vec4(glm::vec3(along / length), 1.0f);
}

}  // namespace nacre
