#include "demos/stage.hpp"

#include <fmt/format.h>

#include <glm/gtc/matrix_transform.hpp>

#include "core/error.hpp"
#include "demos/teapot.hpp"
#include "shading/mesh_file.hpp"
#include "shading/primitives.hpp"

namespace nacre {
namespace {

/// \param motion  rotation and translation only
void move(Mesh& mesh, const glm::mat4& motion) {
    const glm::mat3 turn(motion);
    for (glm::vec3& p : mesh.positions) p = glm::vec3(motion * glm::vec4(p, 1));
    for (glm::vec3& n : mesh.normals) n = turn * n;
    for (glm::vec4& t : mesh.tangents) t = glm::vec4(turn * glm::vec3(t), t.w);
}

/// Tangents along `direction`, projected into the surface; where the normal is parallel to it, the old one stays.
void combTangents(Mesh& mesh, const glm::vec3& direction) {
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        const glm::vec3 n = mesh.normals[i], t = direction - n * dot(n, direction);
        if (dot(t, t) > 1e-8f) mesh.tangents[i] = glm::vec4(normalize(t), 1);
    }
}

Light directional(double azimuthDeg, double elevationDeg, const Rgb& irradiance) {
    return {true, directionFromDeg(azimuthDeg, elevationDeg), irradiance};
}

Camera perspective(double azimuthDeg, double elevationDeg, double distance, double fovY) {
    Camera camera;
    camera.eye = distance * directionFromDeg(azimuthDeg, elevationDeg);
    camera.fovY = fovY;
    camera.near = distance - 3;
    camera.far = distance + 3;
    return camera;
}

/// Key from the upper left, cool fill from the right, a low light from below, and two rims from behind; azimuths
/// relative to the camera's.
std::vector<Light> studioLights(double az) {
    return {directional(az - 40, 38, {2.6, 2.5, 2.35}), directional(az + 55, 18, {0.75, 0.85, 1.0}),
            directional(az - 10, -35, {0.3, 0.29, 0.28}), directional(az + 145, 30, {1.9, 1.95, 2.0}),
            directional(az - 140, 25, {1.5, 1.45, 1.4})};
}

constexpr const char* kStudioWords = "five directional lights: key, fill, one from below, two rims; perspective";

/// How a scan must be turned to stand upright (about x), and from where it is seen.
struct Scan {
    const char* name;
    double pitchDeg, azimuthDeg, elevationDeg;
};
const Scan kScans[] = {{"armadillo", 0, 205, 8}, {"bunny00", 0, -32, 12},        {"ChineseDragon-10kv", -22, 38, 8},
                       {"lion-head", 0, 28, 2},  {"refined_elephant", 0, 30, 8}, {"camel", 0, 62, 6}};

std::string scanNames() {
    std::string names;
    for (const Scan& scan : kScans) names += (names.empty() ? "" : ", ") + std::string(scan.name);
    return names;
}

}  // namespace

Mesh joined(Mesh a, const Mesh& b) {
    const unsigned first = static_cast<unsigned>(a.positions.size());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    a.normals.insert(a.normals.end(), b.normals.begin(), b.normals.end());
    a.tangents.insert(a.tangents.end(), b.tangents.begin(), b.tangents.end());
    a.uvs.insert(a.uvs.end(), b.uvs.begin(), b.uvs.end());
    for (const glm::uvec3& t : b.triangles) a.triangles.push_back(t + first);
    return a;
}

Vec3 directionFromDeg(double azimuthDeg, double elevationDeg) {
    const double az = azimuthDeg * kPi / 180, el = elevationDeg * kPi / 180;
    return {std::sin(az) * std::cos(el), std::sin(el), std::cos(az) * std::cos(el)};
}

Stage torusStage() {
    Stage stage;
    stage.mesh = makeTorus(1.0f, 0.42f, 200, 200);
    stage.camera.eye = 4.0 * directionFromDeg(0, 42);
    stage.camera.orthographic = true;
    stage.camera.height = 3.3;
    stage.lights = {directional(-38, 40, Rgb(kPi))};
    stage.words = "torus of 200 × 200 quadrilaterals; one directional light; orthographic camera";
    return stage;
}

Stage diskAndSphereStage(GrooveDirection grooves) {
    const TangentDirection way =
        grooves == GrooveDirection::Circular ? TangentDirection::Circular : TangentDirection::Radial;
    Mesh disk = makeDisk(1.0f, 256, 64, way), sphere = makeSphere(1.0f, 192, 96, way);
    move(disk, glm::translate(glm::mat4(1), {-1.06f, 0, 0}));
    // The sphere's pole leans towards the camera.
    move(sphere, glm::translate(glm::mat4(1), {1.06f, 0, 0}) * glm::rotate(glm::mat4(1), 0.45f, {1, 0, 0}));
    Stage stage;
    stage.mesh = joined(std::move(disk), sphere);
    stage.camera = perspective(0, 6, 8, 0.285);
    stage.aspect = 2;
    stage.lights = {{false, {-0.6, 2.0, 4.0}, Rgb(50)}};
    stage.words = "disk and sphere; one point light above the camera; perspective";
    return stage;
}

Stage teapotStage(double azimuthDeg) {
    Stage stage;
    stage.mesh = makeTeapot(16);
    move(stage.mesh, glm::translate(glm::mat4(1), {-0.2f, -1.5f, 0}));
    combTangents(stage.mesh, {1, 0, 0});
    stage.camera = perspective(azimuthDeg, 22, 14, 0.35);
    stage.aspect = 1.4;
    stage.camera.near = 5;
    stage.camera.far = 25;
    stage.lights = {directional(azimuthDeg - 25, 45, Rgb(2.4)), directional(azimuthDeg + 25, 45, Rgb(2.4)),
                    directional(azimuthDeg, 10, Rgb(1.0))};
    stage.words = "Newell's teapot; three directional lights around the camera; perspective";
    return stage;
}

Stage scanStage(const std::string& name, const std::filesystem::path& folder) {
    const Scan* scan =
        std::find_if(std::begin(kScans), std::end(kScans), [&](const Scan& s) { return s.name == name; });
    require(scan != std::end(kScans), fmt::format("unknown mesh '{}'; known: {}", name, scanNames()));
    const std::filesystem::path file = folder / (name + ".off");
    if (!std::filesystem::exists(file)) {
        Stage stage = teapotStage(25);
        stage.lights = studioLights(25);
        stage.words = std::string("Newell's teapot; ") + kStudioWords;
        stage.note = fmt::format("{} is not there (demos/fetch.sh gets it): the teapot stands in.", file.string());
        return stage;
    }
    Stage stage;
    stage.mesh = loadMesh(file).mesh;
    move(stage.mesh, glm::rotate(glm::mat4(1), static_cast<float>(scan->pitchDeg * kPi / 180), {1, 0, 0}));
    fitToBox(stage.mesh, 2.0f);
    stage.camera = perspective(scan->azimuthDeg, scan->elevationDeg, 7, 0.34);
    stage.lights = studioLights(scan->azimuthDeg);
    stage.words = fmt::format("{}, {} triangles; {}", name, stage.mesh.triangles.size(), kStudioWords);
    return stage;
}

Stage openStage(const std::string& name, const std::filesystem::path& meshFolder) {
    if (name == "torus") return torusStage();
    if (name == "disk-sphere-circular") return diskAndSphereStage(GrooveDirection::Circular);
    if (name == "disk-sphere-radial") return diskAndSphereStage(GrooveDirection::Radial);
    if (name == "teapot-left") return teapotStage(-55);
    if (name == "teapot-right") return teapotStage(55);
    require(name.rfind("scan:", 0) == 0,
            fmt::format("unknown stage '{}'; known: torus, disk-sphere-circular, disk-sphere-radial, teapot-left, "
                        "teapot-right, and scan: with {}",
                        name, scanNames()));
    return scanStage(name.substr(5), meshFolder);
}

}  // namespace nacre
