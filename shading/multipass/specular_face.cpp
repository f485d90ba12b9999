#include "shading/multipass/specular_face.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/error.hpp"

namespace nacre {
namespace {

/// Single precision, and what exporters round.
constexpr double kFlat = 1e-4, kFlatUv = 1e-3;

double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

/// Counter-clockwise (Andrew's monotone chain).
std::vector<Vec2> convexHull(std::vector<Vec2> points) {
    std::sort(points.begin(), points.end(),
              [](const Vec2& a, const Vec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    std::vector<Vec2> hull;
    for (int half = 0; half < 2; ++half) {
        const std::size_t first = hull.size();
        for (const Vec2& p : points) {
            while (hull.size() >= first + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
                hull.pop_back();
            hull.push_back(p);
        }
        hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    return hull;
}

struct MeshPlane {
    Plane plane{0};
    double off = 0, size = 0;  ///< the farthest vertex from the plane; of the box
    bool hasArea = false;
};

/// That of the largest triangle.
MeshPlane planeOf(const std::vector<Vec3>& points, const std::vector<glm::uvec3>& triangles) {
    MeshPlane out;
    Vec3 largest(0), corner(0);
    for (const glm::uvec3& t : triangles) {
        const Vec3 n = glm::cross(points[t.y] - points[t.x], points[t.z] - points[t.x]);
        if (glm::dot(n, n) > glm::dot(largest, largest)) largest = n, corner = points[t.x];
    }
    for (const Vec3& p : points) out.size = std::max(out.size, glm::length(p - points[0]));
    out.hasArea = glm::length(largest) > 1e-12 * out.size * out.size;
    if (!out.hasArea) return out;
    const Vec3 n = glm::normalize(largest);
    out.plane = Plane(n, -glm::dot(n, corner));
    for (const Vec3& p : points) out.off = std::max(out.off, std::abs(glm::dot(out.plane, Vec4(p, 1))));
    return out;
}

std::vector<Vec3> placed(const Mesh& mesh, const glm::dmat4& toWorld) {
    std::vector<Vec3> out;
    for (const glm::vec3& p : mesh.positions) out.push_back(Vec3(toWorld * Vec4(p, 1)));
    return out;
}

std::vector<Vec3> outlineOf(const std::vector<Vec3>& points, const Plane& plane) {
    const Vec3 n(plane), x = glm::normalize(glm::cross(std::abs(n.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0), n)),
                         y = glm::cross(n, x);
    std::vector<Vec2> flat;
    for (const Vec3& p : points) flat.emplace_back(glm::dot(x, p), glm::dot(y, p));
    std::vector<Vec3> out;
    for (const Vec2& p : convexHull(std::move(flat))) out.push_back(p.x * x + p.y * y - plane.w * n);
    return out;
}

const SceneMaterial* specularMaterial(const SceneDescription& scene, const SceneNode& node) {
    if (node.material < 0) return nullptr;
    const SceneMaterial& material = scene.materials[static_cast<std::size_t>(node.material)];
    return material.specular ? &material : nullptr;
}

}  // namespace

Vec3 SpecularFace::centre() const {
    return std::accumulate(outline.begin(), outline.end(), Vec3(0)) / static_cast<double>(outline.size());
}

double twiceArea(const std::vector<Vec2>& p) {
    double sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i) sum += cross(p[i], p[(i + 1) % p.size()]);
    return sum;
}

std::vector<SpecularFace> specularFaces(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes) {
    std::vector<SpecularFace> out;
    const std::vector<glm::vec4> rects = faceImageRects(scene);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const SceneMaterial* material = specularMaterial(scene, scene.nodes[i]);
        if (!material || scene.nodes[i].mesh < 0) continue;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(scene.nodes[i].mesh)].mesh;
        const std::vector<Vec3> points = placed(mesh, nodes[i]);
        MeshPlane flat = planeOf(points, mesh.triangles);
        if (!flat.hasArea) continue;
        if (glm::determinant(glm::dmat3(nodes[i])) < 0) flat.plane = -flat.plane;
        out.push_back({i, flat.plane, outlineOf(points, flat.plane), *material->specular});
        const glm::vec4& rect = rects[static_cast<std::size_t>(scene.nodes[i].material)];
        if (rect.z == 0) continue;
        out.back().image = faceImage(points, mesh);
        out.back().image.rect = rect;
    }
    return out;
}

bool hasSpecular(const SceneDescription& scene) {
    return std::any_of(scene.nodes.begin(), scene.nodes.end(),
                       [&](const SceneNode& node) { return specularMaterial(scene, node) != nullptr; });
}

/// Of a material's own.
static void checkMaterial(const SceneMaterial& m, const SceneSpecular& s) {
    require(isFinite(s.reflection) && isFinite(s.transmission) && s.surface >= 0 && s.surface <= 1 &&
                (!s.ior || (std::isfinite(*s.ior) && *s.ior > 0)) && isFinite(s.fog) && std::isfinite(s.fogDistance) &&
                s.fogDistance >= 0 && std::isfinite(s.spread) && s.spread >= 0 && std::isfinite(s.roughness) &&
                s.roughness >= 0 && (s.spread == 0 || s.roughness == 0),
            "material '" + m.name +
                "': specular: expected finite factors, surface in [0, 1], ior > 0, fogDistance, spread and "
                "roughness >= 0, "
                "one of the last two");
    require(!s.texture || (s.texture->channels() == 4 && s.texture->width() > 0),
            "material '" + m.name + "': specular: expected a texture of 4 channels");
    require(!s.filter || (s.filter->channels() == 4 && s.filter->width() > 0),
            "material '" + m.name + "': specular: expected a filter of 4 channels");
    if (s.filter && s.texture && (s.filter->width() != s.texture->width() || s.filter->height() != s.texture->height()))
        throw Error(
            fmt::format("material '{}': specular: expected a filter of the texture's size, {} x {}, found "
                        "{} x {}",
                        m.name, s.texture->width(), s.texture->height(), s.filter->width(), s.filter->height()));
    if (s.texture && m.relief)
        throw Error(fmt::format("material '{}': specular: expected a texture or a relief, found both", m.name));
}

/// The picture of a face, if there is one.
static void checkImage(const SceneDescription& scene, const SceneNode& node, const SceneMaterial& material) {
    if (node.mesh < 0 || (!material.specular->texture && !material.specular->filter)) return;
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)].mesh;
    const std::vector<Vec3> points = placed(mesh, glm::dmat4(1));
    if (!planeOf(points, mesh.triangles).hasArea) return;
    const double off = faceImage(points, mesh).off;
    if (off > kFlatUv)
        throw Error(
            fmt::format("node '{}': expected uv that are an affine map of the face, for the picture of the "
                        "specular material '{}', found a vertex {:g} off",
                        node.name, material.name, off));
}

void checkPlanarFaces(const SceneDescription& scene) {
    for (const SceneNode& node : scene.nodes) {
        const SceneMaterial* material = specularMaterial(scene, node);
        if (!material) continue;
        const std::string where = fmt::format(
            "node '{}': expected a planar mesh for the specular material '{}', found ", node.name, material->name);
        if (node.volume >= 0) throw Error(where + "a volume");
        if (node.mesh < 0) continue;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)].mesh;
        const MeshPlane flat = planeOf(placed(mesh, glm::dmat4(1)), mesh.triangles);
        if (flat.off > kFlat * flat.size) throw Error(fmt::format("{}a vertex {:g} off its plane", where, flat.off));
    }
}

void checkSpecular(const SceneDescription& scene) {
    for (const SceneMaterial& m : scene.materials)
        if (m.specular) checkMaterial(m, *m.specular);
    checkPlanarFaces(scene);
    for (const SceneNode& node : scene.nodes)
        if (const SceneMaterial* material = specularMaterial(scene, node)) checkImage(scene, node, *material);
}

}  // namespace nacre
