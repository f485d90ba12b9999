#include "shading/hybrid/scene_elements.hpp"

#include <fmt/format.h>

#include <array>

#include "core/error.hpp"

namespace nacre {
namespace {

using Triangle = std::array<Vec3, 3>;

Vec3 areaVector(const Triangle& t) { return 0.5 * glm::cross(t[1] - t[0], t[2] - t[0]); }

/// Halvings until a part is no larger than `largest`: each halves the area exactly.
int halvings(double area, double largest) {
    int out = 0;
    for (; area > largest; area *= 0.5) ++out;
    return out;
}

struct Placed {
    Triangle corners;
    double area;
    std::size_t node;
};

std::vector<Placed> placedTriangles(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes) {
    std::vector<Placed> out;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const SceneNode& node = scene.nodes[i];
        if (node.volume >= 0)
            throw Error(fmt::format("virtual lights: expected meshes alone, found a volume at node '{}'", node.name));
        if (node.mesh < 0) continue;
        const Mesh mesh = transformed(scene.meshes.at(static_cast<std::size_t>(node.mesh)).mesh, nodes.at(i));
        for (const glm::uvec3& t : mesh.triangles) {
            const Triangle corners{Vec3(mesh.positions[t.x]), Vec3(mesh.positions[t.y]), Vec3(mesh.positions[t.z])};
            const double area = glm::length(areaVector(corners));
            if (area > 0) out.push_back({corners, area, i});
        }
    }
    return out;
}

void split(const Triangle& t, int times, SceneElements& out, SceneElement element) {
    if (times > 0) {
        std::size_t longest = 0;  // of the edges from corner i to the next
        for (std::size_t i = 1; i < 3; ++i)
            if (glm::length(t[(i + 1) % 3] - t[i]) > glm::length(t[(longest + 1) % 3] - t[longest])) longest = i;
        const Vec3 a = t[longest], b = t[(longest + 1) % 3], c = t[(longest + 2) % 3], middle = 0.5 * (a + b);
        split({a, middle, c}, times - 1, out, element);
        split({middle, b, c}, times - 1, out, element);
        return;
    }
    element.centre = (t[0] + t[1] + t[2]) / 3.0;
    element.area = glm::length(areaVector(t));
    element.normal = areaVector(t) / element.area;
    for (const Vec3& corner : t) {
        out.corners.emplace_back(corner);
        out.bounds.add(corner);
    }
    out.elements.push_back(element);
}

}  // namespace

SceneElements sceneElements(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes,
                            std::span<const Rgb> albedos, const ElementOptions& options) {
    require(albedos.size() == scene.materials.size(), "elements: expected an albedo for each material");
    require(options.least >= 1 && options.bits >= 1 && options.bits <= 32,
            "elements: expected least >= 1, bits 1 to 32");
    for (const Rgb& a : albedos)
        for (int c = 0; c < 3; ++c) require(a[c] >= 0 && a[c] <= 1, "elements: an albedo must be in [0, 1]");
    const std::vector<Placed> triangles = placedTriangles(scene, nodes);
    double area = 0;
    for (const Placed& p : triangles) area += p.area;
    const double largest = area / options.least, most = std::pow(2.0, options.bits) - 1;  // 0: nothing is there
    double count = 0;
    for (const Placed& p : triangles) count += std::pow(2.0, halvings(p.area, largest));
    if (count > most)
        throw Error(fmt::format("item buffer: expected at most {:.0f} elements, which {} bits tell apart, found {:.0f}",
                                most, options.bits, count));
    SceneElements out;
    for (const Placed& p : triangles) {
        SceneElement element;
        element.node = p.node;
        element.albedo = albedos[static_cast<std::size_t>(scene.nodes[p.node].material)];
        split(p.corners, halvings(p.area, largest), out, element);
    }
    return out;
}

}  // namespace nacre
