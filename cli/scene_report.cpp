#include "cli/scene_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cli/bake_record.hpp"
#include "cli/terminal.hpp"
#include "core/error.hpp"
#include "shading/scene_programs.hpp"

namespace nacre::cli {

using nlohmann::json;

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

json listOf(const Vec3& v) { return {v.x, v.y, v.z}; }

std::string assetName(const SceneDescription& scene, int asset) { return scene.assets[at(asset)].name; }

const char* nameOf(BumpShadow shadow) {
    static constexpr const char* kNames[] = {"none", "hard_ellipse", "ellipse", "hard_horizon", "horizon"};
    return kNames[static_cast<int>(shadow)];
}

/// One number for grey.
std::string colorText(const Rgb& c) {
    return c == Rgb(c.r) ? fmt::format("{:g}", c.r) : fmt::format("{:g}/{:g}/{:g}", c.r, c.g, c.b);
}

/// "mirror", "index 1.5 (filter 64 x 64, spread 0.05)"
std::string specularText(const SceneSpecular& s) {
    std::string more;
    const auto add = [&](const std::string& text) { more += (more.empty() ? "" : ", ") + text; };
    if (s.filter) add(fmt::format("filter {} x {}", s.filter->width(), s.filter->height()));
    if (s.surface > 0) add(fmt::format("surface {:g}", s.surface));
    if (s.spread > 0) add(fmt::format("spread {:g}", s.spread));
    if (s.roughness > 0) add(fmt::format("roughness {:g}", s.roughness));
    return (s.ior ? fmt::format("index {:g}", *s.ior) : "mirror") + (more.empty() ? "" : " (" + more + ")");
}

/// Role and asset of each that a material uses: {"brdf": "gold", "relief": "wall"}.
json usesOf(const SceneDescription& scene, const SceneMaterial& material) {
    json out = json::object();
    const auto add = [&](const char* role, int asset) {
        if (asset >= 0) out[role] = assetName(scene, asset);
    };
    add("brdf", material.brdf);
    if (material.ambient != Rgb(0)) out["ambient"] = colorText(material.ambient);
    if (!material.model.empty()) out["model"] = material.model;
    if (material.relief) {
        add("relief", material.relief->asset);
        out["relief_shadow"] = nameOf(material.relief->shadow);
        if (material.relief->indirectLight >= 0)
            out["indirect_light"] = scene.lights[at(material.relief->indirectLight)].name;
    }
    if (material.surrounding) {
        add("reflection", material.surrounding->reflection.asset);
        add("transmission", material.surrounding->transmission.asset);
        add("diffuse", material.surrounding->diffuse.asset);
        add("table", material.surrounding->table);
    }
    if (material.specular) out["specular"] = specularText(*material.specular);
    return out;
}

json meshesOf(const SceneDescription& scene) {
    json out = json::array();
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        const Mesh& mesh = scene.meshes[i].mesh;
        out.push_back({{"name", scene.meshes[i].name},
                       {"triangles", mesh.triangles.size()},
                       {"vertices", mesh.positions.size()},
                       {"instances", std::count_if(scene.nodes.begin(), scene.nodes.end(), [&](const SceneNode& n) {
                            return n.mesh == static_cast<int>(i);
                        })}});
    }
    return out;
}

json volumesOf(const SceneDescription& scene) {
    json out = json::array();
    for (std::size_t i = 0; i < scene.volumes.size(); ++i) {
        const SceneVolume& volume = scene.volumes[i];
        const glm::ivec3& size = volume.volume->size;
        out.push_back({{"name", volume.name},
                       {"size", {size.x, size.y, size.z}},
                       {"iso", volume.iso},
                       {"method", volume.method == VolumeMethod::March ? "march" : "slices"},
                       {"step", volume.step},
                       {"instances", std::count_if(scene.nodes.begin(), scene.nodes.end(), [&](const SceneNode& n) {
                            return n.volume == static_cast<int>(i);
                        })}});
    }
    return out;
}

json materialsOf(const SceneDescription& scene) {
    json out = json::array();
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        out.push_back({{"name", scene.materials[i].name},
                       {"uses", usesOf(scene, scene.materials[i])},
                       {"nodes", std::count_if(scene.nodes.begin(), scene.nodes.end(), [&](const SceneNode& n) {
                            return n.material == static_cast<int>(i);
                        })}});
    return out;
}

json lightsOf(const SceneDescription& scene) {
    json out = json::array();
    for (const SceneLight& l : scene.lights) {
        json entry = {{"name", l.name},
                      {"type", l.light.directional ? "directional"
                               : l.light.cone      ? "spot"
                                                   : "point"},
                      {"color", listOf(l.light.color)}};
        if (l.node >= 0) entry["node"] = scene.nodes[at(l.node)].name;
        if (l.area) entry["area"] = {{"u", listOf(l.area->u)}, {"v", listOf(l.area->v)}};
        if (l.shadow)
            entry["shadow"] = {{"size", l.shadow->size}, {"bits", l.shadow->bits}, {"filter", l.shadow->filter}};
        out.push_back(entry);
    }
    return out;
}

json assetsOf(const SceneDescription& scene) {
    json out = json::array();
    for (const SceneAsset& asset : scene.assets) {
        const AssetState state = stateOf(asset);
        json entry = {{"name", asset.name}, {"file", asset.file.string()}, {"state", toString(state.kind)}};
        std::error_code none;
        const std::uintmax_t bytes = std::filesystem::file_size(asset.file, none);
        if (!none) entry["bytes"] = bytes;
        if (!state.why.empty()) entry["why"] = state.why;
        if (asset.bake)
            entry["bake"] = {
                {"verb", asset.bake->verb}, {"source", asset.bake->source}, {"options", asset.bake->options}};
        out.push_back(entry);
    }
    return out;
}

/// The shaders that drawing takes, or why nobody knows yet: an asset that isn't baked.
json programsOf(const SceneDescription& scene) {
    std::vector<AssetTraits> traits;
    json out = json::array();
    try {
        for (const SceneAsset& asset : scene.assets)
            traits.push_back(traitsOf(readAsset(asset.file), asset.file.string()));
        checkScene(scene, traits);
    } catch (const std::exception& error) {
        return {{"unknown", error.what()}};
    }
    for (const ListedProgram& listed : scenePrograms(scene, traits)) {
        json entry = {{"vertex", listed.program.vertex},
                      {"fragment", listed.program.fragment},
                      {"defines", json::object()},
                      {"nodes", json::array()}};
        for (const auto& [name, value] : listed.program.defines) entry["defines"][name] = value;
        for (const int node : listed.nodes) entry["nodes"].push_back(scene.nodes[at(node)].name);
        out.push_back(std::move(entry));
    }
    return out;
}

std::string programsText(const json& programs) {
    if (programs.is_object())
        return fmt::format("  programs  not known yet: {}\n", programs["unknown"].get<std::string>());
    std::string out;
    for (const json& p : programs) {
        std::string defines;
        for (const auto& [name, value] : p["defines"].items())
            if (name != "NACRE_SPECIALIZE")
                defines += " " + name + (value == "1" ? "" : "=" + value.get<std::string>());
        out += fmt::format("  program   {:<20} {} nodes:{}\n", p["fragment"].get<std::string>(), p["nodes"].size(),
                           defines);
    }
    return out;
}

/// Its edges.
std::string areaText(const json& area) {
    const auto edge = [&](const char* key) {
        const json& v = area[key];
        return 2 * glm::length(Vec3(v[0].get<double>(), v[1].get<double>(), v[2].get<double>()));
    };
    return fmt::format(", area {:g} x {:g}", edge("u"), edge("v"));
}

std::string usesText(const json& uses) {
    std::string out;
    for (const auto& [role, what] : uses.items())
        out += fmt::format("{}{} {}", out.empty() ? "" : ", ", role, what.get<std::string>());
    return out.empty() ? "black" : out;
}

}  // namespace

json sceneReport(const SceneDescription& scene, const std::vector<std::string>& notes) {
    std::size_t drawn = 0, instances = 0;
    for (const SceneNode& node : scene.nodes) {
        if (node.mesh < 0) continue;
        ++instances;
        drawn += scene.meshes[at(node.mesh)].mesh.triangles.size();
    }
    const Camera& camera = scene.camera;
    json view = {
        {"eye", listOf(camera.eye)}, {"target", listOf(camera.target)}, {"near", camera.near}, {"far", camera.far}};
    view[camera.orthographic ? "orthographic_height" : "fov_y_deg"] =
        camera.orthographic ? camera.height : camera.fovY * 180 / kPi;
    return {{"file", scene.file.string()},
            {"nodes", scene.nodes.size()},
            {"moving_nodes",
             std::count_if(scene.nodes.begin(), scene.nodes.end(), [](const SceneNode& n) { return !n.isStatic; })},
            {"instances", instances},
            {"triangles", drawn},
            {"meshes", meshesOf(scene)},
            {"volumes", volumesOf(scene)},
            {"materials", materialsOf(scene)},
            {"lights", lightsOf(scene)},
            {"assets", assetsOf(scene)},
            {"programs", programsOf(scene)},
            {"camera", view},
            {"tracks", scene.tracks.size()},
            {"duration", scene.duration},
            {"notes", notes}};
}

std::string sceneText(const json& r) {
    const auto count = [&](const char* key) { return r[key].is_array() ? r[key].size() : r[key].get<std::size_t>(); };
    std::string out =
        fmt::format("{}: {} triangles in {} instances of {} meshes, {} nodes ({} moving), {} materials, {} lights\n",
                    r["file"].get<std::string>(), count("triangles"), count("instances"), count("meshes"),
                    count("nodes"), count("moving_nodes"), count("materials"), count("lights"));
    for (const json& m : r["meshes"])
        out +=
            fmt::format("  mesh      {:<20} {:>9} triangles, {} vertices, {} instances\n", m["name"].get<std::string>(),
                        m["triangles"].get<std::size_t>(), m["vertices"].get<std::size_t>(), m["instances"].get<int>());
    for (const json& v : r["volumes"])
        out += fmt::format(
            "  volume    {:<20} {} x {} x {} samples, surface at {:g}, {} of {:g} texels, {} instances\n",
            v["name"].get<std::string>(), v["size"][0].get<int>(), v["size"][1].get<int>(), v["size"][2].get<int>(),
            v["iso"].get<double>(), v["method"].get<std::string>(), v["step"].get<double>(), v["instances"].get<int>());
    for (const json& m : r["materials"])
        out += fmt::format("  material  {:<20} {}\n", m["name"].get<std::string>(), usesText(m["uses"]));
    for (const json& l : r["lights"])
        out += fmt::format("  light     {:<20} {}{}{}{}\n", l["name"].get<std::string>(), l["type"].get<std::string>(),
                           l.contains("node") ? " on " + l["node"].get<std::string>() : "",
                           l.contains("area") ? areaText(l["area"]) : "",
                           l.contains("shadow")
                               ? fmt::format(", shadow {} texels of {} bits", l["shadow"]["size"].get<int>(),
                                             l["shadow"]["bits"].get<int>())
                               : "");
    for (const json& a : r["assets"])
        out += fmt::format("  asset     {:<20} {:<8} {}{}{}\n", a["name"].get<std::string>(),
                           a["state"].get<std::string>(), a["file"].get<std::string>(),
                           a.contains("bytes") ? ", " + humanBytes(a["bytes"].get<std::size_t>()) : "",
                           a.contains("why") ? ": " + a["why"].get<std::string>() : "");
    out += programsText(r["programs"]);
    if (r["duration"].get<double>() > 0)
        out +=
            fmt::format("  animation {} tracks, {:g} s\n", r["tracks"].get<std::size_t>(), r["duration"].get<double>());
    for (const json& note : r["notes"]) out += "  note      " + note.get<std::string>() + "\n";
    return out;
}

}  // namespace nacre::cli
