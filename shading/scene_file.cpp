#include "shading/scene_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "shading/mesh_attributes.hpp"
#include "shading/room_capture.hpp"
#include "shading/scene_bounds.hpp"
#include "shading/scene_import.hpp"
#include "shading/scene_manifest.hpp"
#include "shading/scene_merge.hpp"
#include "shading/scene_sections.hpp"

namespace nacre {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::size_t kMaxNodes = 1'000'000;

/// A file that was imported already.
struct Import {
    ImportedScene scene;
    MergedParts parts;
};

ImportedScene readJsonScene(const fs::path& path, const SceneOptions& options, SceneStack open);

/// One scene file on its way into a description.
class SceneReader {
public:
    SceneReader(const JsonField& root, const fs::path& path, const SceneOptions& options, const SceneStack& open)
        : root_(root), folder_(path.parent_path()), options_(options), open_(open) {
        out_.scene.file = path;
    }

    ImportedScene read() {
        root_.requireKeys({"$schema", "nacre_scene", "assets", "meshes", "volumes", "materials", "lights", "nodes",
                           "camera", "sky", "animation"});
        if (const JsonField version = root_.at("nacre_scene"); version.integer(0, 1 << 30) != 1)
            version.fail(fmt::format("expected version 1, found {}", version.value().dump()));
        if (const auto schema = root_.find("$schema")) schema->text();
        names_ = {namesOf("assets"),    namesOf("meshes"), namesOf("volumes"),
                  namesOf("materials"), namesOf("lights"), namesOf("nodes")};
        readAssets();
        for (const auto& [name, f] : section("meshes")) scene().meshes.push_back(sceneMesh(name, f, folder_));
        for (const auto& [name, f] : section("volumes")) scene().volumes.push_back(sceneVolume(name, f, folder_));
        for (const auto& [name, f] : section("materials"))
            scene().materials.push_back(sceneMaterial(name, f, names_, folder_));
        for (const auto& [name, f] : section("lights")) scene().lights.push_back(sceneLight(name, f, names_));
        readNodes();
        for (std::size_t i = 0; i < names_.lights.size(); ++i)
            if (int& node = scene().lights[i].node; node >= 0) node = places_[static_cast<std::size_t>(node)];
        readAnimation();
        if (const auto sky = root_.find("sky")) scene().sky = sceneSky(*sky, names_);
        readCamera();
        out_.isComplete = true;
        return std::move(out_);
    }

private:
    SceneDescription& scene() { return out_.scene; }
    std::vector<std::pair<std::string, JsonField>> section(const char* name) const {
        const auto found = root_.find(name);
        return found ? found->members() : std::vector<std::pair<std::string, JsonField>>();
    }
    JsonNames namesOf(const char* name) const {
        JsonNames out;
        for (const auto& [key, ignored] : section(name)) out.push_back(key);
        return out;
    }

    void readAssets() {
        scene().assets = assetsIn(root_, folder_);
        if (!options_.needAssets) return;
        for (const SceneAsset& asset : scene().assets) {
            std::error_code ignored;
            if (fs::is_regular_file(asset.file, ignored)) continue;
            root_.at("assets")
                .at(asset.name)
                .at("file")
                .fail(fmt::format("{}: expected a file, found none{}", asset.file.string(),
                                  asset.bake ? fmt::format("; nacre bake {} makes it", scene().file.string()) : ""));
        }
    }

    /// Parents by the lists of their children. \throws for two parents and for cycles
    std::vector<int> parentsOf(const std::vector<std::pair<std::string, JsonField>>& nodes,
                               std::vector<std::vector<int>>& children) const {
        std::vector<int> parents(nodes.size(), -1);
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const auto list = nodes[i].second.find("children");
            if (!list) continue;
            for (const JsonField& child : list->items()) {
                const int index = child.nameIn(names_.nodes, "node");
                int& parent = parents[static_cast<std::size_t>(index)];
                if (parent >= 0)
                    child.fail(fmt::format("expected a node without a parent, found one under \"{}\"",
                                           nodes[static_cast<std::size_t>(parent)].first));
                parent = static_cast<int>(i);
                children[i].push_back(index);
            }
        }
        return parents;
    }

    [[noreturn]] void failCycle(const std::vector<int>& parents, std::size_t start) const {
        std::set<std::size_t> seen;
        std::size_t at = start;
        while (seen.insert(at).second) at = static_cast<std::size_t>(parents[at]);
        std::string cycle = names_.nodes[at];
        for (std::size_t up = static_cast<std::size_t>(parents[at]);; up = static_cast<std::size_t>(parents[up])) {
            cycle = names_.nodes[up] + " > " + cycle;
            if (up == at) break;
        }
        root_.at("nodes").at(names_.nodes[at]).at("children").fail("expected no cycle, found " + cycle);
    }

    /// Nodes from the roots down, so that parents come first, each followed by what it imports.
    void readNodes() {
        const auto nodes = section("nodes");
        std::vector<std::vector<int>> children(nodes.size());
        const std::vector<int> parents = parentsOf(nodes, children);
        places_.assign(nodes.size(), -1);
        std::vector<int> waiting;
        for (std::size_t i = nodes.size(); i-- > 0;)
            if (parents[i] < 0) waiting.push_back(static_cast<int>(i));
        while (!waiting.empty()) {
            const auto i = static_cast<std::size_t>(waiting.back());
            waiting.pop_back();
            places_[i] = addNode(nodes[i].first, nodes[i].second,
                                 parents[i] < 0 ? -1 : places_[static_cast<std::size_t>(parents[i])]);
            waiting.insert(waiting.end(), children[i].rbegin(), children[i].rend());
        }
        for (std::size_t i = 0; i < nodes.size(); ++i)
            if (places_[i] < 0) failCycle(parents, i);
    }

    int addNode(const std::string& name, const JsonField& field, int parent) {
        SceneNode node = sceneNode(name, field, names_);
        node.parent = parent;
        const auto import = field.find("import");
        const auto index = scene().nodes.size();
        const int material = node.material;
        if (import) node.material = -1;
        scene().nodes.push_back(std::move(node));
        if (import) addImport(*import, static_cast<int>(index), material);
        for (std::size_t i = index; i < scene().nodes.size(); ++i) requireUv(field, scene().nodes[i]);
        return static_cast<int>(index);
    }

    void addImport(const JsonField& field, int parent, int material) {
        const Import& import = imported(field);
        if (scene().nodes.size() + import.scene.scene.nodes.size() > kMaxNodes)
            field.fail(fmt::format("expected at most {} nodes in all, found more", kMaxNodes));
        mergeInstance(scene(), import.scene.scene, import.parts, parent, material);
        if (!import.scene.hasCamera || cameraNode_ >= 0) return;
        cameraNode_ = parent;
        scene().camera = import.scene.scene.camera;
    }

    const Import& imported(const JsonField& field) {
        const fs::path file = scenePath(folder_, field.text());
        requireNoCycle(open_, file, field);
        const auto known = imports_.find(file);
        if (known != imports_.end()) return known->second;
        Import fresh;
        fresh.scene = named(field, [&] {
            return file.extension() == ".json" ? readJsonScene(file, options_, open_)
                                               : importScene(file, options_.note);
        });
        fresh.parts = mergeParts(scene(), fresh.scene.scene, field.text() + "/");
        return imports_.emplace(file, std::move(fresh)).first->second;
    }

    /// A relief lies in the mesh's uv, along ∂P/∂u.
    void requireUv(const JsonField& field, const SceneNode& node) const {
        if (node.material < 0) return;
        const SceneMaterial& material = out_.scene.materials[static_cast<std::size_t>(node.material)];
        if (!material.relief) return;
        if (node.volume >= 0)
            field.fail(fmt::format("expected a material without relief for a volume, found \"{}\"", material.name));
        if (node.mesh < 0) return;
        const SceneMesh& mesh = out_.scene.meshes[static_cast<std::size_t>(node.mesh)];
        if (!hasUv(mesh.mesh))
            field.fail(fmt::format("expected a mesh with uv for the relief of \"{}\", found none in \"{}\"",
                                   material.name, mesh.name));
        const auto& meshes = root_.find("meshes");
        const auto own = meshes ? meshes->find(mesh.name) : std::nullopt;
        if (!own) return;
        for (const auto& [kind, shape] : own->members())
            if (shape.value().is_object() && shape.value().value("tangents", "circular") == "radial")
                field.fail(
                    fmt::format("expected circular tangents for the relief of \"{}\", found radial ones in \"{}\"",
                                material.name, mesh.name));
    }

    void readAnimation() {
        const auto animation = root_.find("animation");
        if (!animation) return;
        animation->requireKeys({"duration", "tracks"});
        const std::size_t first = scene().tracks.size();
        std::set<std::pair<int, SceneTrack::Path>> taken;
        double last = 0;
        for (const JsonField& field : animation->at("tracks").items()) {
            SceneTrack track = sceneTrack(field, names_);
            if (!taken.emplace(track.node, track.path).second)
                field.fail("expected one track for each node and path, found a second");
            track.node = places_[static_cast<std::size_t>(track.node)];
            last = std::max(last, track.times.back());
            scene().tracks.push_back(std::move(track));
        }
        scene().duration = std::max(scene().duration, last);
        if (const auto duration = animation->find("duration")) {
            if (first < scene().tracks.size() && !(duration->positive() >= last))
                duration->fail(
                    fmt::format("expected at least the last time, {:g}, found {:g}", last, duration->number()));
            scene().duration = duration->positive();
        }
    }

    /// The file's own, or the first imported one where its node places it.
    void readCamera() {
        if (const auto camera = root_.find("camera")) {
            scene().camera = sceneCamera(*camera);
            out_.hasCamera = true;
        } else if (cameraNode_ >= 0) {
            scene().camera =
                cameraAt(scene().camera, nodeTransforms(scene(), 0)[static_cast<std::size_t>(cameraNode_)]);
            out_.hasCamera = true;
        }
    }

    const JsonField& root_;
    fs::path folder_;
    const SceneOptions& options_;
    const SceneStack& open_;
    SceneNames names_;
    std::vector<int> places_;  ///< of the file's own nodes in the scene, by name
    std::map<fs::path, Import> imports_;
    int cameraNode_ = -1;  ///< with an imported camera
    ImportedScene out_;
};

ImportedScene readDocument(const json& document, const fs::path& path, const SceneOptions& options, SceneStack open) {
    open.push_back(fs::weakly_canonical(path));
    const std::string name = path.string();
    const JsonField root(document, name);
    if (isRoomCapture(document)) return roomCapture(root, path, options.note);
    return SceneReader(root, path, options, open).read();
}

ImportedScene readJsonScene(const fs::path& path, const SceneOptions& options, SceneStack open) {
    return readDocument(readSceneJson(path), path, options, std::move(open));
}

/// What a file that is no scene file lacks to be looked at.
void complete(SceneDescription& scene, const Camera& camera, const std::optional<SceneLight>& lamp) {
    if (!scene.lights.empty()) return;
    SceneLight key;
    key.name = "key";
    // From above and to the left of the viewer, nearer to the viewer than to the side.
    const Vec3 back = glm::normalize(camera.eye - camera.target), right = glm::normalize(glm::cross(camera.up, back));
    key.light.position = glm::normalize(0.9 * back - 0.6 * right + 0.8 * glm::cross(back, right));
    key.light.color = Rgb(kPi);  // a white surface that faces it has radiance 1
    key.shadow = SceneShadow{};
    scene.lights.push_back(lamp.value_or(key));
    for (SceneMaterial& material : scene.materials)
        if (material.ambient == Rgb(0)) material.ambient = Rgb(0.03);
}

SceneDescription finished(ImportedScene in, const fs::path& path) {
    SceneDescription& scene = in.scene;
    scene.file = path;
    markMoving(scene);
    const SceneBounds bounds = boundsOf(scene);
    for (int i = 0; i < 3 && !bounds.empty; ++i)
        if (const double most = std::max(-bounds.low[i], bounds.high[i]); !(most <= kFarthest))
            throw Error(fmt::format("{}: expected all of the scene within {:g} of the origin, found a vertex at {:g}",
                                    path.string(), kFarthest, most));
    if (!in.hasCamera)
        scene.camera = cameraSeeing(bounds);
    else if (scene.camera.near == 0 || scene.camera.far == 0)
        scene.camera = withDepth(scene.camera, bounds);
    if (!in.isComplete) complete(scene, scene.camera, in.lamp);
    return std::move(in.scene);
}

}  // namespace

SceneDescription readScene(const fs::path& path, const SceneOptions& options) {
    const bool isJson = path.extension() == ".json";
    return finished(isJson ? readJsonScene(path, options, {}) : importScene(path, options.note), path);
}

SceneDescription parseScene(std::string_view text, const fs::path& path, const SceneOptions& options) {
    return finished(readDocument(parseJson(text, path.string()), path, options, {}), path);
}

bool isSceneName(const fs::path& path) { return path.extension() == ".json" || isImportName(path); }

}  // namespace nacre
