#include "bench/shadow_scenes.hpp"

#include <cstdlib>
#include <glm/gtc/matrix_transform.hpp>

#include "core/scene_description.hpp"
#include "shading/mesh_file.hpp"
#include "shading/primitives.hpp"

namespace nacre::bench {

namespace fs = std::filesystem;

namespace {

void append(Mesh& mesh, const Mesh& other) {
    const auto first = static_cast<unsigned>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
    mesh.tangents.insert(mesh.tangents.end(), other.tangents.begin(), other.tangents.end());
    mesh.uvs.insert(mesh.uvs.end(), other.uvs.begin(), other.uvs.end());
    for (const glm::uvec3& t : other.triangles) mesh.triangles.push_back(t + first);
}

/// The mesh stands on y = -1.
ShadowBenchScene onFloor(const std::string& name, Mesh mesh) {
    append(mesh, boxMesh({-5, -1.3, -4}, {5, -1, 4}, 24));
    append(mesh, boxMesh({-5, -1, -2.4}, {5, 3, -2}, 16));
    ShadowBenchScene out{name, std::move(mesh), {}};
    out.camera.eye = {1.2, 1.4, 4.2};
    out.camera.target = {0, -0.2, 0};
    out.camera.fovY = 0.75;
    return out;
}

void stand(Mesh& mesh) {
    fitToBox(mesh, 2);
    float low = 1e9f;
    for (const glm::vec3& p : mesh.positions) low = std::min(low, p.y);
    for (glm::vec3& p : mesh.positions) p.y -= low + 1;
}

}  // namespace

Mesh boxMesh(const Vec3& low, const Vec3& high, int steps) {
    Mesh out;
    const glm::dmat4 place =
        glm::translate(glm::dmat4(1), (low + high) / 2.0) * glm::scale(glm::dmat4(1), (high - low) / 2.0);
    for (int side = 0; side < 6; ++side) {
        const Vec3 axis = side < 4 ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
        const double angle = side < 4 ? side * kPi / 2 : side == 4 ? kPi / 2 : -kPi / 2;
        const glm::dmat4 turn = glm::rotate(glm::dmat4(1), angle, axis) * glm::translate(glm::dmat4(1), Vec3(0, 0, 1));
        append(out, transformed(makeQuad(2, steps), place * turn));
    }
    return out;
}

ShadowBenchScene syntheticShadowScene() {
    Mesh mesh = transformed(makeTorus(0.7f, 0.25f, 96, 48), glm::translate(glm::dmat4(1), Vec3(-0.2, -0.75, 0.3)));
    append(mesh, transformed(makeSphere(0.35f, 96, 48), glm::translate(glm::dmat4(1), Vec3(-0.2, 0, 0.3))));
    for (int i = 0; i < 12; ++i) {
        const double x = 0.9 + 0.08 * i;
        append(mesh, boxMesh({x, -1, -0.5}, {x + 0.015, 0.2, -0.48}, 4));
    }
    return onFloor("synthetic", std::move(mesh));
}

ShadowSceneList shadowScenes() {
    std::vector<fs::path> folders;
    if (const char* named = std::getenv("NACRE_MESHES")) folders.emplace_back(named);
    folders.emplace_back("build/data/meshes");
    return shadowScenes(folders);
}

ShadowSceneList shadowScenes(const std::vector<fs::path>& folders) {
    ShadowSceneList out;
    out.scenes.push_back(syntheticShadowScene());
    for (const auto& [name, file] : {std::pair{"armadillo", "armadillo.off"},
                                     {"bunny", "bunny00.off"},
                                     {"dragon", "ChineseDragon-10kv.off"},
                                     {"elephant", "refined_elephant.off"},
                                     {"camel", "camel.off"}}) {
        bool found = false;
        for (const fs::path& folder : folders) {
            if (found || !fs::exists(folder / file)) continue;
            Mesh mesh = loadMesh(folder / file).mesh;
            stand(mesh);
            out.scenes.push_back(onFloor(name, std::move(mesh)));
            found = true;
        }
        if (!found) out.notes.push_back(std::string("Shadows: no ") + file + "; ./dev gallery fetches it.");
    }
    return out;
}

std::vector<ShadowLight> shadowLights() {
    const Vec3 at(2, 3.2, 2.2), bulb(1.3, 1.6, 1.4);
    const Light spot{false, at, Rgb(1), SpotCone{glm::normalize(Vec3(0, -0.4, 0) - at), 0.35, 0.55}};
    const Light sun{true, glm::normalize(Vec3(0.6, 0.8, 0.55)), Rgb(1)};
    return {{"spot", spot},
            {"sun", sun},
            {"bulb", {false, bulb, Rgb(1)}},
            {"grazing sun", {true, glm::normalize(Vec3(0.8, 0.12, 0.5)), Rgb(1)}},
            {"bulb, paraboloids", {false, bulb, Rgb(1)}, true},
            {"sun, 4 cascades", sun, false, 4}};
}

}  // namespace nacre::bench
