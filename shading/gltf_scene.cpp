#include "shading/gltf_scene.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/json_field.hpp"
#include "factorize/models/models.hpp"
#include "shading/scene_sections.hpp"

namespace nacre {
namespace {

constexpr const char* kLights = "KHR_lights_punctual";

std::vector<JsonField> listOf(const JsonField& root, const char* key) {
    const auto list = root.find(key);
    return list ? list->items() : std::vector<JsonField>();
}
int indexOf(const JsonField& field, std::size_t count) {
    if (count == 0) field.fail("expected none: the file has no such things, found " + field.value().dump());
    return field.integer(0, static_cast<int>(count) - 1);
}
std::string nameOf(const JsonField& field, const char* kind, std::size_t index) {
    const auto name = field.find("name");
    return name && name->value().is_string() && !name->value().get<std::string>().empty()
               ? name->text()
               : fmt::format("{} {}", kind, index);
}
std::optional<JsonField> extension(const JsonField& field, const char* name) {
    const auto all = field.find("extensions");
    return all ? all->find(name) : std::nullopt;
}
std::string shown(const Rgb& c) { return fmt::format("{:.9g}/{:.9g}/{:.9g}", c.r, c.g, c.b); }

double unitOr(const JsonField& field, const char* key, double fallback) {
    const auto inner = field.find(key);
    return inner ? inner->number(0, 1) : fallback;
}

/// KHR_materials' metallic-roughness model by the Fresnel of Schlick 1994; nothing but factors.
SceneMaterial material(const JsonField& field, std::size_t index, bool& textured, bool& seeThrough) {
    SceneMaterial out;
    out.name = nameOf(field, "material", index);
    Rgb base(1);
    double metallic = 1, roughness = 1;
    if (const auto pbr = field.find("pbrMetallicRoughness")) {
        if (const auto factor = pbr->find("baseColorFactor")) {
            const auto v = factor->items(4, 4);
            base = {v[0].number(0, 1), v[1].number(0, 1), v[2].number(0, 1)};
        }
        metallic = unitOr(*pbr, "metallicFactor", 1);
        roughness = unitOr(*pbr, "roughnessFactor", 1);
        textured = textured || pbr->find("baseColorTexture") || pbr->find("metallicRoughnessTexture");
    }
    textured = textured || field.find("normalTexture") || field.find("emissiveTexture");
    seeThrough = seeThrough || (field.find("alphaMode") && field.at("alphaMode").text() != "OPAQUE");
    constexpr double kLeastAlpha = 1e-4;  // the model's; a perfect mirror would show no light of a point
    out.model =
        makeModel(fmt::format("ggx:alpha={:.9g},f=schlick,f0={},kd={}", std::max(kLeastAlpha, roughness * roughness),
                              shown(glm::mix(Rgb(0.04), base, metallic)), shown((1 - metallic) * base)))
            .source;
    if (const auto emissive = field.find("emissiveFactor")) out.ambient = emissive->color();
    if (const auto strength = extension(field, "KHR_materials_emissive_strength"))
        if (const auto factor = strength->find("emissiveStrength")) out.ambient *= factor->number(0);
    return out;
}

/// By the light's type in its node's frame: it shines along −z.
Light light(const JsonField& field, bool& ranged) {
    Light out;
    const int type = field.at("type").choice({"directional", "point", "spot"});
    out.directional = type == 0;
    out.position = out.directional ? Vec3(0, 0, 1) : Vec3(0);
    ifThere(field, "color", [&](const JsonField& f) { out.color = f.color(); });
    ifThere(field, "intensity", [&](const JsonField& f) { out.color *= f.number(0); });
    ranged = ranged || field.find("range");
    if (type != 2) return out;
    out.cone = SpotCone{};
    const auto spot = field.find("spot");
    if (!spot) return out;
    ifThere(*spot, "outerConeAngle", [&](const JsonField& f) { out.cone->outer = f.number(1e-9, kPi / 2 + 1e-6); });
    out.cone->outer = std::min(out.cone->outer, kPi / 2);  // a float of π/2 is a little more
    ifThere(*spot, "innerConeAngle", [&](const JsonField& f) {
        out.cone->inner = f.number(0);
        if (!(out.cone->inner < out.cone->outer))
            f.fail("expected less than outerConeAngle, found " + f.value().dump());
    });
    return out;
}

Camera camera(const JsonField& field) {
    Camera out;
    out.eye = Vec3(0);
    out.target = Vec3(0, 0, -1);
    out.orthographic = field.at("type").choice({"perspective", "orthographic"}) == 1;
    const JsonField inner = field.at(out.orthographic ? "orthographic" : "perspective");
    if (out.orthographic)
        out.height = 2 * inner.at("ymag").positive();
    else
        out.fovY = inner.at("yfov").number(1e-3, 3.1);
    out.near = inner.at("znear").number(0);  // 0, of an orthographic one, is fitted
    const auto far = inner.find("zfar");     // none: infinite, so fitted
    out.far = far ? far->positive() : 0;
    if (far && !(out.far > out.near)) far->fail("expected more than znear, found " + far->value().dump());
    return out;
}

void takeMatrix(SceneNode& node, const JsonField& field) {
    const auto items = field.items(16, 16);
    glm::dmat4 m;
    for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = items[static_cast<std::size_t>(i)].number();
    Mat3 linear(m);
    node.translation = Vec3(m[3]);
    node.scale = {glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])};
    if (glm::determinant(linear) < 0) node.scale.x = -node.scale.x;
    for (int i = 0; i < 3; ++i) linear[i] = linear[i] / node.scale[i];
    constexpr double kShear = 1e-3;
    if (!(std::abs(glm::dot(linear[0], linear[1])) < kShear && std::abs(glm::dot(linear[1], linear[2])) < kShear &&
          std::abs(glm::dot(linear[2], linear[0])) < kShear))
        field.fail("expected a translation, rotation and scale other than 0, found another matrix");
    node.rotation = glm::normalize(glm::quat_cast(linear));
}

SceneNode node(const JsonField& field, std::size_t index, int parent) {
    SceneNode out;
    out.name = nameOf(field, "node", index);
    out.parent = parent;
    if (const auto matrix = field.find("matrix")) takeMatrix(out, *matrix);
    ifThere(field, "translation", [&](const JsonField& f) { out.translation = f.vector(); });
    ifThere(field, "rotation", [&](const JsonField& f) {
        const Vec4 q = f.quaternion();
        out.rotation = glm::dquat(q.w, q.x, q.y, q.z);
    });
    ifThere(field, "scale", [&](const JsonField& f) { out.scale = f.vector(); });
    return out;
}

/// The hierarchy on its way into the scene.
class Reader {
public:
    Reader(const GltfFile& file, const std::function<void(const std::string&)>& note)
        : name_(file.path.string()), root_(file.document, name_), nodes_(listOf(root_, "nodes")), note_(note) {
        const auto lights = extension(root_, kLights);
        if (lights) lights_ = listOf(*lights, "lights");
        cameras_ = listOf(root_, "cameras");
    }

    GltfScene read() {
        out_.scene.file = name_;
        const auto materials = listOf(root_, "materials");
        bool textured = false, seeThrough = false;
        for (std::size_t i = 0; i < materials.size(); ++i)
            out_.scene.materials.push_back(material(materials[i], i, textured, seeThrough));
        const auto meshes = listOf(root_, "meshes");
        for (std::size_t i = 0; i < meshes.size(); ++i) out_.meshNames.push_back(nameOf(meshes[i], "mesh", i));
        readNodes();
        readChannels();
        tell(textured, "textures of its materials");
        tell(seeThrough, "alpha: all is opaque");
        tell(ranged_, "the range of lights: they fall off with the square of the distance");
        tell(skinned_, "skins");
        tell(out_.cameraNode && cameras_.size() > 1, "cameras after the first");
        return std::move(out_);
    }

private:
    void tell(bool left, const char* what) const {
        if (left && note_) note_(fmt::format("{}: left out: {}", name_, what));
    }

    std::vector<int> roots() const {
        std::vector<int> out;
        const auto scenes = listOf(root_, "scenes");
        if (!scenes.empty()) {
            const auto chosen = root_.find("scene");
            const auto& scene = scenes[chosen ? static_cast<std::size_t>(indexOf(*chosen, scenes.size())) : 0];
            for (const JsonField& item : listOf(scene, "nodes")) out.push_back(indexOf(item, nodes_.size()));
            return out;
        }
        std::vector<bool> isChild(nodes_.size());
        for (const JsonField& field : nodes_)
            for (const JsonField& child : listOf(field, "children"))
                isChild[static_cast<std::size_t>(indexOf(child, nodes_.size()))] = true;
        for (std::size_t i = 0; i < nodes_.size(); ++i)
            if (!isChild[i]) out.push_back(static_cast<int>(i));
        return out;
    }

    void readNodes() {
        out_.nodeOf.assign(nodes_.size(), -1);
        struct Waiting {
            int node, parent;  ///< glTF's index; the scene's
        };
        std::vector<Waiting> waiting;
        const std::vector<int> first = roots();
        for (auto at = first.rbegin(); at != first.rend(); ++at) waiting.push_back({*at, -1});
        while (!waiting.empty()) {
            const Waiting next = waiting.back();
            waiting.pop_back();
            const int self = addNode(next.node, next.parent);
            const auto children = listOf(nodes_[static_cast<std::size_t>(next.node)], "children");
            for (auto child = children.rbegin(); child != children.rend(); ++child) {
                const int index = indexOf(*child, nodes_.size());
                requireNoCycle(*child, index, self);
                waiting.push_back({index, self});
            }
        }
    }

    void requireNoCycle(const JsonField& field, int child, int parent) const {
        std::string cycle = nameOf(nodes_[static_cast<std::size_t>(child)], "node", static_cast<std::size_t>(child));
        for (int up = parent; up >= 0; up = out_.scene.nodes[static_cast<std::size_t>(up)].parent) {
            cycle = out_.scene.nodes[static_cast<std::size_t>(up)].name + " > " + cycle;
            if (up == out_.nodeOf[static_cast<std::size_t>(child)]) field.fail("expected no cycle, found " + cycle);
        }
    }

    int addNode(int index, int parent) {
        const auto i = static_cast<std::size_t>(index);
        const JsonField& field = nodes_[i];
        if (out_.nodeOf[i] >= 0) field.fail("expected a node under one parent, found it under two");
        SceneNode made = node(field, i, parent);
        const int self = static_cast<int>(out_.scene.nodes.size());
        out_.nodeOf[i] = self;
        ifThere(field, "mesh", [&](const JsonField& f) { made.mesh = indexOf(f, out_.meshNames.size()); });
        skinned_ = skinned_ || field.find("skin");
        if (const auto lamp = extension(field, kLights)) {
            const JsonField which = lamp->at("light");
            const auto& source = lights_[static_cast<std::size_t>(indexOf(which, lights_.size()))];
            out_.scene.lights.push_back({made.name, self, light(source, ranged_), SceneShadow{}});
        }
        if (const auto seen = field.find("camera"); seen && !out_.cameraNode) {
            out_.scene.camera = camera(cameras_[static_cast<std::size_t>(indexOf(*seen, cameras_.size()))]);
            out_.cameraNode = self;
        }
        out_.scene.nodes.push_back(std::move(made));
        return self;
    }

    void readChannels() {
        const auto animations = listOf(root_, "animations");
        tell(animations.size() > 1, "animations after the first");
        if (animations.empty()) return;
        bool weights = false, cubic = false;
        const auto samplers = listOf(animations[0], "samplers");
        for (const JsonField& field : listOf(animations[0], "channels")) {
            const JsonField target = field.at("target");
            const int path = target.at("path").choice({"translation", "rotation", "scale", "weights"});
            weights = weights || path == 3;
            const auto aimed = target.find("node");
            const auto& sampler = samplers[static_cast<std::size_t>(indexOf(field.at("sampler"), samplers.size()))];
            if (path == 3 || !aimed) continue;
            GltfChannel channel{indexOf(*aimed, nodes_.size()), static_cast<SceneTrack::Path>(path)};
            if (const auto way = sampler.find("interpolation")) {
                const int which = way->choice({"LINEAR", "STEP", "CUBICSPLINE"});
                channel.step = which == 1;
                cubic = cubic || which == 2;
            }
            if (out_.nodeOf[static_cast<std::size_t>(channel.gltfNode)] >= 0) out_.channels.push_back(channel);
        }
        tell(weights, "morph targets");
        tell(cubic, "cubic splines: their key frames are joined linearly");
    }

    std::string name_;
    JsonField root_;
    std::vector<JsonField> nodes_, lights_, cameras_;
    const std::function<void(const std::string&)>& note_;
    GltfScene out_;
    bool ranged_ = false, skinned_ = false;
};

}  // namespace

GltfScene gltfScene(const GltfFile& file, const std::function<void(const std::string&)>& note) {
    return Reader(file, note).read();
}

}  // namespace nacre
