#include "hybrid_fixture.hpp"

#include <fmt/format.h>

#include "factorize/models/models.hpp"
#include "shading/primitives.hpp"

namespace nacre::test {

int addWhite(SceneDescription& scene, double albedo) {
    SceneMaterial& m = scene.materials.emplace_back();
    m.model = fmt::format("lambert:kd={}", albedo);
    m.name = std::to_string(albedo);
    return static_cast<int>(scene.materials.size()) - 1;
}

SceneDescription emptyRoom() {
    SceneDescription scene;
    addWhite(scene, 0.5);
    return scene;
}

std::size_t addSquare(SceneDescription& scene, double half, const Vec3& at, const Vec3& normal, int material) {
    scene.meshes.push_back({"square", makeQuad(static_cast<float>(2 * half), 1)});
    SceneNode& node = scene.nodes.emplace_back();
    node.name = fmt::format("square {}", scene.nodes.size());
    node.mesh = static_cast<int>(scene.meshes.size()) - 1;
    node.material = material;
    node.translation = at;
    const Vec3 axis = glm::cross(Vec3(0, 0, 1), normal);
    node.rotation = glm::length(axis) > 1e-9 ? glm::angleAxis(std::acos(normal.z), glm::normalize(axis))
                                             : glm::angleAxis(normal.z < 0 ? kPi : 0, Vec3(1, 0, 0));
    return scene.nodes.size() - 1;
}

void addLight(SceneDescription& scene, const Light& light, bool shadow) {
    SceneLight& added = scene.lights.emplace_back();
    added.light = light;
    if (shadow) added.shadow = SceneShadow{};
}

std::vector<Rgb> albedos(const SceneDescription& scene) {
    std::vector<Rgb> out;
    for (const SceneMaterial& m : scene.materials) out.emplace_back(m.specular ? 0.0 : std::stod(m.name));
    return out;
}

HybridMaterials materialsOf(const SceneDescription& scene) {
    HybridMaterials out;
    out.albedos = albedos(scene);
    for (const SceneMaterial& m : scene.materials)
        out.brdfs.push_back(m.model.empty() ? BrdfFunction() : makeModel(m.model).f);
    return out;
}

}  // namespace nacre::test
