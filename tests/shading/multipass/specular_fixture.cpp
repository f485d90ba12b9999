#include "tests/shading/multipass/specular_fixture.hpp"

#include "shading/primitives.hpp"

namespace nacre::test {

SpecularScene::SpecularScene() { scene.meshes = {{"square", makeQuad(2)}, {"ball", makeSphere(1, 32, 16)}}; }

SceneNode& SpecularScene::add(const std::string& name, int mesh, int material, const Vec3& at, double angle,
                              const Vec3& axis, const Vec3& scale) {
    SceneNode node;
    node.name = name;
    node.mesh = mesh;
    node.material = material;
    node.translation = at;
    node.rotation = glm::angleAxis(angle, glm::normalize(axis));
    node.scale = scale;
    return scene.nodes.emplace_back(node);
}

int SpecularScene::colored(const Rgb& color) {
    SceneMaterial material;
    material.ambient = color;
    scene.materials.push_back(material);
    return static_cast<int>(scene.materials.size()) - 1;
}

SceneNode& SpecularScene::face(const std::string& name, const SceneSpecular& specular, const Vec3& at, double angle,
                               const Vec3& axis, const Vec3& scale) {
    const int material = colored(Rgb(0));
    scene.materials.back().specular = specular;
    return add(name, 0, material, at, angle, axis, scale);
}
SceneNode& SpecularScene::ball(const Rgb& color, const Vec3& at, double radius) {
    return add("ball", 1, colored(color), at, 0, {0, 1, 0}, Vec3(radius));
}
SceneNode& SpecularScene::square(const Rgb& color, const Vec3& at, double angle, const Vec3& axis, const Vec3& scale) {
    return add("square", 0, colored(color), at, angle, axis, scale);
}

SceneDescription hallOfMirrors() {
    SpecularScene s;
    s.face("far", {}, {0, 0, -3}, 0, {0, 1, 0}, Vec3(2));
    s.face("near", {}, {0, 0, 4}, kPi - 0.05, {0, 1, 0}, Vec3(2));
    s.ball({1, 0.1, 0.1}, {-0.8, 0, 0});
    s.ball({0.1, 1, 0.1}, {0.7, 0.5, -1.5});
    s.ball({0.2, 0.2, 1}, {0.4, -0.6, 1.5}, 0.2);
    s.square({0.8, 0.7, 0.2}, {0, -1.5, 0}, -kPi / 2, {1, 0, 0}, Vec3(1.5));
    s.square({0.5, 0.1, 0.6}, {-1.9, 0, 0}, kPi / 2, {0, 1, 0}, Vec3(1.2));
    s.scene.sky.color = {0.05, 0.3, 0.35};
    return s.scene;
}

SceneDescription paneScene(double ior, bool partial, double angle) {
    SpecularScene s;
    SceneSpecular pane;
    pane.ior = ior;
    pane.partial = partial;
    s.face("pane", pane, {0, 0, 0}, angle, {0, 1, 0}, Vec3(0.8));
    for (int i = 0; i < 36; ++i) {
        const int x = i % 6, y = i / 6;
        s.square((x + y) % 2 ? Rgb(0.1, 0.2 + 0.1 * x, 0.9) : Rgb(0.9, 0.3, 0.1 + 0.1 * y),
                 {1.0 * x - 2.5, 1.0 * y - 2.5, -2}, 0, {0, 1, 0}, Vec3(0.5));
    }
    s.ball({0.2, 0.9, 0.2}, {0.3, -0.2, -1}, 0.25);
    s.ball({0.9, 0.9, 0.2}, {-1.2, 0.4, 0.4}, 0.2);
    s.scene.sky.color = {0.3, 0.3, 0.3};
    return s.scene;
}

}  // namespace nacre::test
