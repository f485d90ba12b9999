#include "shading/scene_objects.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "core/error.hpp"
#include "factorize/models/models.hpp"
#include "shading/multipass/face_image.hpp"
#include "shading/pass_state.hpp"

namespace nacre {
namespace {

constexpr int kEnvironmentUnit = kMaxFactoredTextures, kReliefUnit = kEnvironmentUnit + kEnvironmentUnits;

DrawnMesh upload(const Mesh& mesh) {
    DrawnMesh out;
    if (mesh.triangles.empty()) return out;
    out.gpu.emplace(mesh);
    out.box = boundsOf(mesh);
    out.centre = 0.5 * (out.box.low + out.box.high);
    out.radius = 0.5 * glm::length(out.box.high - out.box.low);
    return out;
}

bool sameMesh(const Mesh& a, const Mesh& b) {
    return a.triangles == b.triangles && a.positions == b.positions && a.normals == b.normals &&
           a.tangents == b.tangents && a.uvs == b.uvs;
}

}  // namespace

SceneObjects::SceneObjects(ProgramLoader& loader, SceneDescription&& scene)
    : loader_(loader), scene_(std::move(scene)), assets_(scene_.assets), traits_(assets_.traits()) {
    checkScene(scene_, traits_);
    for (const SceneMesh& mesh : scene_.meshes) meshes_.push_back(upload(mesh.mesh));
    for (const SceneVolume& volume : scene_.volumes) volumes_.try_emplace(volume.volume, *volume.volume);
    prepareModels();
}

void SceneObjects::prepareModels() {
    models_.clear();
    for (const SceneMaterial& m : scene_.materials) {
        const std::string model = directModelOf(scene_, m, traits_);
        models_.push_back(model.empty() ? std::nullopt : directBrdf(makeModel(model)));
    }
    for (const SceneMaterial& m : scene_.materials)
        if (m.specular && m.specular->texture)
            faceTextures_.try_emplace(m.specular->texture, *m.specular->texture, Filter::Linear);
    faceImages_.reset();
    if (const Image images = nacre::faceImages(scene_); !images.empty()) faceImages_.emplace(images);
}

EnvironmentLookup SceneObjects::lookup(const SceneLookup& l) const {
    if (l.asset < 0) return {};
    return {&asset(l.asset).environment.value(), l.lod, l.color};
}

EnvironmentSurface SceneObjects::surfaceOf(const SceneSurrounding& s) const {
    EnvironmentSurface out;
    out.reflection = lookup(s.reflection);
    out.transmission = lookup(s.transmission);
    out.diffuse = lookup(s.diffuse);
    out.ior = s.ior;
    if (s.table >= 0) out.table = &asset(s.table).table.value();
    out.f0 = s.f0;
    out.perceptualRoughness = s.perceptualRoughness;
    out.multipleScattering = s.multipleScattering;
    out.combine = s.blend ? EnvironmentCombine::Blend : EnvironmentCombine::Add;
    out.fromWorld = worldToSky();
    return out;
}

const DrawnMesh* SceneObjects::meshOf(std::size_t node) const {
    const int mesh = scene_.nodes[node].mesh;
    if (mesh < 0 || !meshes_[static_cast<std::size_t>(mesh)].gpu) return nullptr;
    return &meshes_[static_cast<std::size_t>(mesh)];
}

std::optional<VolumeSurface> SceneObjects::volumeOf(std::size_t node, const glm::dmat4& toWorld) const {
    if (scene_.nodes[node].volume < 0) return {};
    const SceneVolume& volume = scene_.volumes[static_cast<std::size_t>(scene_.nodes[node].volume)];
    return VolumeSurface{&volumes_.at(volume.volume), volume.iso, toWorld, volume.method, volume.step};
}

void SceneObjects::updateNodeLights(const SceneSwitches& on, const std::vector<glm::dmat4>& nodes,
                                    const std::vector<Light>& lights) {
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
        if (!meshOf(i) || !takesLamps(scene_, materialOf(i), on)) continue;
        const std::optional<SceneRelief> relief = reliefOf(materialOf(i), traits_, on);
        if (!relief || relief->indirectLight < 0) continue;
        nodeLights_[i].update(loader_, {*relief, assets_, scene_.assets[static_cast<std::size_t>(relief->asset)].file,
                                        scene_.meshes[static_cast<std::size_t>(scene_.nodes[i].mesh)].mesh, nodes[i],
                                        lights[static_cast<std::size_t>(relief->indirectLight)]});
    }
}

BumpSurface SceneObjects::bumpOf(std::size_t node, const SceneRelief& relief, bool lamps) const {
    BumpSurface out{&asset(relief.asset).bump.value(), relief.shadow, relief.tiles, relief.roughness};
    if (!lamps || relief.indirectLight < 0) return out;
    out.indirect = nodeLights_.at(node).scattered();
    out.indirectLight = relief.indirectLight;
    return out;
}

Bounds SceneObjects::box(const std::vector<glm::dmat4>& nodes) const {
    Bounds out;
    const auto corner = [](int i) { return Vec3(i & 1, (i >> 1) & 1, (i >> 2) & 1); };
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
        const std::optional<VolumeSurface> volume = volumeOf(i, nodes[i]);
        const DrawnMesh* mesh = meshOf(i);
        for (int k = 0; k < 8; ++k) {
            if (volume) out.add(Vec3(volumeBox(*volume) * Vec4(corner(k), 1)));
            if (mesh) out.add(Vec3(nodes[i] * Vec4(glm::mix(mesh->box.low, mesh->box.high, corner(k)), 1)));
        }
    }
    return out;
}

void SceneObjects::bindMaterial(const Program& program, std::size_t node, const SceneSwitches& on,
                                const LitView& view) const {
    const SceneMaterial& m = materialOf(node);
    const bool lamps = takesLamps(scene_, m, on);
    const bool vertex = lamps && on.reflectance == SceneReflectance::FastPhong;
    if (lamps) {
        const auto& model = models_[static_cast<std::size_t>(scene_.nodes[node].material)];
        if (m.brdf < 0 || (on.reflectance == SceneReflectance::Direct && model))
            model->bind(program);
        else
            asset(m.brdf).brdf->bind(program);
    }
    if (m.surrounding && on.surrounding && !vertex)
        bindEnvironment(program, surfaceOf(*m.surrounding), kEnvironmentUnit);
    const std::optional<SceneRelief> relief = reliefOf(m, traits_, on);
    if (relief && !vertex) bindBump(program, bumpOf(node, *relief, lamps), kReliefUnit);
    if (m.specular && m.specular->texture) {
        faceTextures_.at(m.specular->texture).bind(kReliefUnit);  // checkSpecular: there is no relief
        program.set("nacre_face_texture", kReliefUnit);
    }
    setLights(program, view);
}

const Texture* SceneObjects::faceTextureOf(const SceneSpecular& specular) const {
    return specular.texture ? &faceTextures_.at(specular.texture) : nullptr;
}

const Buffer* SceneObjects::radianceOf(std::size_t node) const {
    const auto found = nodeRadiance_.find(node);
    return found == nodeRadiance_.end() ? nullptr : &found->second;
}

Mat3 SceneObjects::worldToSky() const { return Mat3(glm::rotate(glm::dmat4(1), -scene_.sky.rotationY, Vec3(0, 1, 0))); }

void SceneObjects::setIndirectLight(const std::vector<std::vector<glm::vec3>>& radiance) {
    require(radiance.size() == scene_.nodes.size(), "scene: expected a list of radiance for each node");
    for (std::size_t i = 0; i < radiance.size(); ++i) {
        const int mesh = scene_.nodes[i].mesh;
        const std::size_t vertices = mesh < 0 ? 0 : scene_.meshes[static_cast<std::size_t>(mesh)].mesh.positions.size();
        require(
            radiance[i].empty() || radiance[i].size() == vertices,
            fmt::format("scene: expected {} vertices' radiance at node {}, found {}", vertices, i, radiance[i].size()));
    }
    nodeRadiance_.clear();
    for (std::size_t i = 0; i < radiance.size(); ++i) {
        if (radiance[i].empty()) continue;
        glBindBuffer(GL_ARRAY_BUFFER, nodeRadiance_[i].name());
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(radiance[i].size() * sizeof(glm::vec3)),
                     radiance[i].data(), GL_STATIC_DRAW);
    }
    glBindBuffer(GL_ARRAY_BUFFER, 0);
}

void SceneObjects::setScene(SceneDescription&& next) {
    SceneAssets nextAssets = assets_;
    nextAssets.open(next.assets);
    std::vector<AssetTraits> nextTraits = nextAssets.traits();
    checkScene(next, nextTraits);
    std::vector<DrawnMesh> nextMeshes(next.meshes.size());
    std::vector<std::pair<std::size_t, std::size_t>> moves;
    std::vector<bool> taken(meshes_.size(), false);
    for (std::size_t i = 0; i < next.meshes.size(); ++i) {
        std::size_t old = 0;
        while (old < meshes_.size() && (taken[old] || !sameMesh(scene_.meshes[old].mesh, next.meshes[i].mesh))) ++old;
        if (old == meshes_.size()) {
            nextMeshes[i] = upload(next.meshes[i].mesh);
            continue;
        }
        taken[old] = true;
        moves.emplace_back(old, i);
    }
    std::map<std::shared_ptr<const Volume>, GpuVolume> nextVolumes;
    for (const SceneVolume& volume : next.volumes)
        if (volumes_.count(volume.volume) == 0) nextVolumes.try_emplace(volume.volume, *volume.volume);
    for (const SceneVolume& volume : next.volumes)
        if (auto node = volumes_.extract(volume.volume)) nextVolumes.insert(std::move(node));
    for (const auto& [from, to] : moves) nextMeshes[to] = std::move(meshes_[from]);
    scene_ = std::move(next);
    assets_ = std::move(nextAssets);
    traits_ = std::move(nextTraits);
    meshes_ = std::move(nextMeshes);
    volumes_ = std::move(nextVolumes);
    nodeLights_.clear();
    faceTextures_.clear();
    nodeRadiance_.clear();
    prepareModels();
}

std::vector<AssetChange> SceneObjects::reloadAssets() {
    std::vector<AssetChange> changes =
        assets_.reload([this](const std::vector<AssetTraits>& traits) { checkScene(scene_, traits); });
    if (!changes.empty()) {
        traits_ = assets_.traits();
        prepareModels();
    }
    return changes;
}

}  // namespace nacre
