#include "shading/multipass/scene_shadow_volumes.hpp"

#include <algorithm>

namespace nacre {
namespace {

/// Of a mesh's size: what lies so near a plane touches it.
constexpr double kTouching = 1e-6;

Bounds boxInWorld(const Bounds& box, const glm::dmat4& toWorld) {
    Bounds out;
    for (int corner = 0; corner < 8; ++corner)
        out.add(Vec3(toWorld * Vec4(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                                    corner & 4 ? box.high.z : box.low.z, 1)));
    return out;
}

enum class Where { InFront, Behind, Across };

/// \param plane  in the mesh's space; its normal isn't unit
Where whereIs(const ShadowMesh& mesh, const Bounds& box, const Plane& plane) {
    const double touching = kTouching * glm::length(Vec3(plane)) * glm::length(box.high - box.low);
    bool inFront = false, behind = false;
    for (const glm::vec3& p : mesh.positions) {
        const double height = glm::dot(plane, Vec4(p, 1));
        inFront = inFront || height > touching;
        behind = behind || height < -touching;
        if (inFront && behind) return Where::Across;
    }
    return inFront ? Where::InFront : Where::Behind;
}

}  // namespace

const SceneShadowVolumes::Object& SceneShadowVolumes::objectOf(std::size_t node) {
    const int mesh = scene_->nodes[node].mesh;
    return objects_.try_emplace(mesh, scene_->meshes[static_cast<std::size_t>(mesh)].mesh).first->second;
}

/// Made, if it isn't there or something moved.
SceneShadowVolumes::Stored& SceneShadowVolumes::stored(const Key& key, const Object& object, const glm::dmat4& toWorld,
                                                       const Vec4& light, const std::vector<Plane>& cuts) {
    const auto [at, fresh] = stored_.try_emplace(key);
    Stored& out = at->second;
    if (out.used) return out;  // of another source with the same name
    out.used = true;
    const bool same = !fresh && out.toWorld == toWorld && out.light == light && out.cuts == cuts;
    ++(same ? counts_.kept : counts_.made);
    if (!same) {
        out.toWorld = toWorld;
        out.light = light;
        out.cuts = cuts;
        out.cutsInMesh.clear();
        for (const Plane& cut : cuts) out.cutsInMesh.push_back(cut * toWorld);
        out.volume.reset();
        out.points.reset();
        ShadowVolume volume;
        const GpuShadowPoints* pieces = nullptr;
        if (cuts.empty()) {
            volume = makeShadowVolume(object.shape, toWorld, light);
        } else {
            const CutShadowMesh cut = cutShadowMesh(object.shape, out.cutsInMesh);
            volume = makeShadowVolume(object.shape, cut, toWorld, light);
            if (!volume.empty()) pieces = &out.points.emplace(cut.pieces);
        }
        out.mostLayers = volume.mostLayers();
        out.bytesAPolygon = bytesOfVolumeAPolygon(object.shape, light);
        if (!volume.empty()) out.volume.emplace(*object.points, volume, pieces);
    }
    if (out.volume) counts_.bytes += out.volume->bytes();
    if (out.points) counts_.pointBytes += out.points->bytes();
    counts_.bytesAPolygon += out.bytesAPolygon;
    return out;
}

PlacedShadowVolume SceneShadowVolumes::placed(const Stored& stored, const Object& object, const glm::dmat4& toLast) {
    PlacedShadowVolume out{&*stored.volume, toLast * stored.toWorld, {}, stored.mostLayers};
    out.box = boxInWorld(object.box, out.toWorld);
    out.image = toLast != glm::dmat4(1);
    out.mirrored = glm::determinant(Mat3(toLast)) < 0;
    out.cuts = stored.cutsInMesh;
    return out;
}

void SceneShadowVolumes::update(const std::vector<glm::dmat4>& nodes, std::span<const ShadowSource> sources) {
    counts_ = {};
    nodes_ = nodes;
    placed_.assign(sources.size(), {});
    for (auto& [key, stored] : stored_) stored.used = false;
    for (std::size_t s = 0; s < sources.size(); ++s)
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            const ShadowSource& source = sources[s];
            const bool inPlane = std::find(source.faces.begin(), source.faces.end(), n) != source.faces.end();
            if (scene_->nodes[n].mesh < 0 || !scene_->nodes[n].castsShadow || inPlane) continue;
            const Object& object = objectOf(n);
            std::vector<Plane> cuts;
            std::vector<std::size_t> cutters;
            bool behind = false;
            for (std::size_t i = 0; i < source.within.size() && !behind; ++i) {
                const Where where = whereIs(object.shape, object.box, source.within[i] * nodes[n]);
                behind = where == Where::Behind;
                if (where != Where::Across) continue;
                cuts.push_back(source.within[i]);
                cutters.push_back(source.faces[i]);
            }
            if (behind) continue;
            const Stored& kept = stored({source.name, n, cutters}, object, nodes[n], source.light, cuts);
            if (kept.volume) placed_[s].push_back(placed(kept, object, source.toLast));
        }
    for (const auto& [mesh, object] : objects_)
        if (object.points) counts_.pointBytes += object.points->bytes();
}

std::optional<PlacedShadowVolume> SceneShadowVolumes::ofFace(std::size_t node, const ShadowSource& seen) {
    const Object& object = objectOf(node);
    const Stored& kept = stored({seen.name, node, {}}, object, nodes_[node], seen.light, {});
    if (!kept.volume) return {};
    return placed(kept, object, seen.toLast);
}

void SceneShadowVolumes::forgetUnused() {
    std::erase_if(stored_, [](const auto& entry) { return !entry.second.used; });
}

}  // namespace nacre
