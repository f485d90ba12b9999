#include "shading/scene_sections.hpp"

#include <fmt/format.h>

#include <array>

#include "core/error.hpp"
#include "shading/mesh_file.hpp"
#include "shading/primitives.hpp"
#include "shading/scene_manifest.hpp"
#include "shading/volume_file.hpp"

namespace nacre {
namespace {

constexpr double kNearest = 1e-6;
constexpr int kMostSteps = 2048;  // of a shape made by formula, each way

float lengthOr(const JsonField& field, const char* key, float fallback) {
    const auto inner = field.find(key);
    if (!inner) return fallback;
    const double value = inner->positive();
    if (value > kFarthest) inner->number(0, kFarthest);
    return static_cast<float>(value);
}
int stepsOr(const JsonField& field, const char* key, int least, int fallback) {
    const auto inner = field.find(key);
    return inner ? inner->integer(least, kMostSteps) : fallback;
}
TangentDirection tangentsOf(const JsonField& field) {
    const auto inner = field.find("tangents");
    return inner && inner->choice({"circular", "radial"}) == 1 ? TangentDirection::Radial : TangentDirection::Circular;
}

Mesh meshFile(const JsonField& f, const std::filesystem::path& folder) {
    return namedText(f, [&](const std::string& name) { return loadMesh(scenePath(folder, name)).mesh; });
}
Mesh torus(const JsonField& f) {
    f.requireKeys({"ring", "tube", "rings", "sides", "tangents"});
    return makeTorus(lengthOr(f, "ring", 1), lengthOr(f, "tube", 0.4f), stepsOr(f, "rings", 3, 200),
                     stepsOr(f, "sides", 3, 200), tangentsOf(f));
}
Mesh sphere(const JsonField& f) {
    f.requireKeys({"radius", "segments", "stacks", "tangents"});
    return makeSphere(lengthOr(f, "radius", 1), stepsOr(f, "segments", 3, 128), stepsOr(f, "stacks", 2, 64),
                      tangentsOf(f));
}
Mesh disk(const JsonField& f) {
    f.requireKeys({"radius", "segments", "rings", "tangents"});
    return makeDisk(lengthOr(f, "radius", 1), stepsOr(f, "segments", 3, 128), stepsOr(f, "rings", 1, 32),
                    tangentsOf(f));
}
Mesh quad(const JsonField& f) {
    f.requireKeys({"size", "steps"});
    return makeQuad(lengthOr(f, "size", 2), stepsOr(f, "steps", 1, 1));
}

}  // namespace

SceneMesh sceneMesh(const std::string& name, const JsonField& field, const std::filesystem::path& folder) {
    field.requireKeys({"file", "torus", "sphere", "disk", "quad", "fit"});
    std::vector<std::string> kinds;
    for (const char* kind : {"file", "torus", "sphere", "disk", "quad"})
        if (field.find(kind)) kinds.push_back(kind);
    if (kinds.size() != 1)
        field.fail(fmt::format("expected one of file, torus, sphere, disk, quad, found {}",
                               kinds.empty() ? "none" : kinds[0] + " and " + kinds[1]));
    const JsonField inner = field.at(kinds[0]);
    SceneMesh out{name, kinds[0] == "file"     ? meshFile(inner, folder)
                        : kinds[0] == "torus"  ? torus(inner)
                        : kinds[0] == "sphere" ? sphere(inner)
                        : kinds[0] == "disk"   ? disk(inner)
                                               : quad(inner)};
    ifThere(field, "fit", [&](const JsonField& f) {
        const float size = lengthOr(field, "fit", 2);
        named(f, [&] {
            fitToBox(out.mesh, size);
            return 0;
        });
    });
    return out;
}

SceneVolume sceneVolume(const std::string& name, const JsonField& field, const std::filesystem::path& folder) {
    field.requireKeys({"file", "iso", "method", "step"});
    SceneVolume out;
    out.name = name;
    out.iso = field.at("iso").number();
    ifThere(field, "method", [&](const JsonField& f) {
        out.method = f.choice({"march", "slices"}) == 0 ? VolumeMethod::March : VolumeMethod::Slices;
    });
    ifThere(field, "step", [&](const JsonField& f) { out.step = f.positive(); });
    out.volume = namedText(field.at("file"), [&](const std::string& file) {
        return std::make_shared<Volume>(readVolume(scenePath(folder, file)));
    });
    return out;
}

SceneNode sceneNode(const std::string& name, const JsonField& field, const SceneNames& names) {
    field.requireKeys({"mesh", "volume", "material", "translation", "rotation", "axis", "angleDeg", "scale",
                       "castsShadow", "receivesShadow", "static", "children", "import"});
    SceneNode out;
    out.name = name;
    ifThere(field, "mesh", [&](const JsonField& f) { out.mesh = f.nameIn(names.meshes, "mesh"); });
    ifThere(field, "material", [&](const JsonField& f) { out.material = f.nameIn(names.materials, "material"); });
    ifThere(field, "volume", [&](const JsonField& f) { out.volume = f.nameIn(names.volumes, "volume"); });
    const auto import = field.find("import");
    const char* shape = out.mesh >= 0 ? "mesh" : "volume";
    const bool hasShape = out.mesh >= 0 || out.volume >= 0;
    if (out.mesh >= 0 && out.volume >= 0) field.fail("expected \"mesh\" or \"volume\", found both");
    if (import && hasShape) import->fail(fmt::format("expected \"{}\" or \"import\", found both", shape));
    if (hasShape && out.material < 0) field.fail(fmt::format("expected \"material\" beside \"{}\", found none", shape));
    if (!hasShape && out.material >= 0 && !import) field.fail("expected \"mesh\" beside \"material\", found none");
    ifThere(field, "translation", [&](const JsonField& f) { out.translation = f.vector(); });
    ifThere(field, "rotation", [&](const JsonField& f) {
        const Vec4 q = f.quaternion();
        out.rotation = glm::dquat(q.w, q.x, q.y, q.z);
    });
    const auto axis = field.find("axis"), angle = field.find("angleDeg");
    if (axis && field.find("rotation")) axis->fail("expected \"rotation\" or \"axis\" and \"angleDeg\", found both");
    if (axis && !angle) axis->fail("expected \"angleDeg\" beside it, found none");
    if (angle && !axis) angle->fail("expected \"axis\" beside it, found none");
    if (axis) out.rotation = glm::angleAxis(radians(angle->number(-1e6, 1e6)), axis->direction());
    ifThere(field, "scale", [&](const JsonField& f) {
        out.scale = f.value().is_number() ? Vec3(f.number()) : f.vector();
        if (out.scale.x * out.scale.y * out.scale.z == 0)
            f.fail("expected no factor of 0: normals would have no direction");
    });
    ifThere(field, "castsShadow", [&](const JsonField& f) { out.castsShadow = f.flag(); });
    ifThere(field, "receivesShadow", [&](const JsonField& f) { out.receivesShadow = f.flag(); });
    ifThere(field, "static", [&](const JsonField& f) { out.isStatic = f.flag(); });
    return out;
}

SceneSky sceneSky(const JsonField& field, const SceneNames& names) {
    field.requireKeys({"asset", "lod", "color", "rotationYDeg"});
    SceneSky out;
    ifThere(field, "asset", [&](const JsonField& f) { out.asset = f.nameIn(names.assets, "asset"); });
    ifThere(field, "lod", [&](const JsonField& f) {
        out.lod = f.number(0, 32);
        if (out.asset < 0) f.fail("expected \"asset\" beside it, found none");
    });
    ifThere(field, "color", [&](const JsonField& f) {
        out.color = f.color();
        if (out.asset >= 0) f.fail("expected \"asset\" or \"color\", found both");
    });
    ifThere(field, "rotationYDeg", [&](const JsonField& f) { out.rotationY = radians(f.number(-1e6, 1e6)); });
    return out;
}

Camera sceneCamera(const JsonField& field) {
    field.requireKeys({"eye", "target", "up", "fovYDeg", "orthographicHeight", "near", "far"});
    Camera out;
    ifThere(field, "eye", [&](const JsonField& f) { out.eye = f.vector(); });
    ifThere(field, "target", [&](const JsonField& f) { out.target = f.vector(); });
    ifThere(field, "up", [&](const JsonField& f) { out.up = f.direction(); });
    const Vec3 ahead = out.target - out.eye;
    if (!(glm::length(ahead) > 0)) field.fail("expected eye and target apart, found them at one point");
    if (glm::length(glm::cross(glm::normalize(ahead), out.up)) < 1e-6)
        field.fail("expected \"up\" across the line of sight, found it along");
    ifThere(field, "fovYDeg", [&](const JsonField& f) {
        out.fovY = radians(f.number(0.01, 179));
        if (field.find("orthographicHeight")) f.fail("expected \"fovYDeg\" or \"orthographicHeight\", found both");
    });
    ifThere(field, "orthographicHeight", [&](const JsonField& f) {
        out.orthographic = true;
        out.height = f.number(kNearest, kFarthest);
    });
    const auto near = field.find("near"), far = field.find("far");
    out.near = near ? near->number(kNearest, kFarthest) : 0;
    out.far = far ? far->number(kNearest, 1e3 * kFarthest) : 0;
    if (near && far && !(out.far > out.near))
        far->fail(fmt::format("expected more than near, {:g}, found {:g}", out.near, out.far));
    return out;
}

SceneTrack sceneTrack(const JsonField& field, const SceneNames& names) {
    field.requireKeys({"node", "path", "times", "values", "axis", "anglesDeg", "interpolation"});
    SceneTrack out;
    out.node = field.at("node").nameIn(names.nodes, "node");
    out.path = static_cast<SceneTrack::Path>(field.at("path").choice({"translation", "rotation", "scale"}));
    ifThere(field, "interpolation", [&](const JsonField& f) { out.step = f.choice({"linear", "step"}) == 1; });
    for (const JsonField& time : field.at("times").items(1)) {
        out.times.push_back(time.number(0));
        if (out.times.size() > 1 && !(out.times.back() > out.times[out.times.size() - 2]))
            time.fail(fmt::format("expected a time after {:g}, found {:g}", out.times[out.times.size() - 2],
                                  out.times.back()));
    }
    const std::size_t count = out.times.size();
    const auto axis = field.find("axis"), angles = field.find("anglesDeg");
    if (!axis && !angles) {
        for (const JsonField& value : field.at("values").items(count, count))
            out.values.push_back(out.path == SceneTrack::Path::Rotation ? value.quaternion() : Vec4(value.vector(), 0));
        return out;
    }
    if (const auto values = field.find("values"))
        values->fail("expected \"values\" or \"axis\" and \"anglesDeg\", found both");
    if (out.path != SceneTrack::Path::Rotation)
        field.fail("expected \"values\": only rotations have \"axis\" and \"anglesDeg\"");
    const Vec3 about = field.at("axis").direction();
    double last = 0;
    for (const JsonField& angle : field.at("anglesDeg").items(count, count)) {
        const double degrees = angle.number(-1e6, 1e6);
        // Between two rotations the shorter way is taken.
        if (!out.step && !out.values.empty() && std::abs(degrees - last) >= 180)
            angle.fail(
                fmt::format("expected less than 180 degrees from {:g}, found {:g}: put a key between", last, degrees));
        last = degrees;
        const glm::dquat q = glm::angleAxis(radians(degrees), about);
        out.values.emplace_back(q.x, q.y, q.z, q.w);
    }
    return out;
}

}  // namespace nacre
