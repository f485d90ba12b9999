#include "reference/scene_rays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/error.hpp"

namespace nacre {
namespace {

void checkMesh(const Mesh& mesh, const std::string& name) {
    const std::size_t n = mesh.positions.size();
    require(mesh.normals.size() == n && mesh.tangents.size() == n && mesh.uvs.size() == n,
            fmt::format("traceScene: mesh '{}' needs a normal, a tangent and a uv for each position", name));
    for (const glm::vec3& p : mesh.positions)
        require(isFinite(Vec3(p)), fmt::format("traceScene: mesh '{}': a position is not finite", name));
}

void append(Mesh& mesh, const Mesh& part) {
    const auto first = static_cast<unsigned>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
    mesh.normals.insert(mesh.normals.end(), part.normals.begin(), part.normals.end());
    mesh.tangents.insert(mesh.tangents.end(), part.tangents.begin(), part.tangents.end());
    mesh.uvs.insert(mesh.uvs.end(), part.uvs.begin(), part.uvs.end());
    for (const glm::uvec3& t : part.triangles) mesh.triangles.push_back(t + first);
}

}  // namespace

SceneRays::World::World(const SceneDescription& scene, const std::vector<glm::dmat4>& transforms, bool castersAlone) {
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].mesh < 0 || (castersAlone && !scene.nodes[i].castsShadow)) continue;
        const SceneMesh& part = scene.meshes.at(static_cast<std::size_t>(scene.nodes[i].mesh));
        checkMesh(part.mesh, part.name);
        firstTriangle.push_back(mesh.triangles.size());
        nodes.push_back(i);
        append(mesh, transformed(part.mesh, transforms[i]));
    }
}

std::size_t SceneRays::World::nodeOf(std::uint32_t triangle) const {
    const auto after = std::upper_bound(firstTriangle.begin(), firstTriangle.end(), std::size_t{triangle});
    return nodes[static_cast<std::size_t>(after - firstTriangle.begin()) - 1];
}

SceneRays::SceneRays(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes)
    : world_(scene, nodes, false), all_(world_.mesh), casters_(World(scene, nodes, true).mesh) {
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].volume < 0) continue;
        const SceneVolume& volume = scene.volumes.at(static_cast<std::size_t>(scene.nodes[i].volume));
        volumes_.push_back({i, scene.nodes[i].castsShadow, VolumeField({*volume.volume, volume.iso, nodes[i]})});
    }
}

Vec3 SceneRays::World::normalOf(std::uint32_t triangle) const {
    const glm::uvec3& t = mesh.triangles[triangle];
    const Vec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    const Vec3 n = glm::cross(b - a, c - a);
    return glm::dot(n, n) > 0 ? glm::normalize(n) : n;
}

std::optional<SceneRays::Hit> SceneRays::firstHit(const Ray& ray, const Vec3& toEye) const {
    const RayHit onMesh = all_.firstHit(ray);
    Ray rest = ray;
    if (onMesh.found) rest.far = onMesh.t;
    const PlacedVolume* nearest = nullptr;
    for (const PlacedVolume& volume : volumes_)
        if (const auto t = volume.field.firstInside(rest)) {
            rest.far = *t;
            nearest = &volume;
        }
    if (nearest) return Hit{nearest->field.at(ray.origin + rest.far * ray.direction, toEye), nearest->node, Vec3(0)};
    if (onMesh.found)
        return Hit{surfaceAt(world_.mesh, onMesh, toEye), world_.nodeOf(onMesh.triangle),
                   world_.normalOf(onMesh.triangle)};
    return {};
}

bool SceneRays::insideVolume(const Vec3& position, const Vec3& direction, double distance, bool castersAlone) const {
    return std::any_of(volumes_.begin(), volumes_.end(), [&](const PlacedVolume& volume) {
        return (volume.casts || !castersAlone) &&
               volume.field.firstInside({position, direction, volume.field.skip(direction), distance});
    });
}

bool SceneRays::shadowed(const Vec3& position, const Vec3& direction, double distance) const {
    const double end = std::min(distance - skip(), double(std::numeric_limits<float>::max()));
    return casters_.occluded({position, direction, skip(), end}) || insideVolume(position, direction, distance, true);
}

bool SceneRays::blocked(const Vec3& position, const Vec3& direction) const {
    return all_.occluded({position, direction, skip(), std::numeric_limits<float>::max()}) ||
           insideVolume(position, direction, std::numeric_limits<double>::max(), false);
}

}  // namespace nacre
