#include "shading/scene_programs.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bump/bump_asset.hpp"
#include "core/error.hpp"
#include "envmaps/env_asset.hpp"
#include "factorize/factored_brdf.hpp"
#include "factorize/models/models.hpp"
#include "shading/environment_pass.hpp"
#include "shading/gpu_direct_brdf.hpp"
#include "shading/mesh_attributes.hpp"
#include "shading/multipass/specular_face.hpp"
#include "shading/pass_state.hpp"
#include "shading/shadow_map.hpp"

namespace nacre {
namespace {

constexpr const char* kKinds[] = {"brdf", "environment", "fresnel", "scale_bias", "bump"};

bool isEllipse(BumpShadow shadow) { return shadow == BumpShadow::HardEllipse || shadow == BumpShadow::Ellipse; }
bool isHorizon(BumpShadow shadow) { return shadow == BumpShadow::HardHorizon || shadow == BumpShadow::Horizon; }

bool has(const AssetTraits& asset, BumpShadow shadow) {
    return isEllipse(shadow) ? asset.ellipses : isHorizon(shadow) ? asset.horizons : true;
}

const AssetTraits& at(const std::vector<AssetTraits>& assets, int index) {
    return assets.at(static_cast<std::size_t>(index));
}

std::optional<GpuDirectBrdf> directOf(const std::string& model) {
    if (model.empty()) return {};
    try {
        return directBrdf(makeModel(model));
    } catch (const std::invalid_argument&) {
        return {};  // a file, or a model that the asset knows by another name
    }
}

/// Checks one material; `where` says which.
class MaterialCheck {
public:
    MaterialCheck(const SceneDescription& scene, const std::vector<AssetTraits>& assets, std::string where)
        : scene_(scene), assets_(assets), where_(std::move(where)) {}

    void operator()(const SceneMaterial& m) const {
        index(m.brdf, assets_.size(), "brdf");
        kind(m.brdf, "brdf", {"brdf"});
        require(isFinite(m.ambient), where_ + ": ambient must be finite");
        if (!m.model.empty()) model(m.model);
        if (m.relief) relief(*m.relief);
        if (m.surrounding) surrounding(*m.surrounding);
    }
    void index(int value, std::size_t count, const char* member) const {
        require(value >= -1 && value < static_cast<int>(count),
                fmt::format("{}: {}: expected an index below {}, found {}", where_, member, count, value));
    }
    void kind(int asset, const char* member, std::initializer_list<const char*> kinds) const {
        index(asset, assets_.size(), member);
        if (asset < 0) return;
        std::string wanted;
        for (const char* one : kinds) {
            if (at(assets_, asset).kind == one) return;
            wanted += (wanted.empty() ? "" : " or ") + std::string(one);
        }
        throw Error(fmt::format("{}: {}: expected an asset of kind {}, found '{}' of kind {}", where_, member, wanted,
                                scene_.assets[static_cast<std::size_t>(asset)].name, at(assets_, asset).kind));
    }

private:
    void model(const std::string& text) const {
        std::optional<GpuDirectBrdf> direct;
        try {
            direct = directBrdf(makeModel(text));
        } catch (const std::invalid_argument& error) {
            throw Error(fmt::format("{}: model: {}", where_, error.what()));
        }
        if (!direct) throw Error(fmt::format("{}: model: '{}' has no form for shaders", where_, text));
    }
    void relief(const SceneRelief& r) const {
        kind(r.asset, "relief", {"bump"});
        require(r.asset >= 0, where_ + ": relief: no asset");
        index(r.indirectLight, scene_.lights.size(), "relief: light");
        require(std::isfinite(r.tiles.x) && std::isfinite(r.tiles.y) && r.tiles.x > 0 && r.tiles.y > 0,
                fmt::format("{}: relief: expected tiles finite, > 0, found {} and {}", where_, r.tiles.x, r.tiles.y));
        const AssetTraits& asset = at(assets_, r.asset);
        const auto needs = [&](bool there, const char* what) {
            if (!there)
                throw Error(fmt::format("{}: relief: expected {} in '{}', found none", where_, what,
                                        scene_.assets[static_cast<std::size_t>(r.asset)].name));
        };
        needs(has(asset, r.shadow), isEllipse(r.shadow) ? "ellipses" : "horizons");
        needs(!r.roughness || asset.roughness, "normals with roughness");
        needs(r.indirectLight < 0 || asset.scatter, "a scatter map");
        needs(r.indirectLight < 0 || asset.heights, "heights");
    }
    void surrounding(const SceneSurrounding& s) const {
        const AssetTraits* first = nullptr;
        for (const auto& [member, lookup] : {std::pair{"surrounding: reflection", &s.reflection},
                                             {"surrounding: transmission", &s.transmission},
                                             {"surrounding: diffuse", &s.diffuse}}) {
            kind(lookup->asset, member, {"environment"});
            require(std::isfinite(lookup->lod), fmt::format("{}: {}: lod must be finite", where_, member));
            if (lookup->asset < 0) continue;
            const AssetTraits& asset = at(assets_, lookup->asset);
            if (first == nullptr) first = &asset;
            if (asset.layout != first->layout)
                throw Error(fmt::format("{}: surrounding: expected maps of one layout, found {} and {}", where_,
                                        toString(first->layout), toString(asset.layout)));
        }
        kind(s.table, "surrounding: table", {"fresnel", "scale_bias"});
        require(std::isfinite(s.ior) && s.ior > 0, where_ + ": surrounding: ior must be finite, > 0");
    }

    const SceneDescription& scene_;
    const std::vector<AssetTraits>& assets_;
    std::string where_;
};

std::string called(const char* what, const std::string& name, std::size_t index) {
    return name.empty() ? fmt::format("{} {}", what, index) : fmt::format("{} '{}'", what, name);
}

/// A relief lies in the mesh's uv.
void checkUv(const SceneDescription& scene, const SceneNode& node, const std::string& where) {
    if (node.mesh < 0) return;
    const SceneMaterial& material = scene.materials[static_cast<std::size_t>(node.material)];
    const SceneMesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
    if (material.relief && !mesh.mesh.triangles.empty() && !hasUv(mesh.mesh))
        throw Error(fmt::format("{}: expected a mesh with uv for the relief of '{}', found none in '{}'", where,
                                material.name, mesh.name));
}

EnvironmentWeight weightOf(const SceneSurrounding& s, const std::vector<AssetTraits>& assets) {
    if (s.table < 0) return EnvironmentWeight::One;
    if (at(assets, s.table).kind == "fresnel") return EnvironmentWeight::Fresnel;
    return s.multipleScattering ? EnvironmentWeight::ScaleBiasMultiple : EnvironmentWeight::ScaleBias;
}

ShaderDefines surroundingDefines(const SceneSurrounding& s, const std::vector<AssetTraits>& assets) {
    EnvironmentChoices choices;
    for (const auto& [lookup, used] : {std::pair{&s.reflection, &choices.reflection},
                                       {&s.transmission, &choices.transmission},
                                       {&s.diffuse, &choices.diffuse}}) {
        *used = lookup->asset >= 0;
        if (*used) choices.layout = at(assets, lookup->asset).layout;
    }
    choices.weight = weightOf(s, assets);
    choices.combine = s.blend ? EnvironmentCombine::Blend : EnvironmentCombine::Add;
    return environmentDefines(choices);
}

/// What maps will look like, whatever they are fitted to.
ShaderDefines shadowDefinesOf(const SceneDescription& scene) {
    Bounds box;
    box.add(Vec3(-1));
    box.add(Vec3(1));
    std::vector<ShadowView> views;
    for (const SceneLight& light : scene.lights)
        views.push_back(light.shadow ? fitShadow(*light.shadow, light.light, box, &scene.camera) : ShadowView());
    std::vector<const ShadowView*> used;
    for (std::size_t i = 0; i < views.size(); ++i) used.push_back(scene.lights[i].shadow ? &views[i] : nullptr);
    return shadowDefines(used);
}

ShaderDefines brdfDefines(const SceneDescription& scene, const SceneMaterial& m, const std::vector<AssetTraits>& assets,
                          SceneReflectance reflectance) {
    if (m.brdf >= 0 && reflectance != SceneReflectance::Direct) return at(assets, m.brdf).brdf;
    const std::optional<GpuDirectBrdf> direct = directOf(directModelOf(scene, m, assets));
    return direct ? direct->defines() : at(assets, m.brdf).brdf;
}

}  // namespace

AssetTraits traitsOf(const Asset& asset, const std::string& name) {
    AssetTraits out;
    out.kind = asset.kind;
    if (std::find(std::begin(kKinds), std::end(kKinds), asset.kind) == std::end(kKinds))
        throw Error(fmt::format("{}: expected an asset of kind {}, found kind '{}'", name, fmt::join(kKinds, ", "),
                                asset.kind));
    if (const auto source = asset.meta.find("source"); source != asset.meta.end() && source->is_string())
        out.source = source->get<std::string>();
    if (asset.kind == "brdf") out.brdf = factoredDefines(factoredFromAsset(asset, name));
    if (asset.kind == "environment") out.layout = envFromAsset(asset, name).levels.front().layout;
    if (asset.kind == "bump") {
        const BumpMaps maps = bumpFromAsset(asset, name);
        if (!maps.normals) throw Error(fmt::format("{}: expected normals, found none", name));
        out.wrap = maps.wrap;
        out.ellipses = maps.ellipses.has_value();
        out.horizons = maps.horizons.has_value();
        out.roughness = maps.normals->levels.front().channels() == 4;
        out.scatter = maps.scatter.has_value();
        out.heights = maps.heights.has_value();
    }
    return out;
}

void checkScene(const SceneDescription& scene, const std::vector<AssetTraits>& assets) {
    require(assets.size() == scene.assets.size(), "checkScene: expected the traits of each asset");
    if (scene.lights.size() > static_cast<std::size_t>(kMaxLights))
        throw Error(fmt::format("{}: expected at most {} lights, found {}",
                                scene.file.empty() ? "scene" : scene.file.string(), kMaxLights, scene.lights.size()));
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        MaterialCheck(scene, assets, called("material", scene.materials[i].name, i))(scene.materials[i]);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const SceneNode& node = scene.nodes[i];
        const MaterialCheck check(scene, assets, called("node", node.name, i));
        check.index(node.parent, i, "parent");
        check.index(node.mesh, scene.meshes.size(), "mesh");
        check.index(node.material, scene.materials.size(), "material");
        check.index(node.volume, scene.volumes.size(), "volume");
        require((node.mesh < 0 && node.volume < 0) == (node.material < 0) && (node.mesh < 0 || node.volume < 0),
                called("node", node.name, i) + ": expected mesh or volume and material, or none");
        if (node.volume >= 0 && scene.materials[static_cast<std::size_t>(node.material)].relief)
            throw Error(called("node", node.name, i) + ": expected a material without relief for a volume, found '" +
                        scene.materials[static_cast<std::size_t>(node.material)].name + "'");
        checkUv(scene, node, called("node", node.name, i));
    }
    for (std::size_t i = 0; i < scene.volumes.size(); ++i) {
        const SceneVolume& volume = scene.volumes[i];
        require(volume.volume != nullptr, called("volume", volume.name, i) + ": none");
        require(std::isfinite(volume.iso) && std::isfinite(volume.step) && volume.step > 0,
                called("volume", volume.name, i) + ": expected iso and step finite, step > 0");
    }
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        MaterialCheck(scene, assets, called("light", scene.lights[i].name, i))
            .index(scene.lights[i].node, scene.nodes.size(), "node");
    for (const SceneTrack& track : scene.tracks)
        require(track.node >= 0 && track.node < static_cast<int>(scene.nodes.size()) && !track.times.empty() &&
                    track.times.size() == track.values.size(),
                "scene: a track needs a node, times, and a value for each");
    checkSpecular(scene);
    MaterialCheck(scene, assets, "sky").kind(scene.sky.asset, "asset", {"environment"});
    require(std::isfinite(scene.sky.rotationY) && std::isfinite(scene.sky.lod), "sky: expected finite numbers");
}

std::optional<SceneRelief> reliefOf(const SceneMaterial& material, const std::vector<AssetTraits>& assets,
                                    const SceneSwitches& switches) {
    if (!material.relief || !switches.relief) return {};
    SceneRelief out = *material.relief;
    if (switches.reliefShadow && has(at(assets, out.asset), *switches.reliefShadow))
        out.shadow = *switches.reliefShadow;
    if (!switches.indirect || !switches.lamps) out.indirectLight = -1;
    return out;
}

std::string directModelOf(const SceneDescription& scene, const SceneMaterial& m,
                          const std::vector<AssetTraits>& assets) {
    if (m.brdf < 0) return m.model;
    for (const std::string& source : {scene.assets[static_cast<std::size_t>(m.brdf)].source, at(assets, m.brdf).source})
        if (directOf(source)) return source;
    return {};
}

int usualLightDepth(const SceneDescription& scene) {
    const bool volumes =
        std::any_of(scene.nodes.begin(), scene.nodes.end(), [](const SceneNode& node) { return node.volume >= 0; });
    return volumes ? 0 : SpecularOptions().lightDepth;
}

bool takesLamps(const SceneDescription& scene, const SceneMaterial& material, const SceneSwitches& switches) {
    return switches.lamps && !scene.lights.empty() && (material.brdf >= 0 || !material.model.empty());
}

bool mapsShadows(const SceneSwitches& switches) {
    return switches.shadows && switches.shadowMethod == ShadowMethod::Maps;
}

SceneProgram materialProgram(const SceneDescription& scene, const SceneMaterial& m,
                             const std::vector<AssetTraits>& assets, const SceneSwitches& switches,
                             const ShaderDefines& shadows) {
    const bool lamps = takesLamps(scene, m, switches);
    std::vector<Light> lights;
    for (const SceneLight& light : scene.lights) lights.push_back(light.light);
    if (lamps && switches.reflectance == SceneReflectance::FastPhong) {
        if (lights.size() > static_cast<std::size_t>(kMaxVertexLights)) lights.resize(kMaxVertexLights);
        return {"lit_vertex.vert.glsl", "lit_vertex.frag.glsl",
                withLights(brdfDefines(scene, m, assets, switches.reflectance), lights)};
    }
    ShaderDefines defines;
    if (lamps) {
        defines = brdfDefines(scene, m, assets, switches.reflectance);
        defines.emplace_back("NACRE_SCENE_LAMPS", "1");
        defines = joined(std::move(defines), shadows);
    }
    defines = withLights(std::move(defines), lights);
    if (m.surrounding && switches.surrounding) {
        defines.emplace_back("NACRE_SCENE_SURROUNDING", "1");
        defines = joined(std::move(defines), surroundingDefines(*m.surrounding, assets));
    }
    if (m.specular && m.specular->texture) defines.emplace_back("NACRE_FACE_TEXTURE", "1");
    if (const auto relief = reliefOf(m, assets, switches))
        defines = joined(std::move(defines), bumpDefines(relief->shadow, at(assets, relief->asset).wrap,
                                                         relief->roughness, lamps ? relief->indirectLight : -1));
    return {"lit.vert.glsl", "scene.frag.glsl", std::move(defines)};
}

ShaderDefines viewDefines(const SceneDescription& scene) {
    return hasSpecular(scene) ? ShaderDefines{{"NACRE_VIEW", "1"}} : ShaderDefines();
}

SceneSwitches volumeSwitches(SceneSwitches switches) {
    if (switches.reflectance == SceneReflectance::FastPhong) switches.reflectance = SceneReflectance::FactoredOrModel;
    return switches;
}

SceneProgram volumeProgram(const SceneDescription& scene, const SceneVolume& volume, const SceneMaterial& m,
                           const std::vector<AssetTraits>& assets, const SceneSwitches& switches,
                           const ShaderDefines& shadows) {
    SceneProgram out = materialProgram(scene, m, assets, volumeSwitches(switches), shadows);
    out.vertex = "volume.vert.glsl";
    out.fragment = "volume.frag.glsl";
    if (volume.method == VolumeMethod::March) out.defines.emplace_back("NACRE_VOLUME_MARCH", "1");
    return out;
}

std::vector<ListedProgram> scenePrograms(const SceneDescription& scene, const std::vector<AssetTraits>& assets,
                                         const SceneSwitches& switches) {
    const ShaderDefines shadows = mapsShadows(switches) ? shadowDefinesOf(scene) : ShaderDefines();
    std::vector<ListedProgram> out;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const SceneNode& node = scene.nodes[i];
        if (node.material < 0) continue;
        const SceneMaterial& material = scene.materials.at(static_cast<std::size_t>(node.material));
        const ShaderDefines received = node.receivesShadow ? shadows : ShaderDefines();
        SceneProgram program = node.mesh >= 0
                                   ? materialProgram(scene, material, assets, switches, received)
                                   : volumeProgram(scene, scene.volumes.at(static_cast<std::size_t>(node.volume)),
                                                   material, assets, switches, received);
        program.defines = joined(std::move(program.defines), viewDefines(scene));
        auto known = std::find_if(out.begin(), out.end(), [&](const ListedProgram& p) { return p.program == program; });
        if (known == out.end()) known = out.insert(out.end(), {std::move(program), {}});
        known->nodes.push_back(static_cast<int>(i));
    }
    if (scene.sky.asset >= 0 && switches.sky) {
        EnvironmentChoices sky;
        sky.layout = at(assets, scene.sky.asset).layout;
        sky.reflection = true;
        out.push_back({{"sky.vert.glsl", "sky.frag.glsl", joined(environmentDefines(sky), viewDefines(scene))}, {}});
    }
    return out;
}

}  // namespace nacre
