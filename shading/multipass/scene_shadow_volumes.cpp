#include "shading/multipass/scene_shadow_volumes.hpp"

namespace nacre {

static Bounds boxInWorld(const Bounds& box, const glm::dmat4& toWorld) {
    Bounds out;
    for (int corner = 0; corner < 8; ++corner)
        out.add(Vec3(toWorld * Vec4(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                                    corner & 4 ? box.high.z : box.low.z, 1)));
    return out;
}

void SceneShadowVolumes::store(Stored& stored, const Object& object, const glm::dmat4& toWorld, const Vec4& light) {
    const ShadowVolume volume = makeShadowVolume(object.shape, toWorld, light);
    stored.toWorld = toWorld;
    stored.light = light;
    stored.mostLayers = volume.mostLayers();
    stored.bytesAPolygon = bytesOfVolumeAPolygon(object.shape, light);
    stored.box = boxInWorld(object.box, toWorld);
    stored.volume.reset();
    if (!volume.indices.empty()) stored.volume.emplace(*object.points, volume);
}

void SceneShadowVolumes::update(const std::vector<glm::dmat4>& nodes, std::span<const Vec4> lights) {
    counts_ = {};
    stored_.erase(stored_.lower_bound({lights.size(), 0}), stored_.end());
    for (std::size_t l = 0; l < lights.size(); ++l)
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            const bool casts = scene_->nodes[n].mesh >= 0 && scene_->nodes[n].castsShadow;
            if (!casts) {
                stored_.erase({l, n});
                continue;
            }
            const int mesh = scene_->nodes[n].mesh;
            const Object& object =
                objects_.try_emplace(mesh, scene_->meshes[static_cast<std::size_t>(mesh)].mesh).first->second;
            const auto [at, fresh] = stored_.try_emplace({l, n});
            const bool same = !fresh && at->second.toWorld == nodes[n] && at->second.light == lights[l];
            if (!same) store(at->second, object, nodes[n], lights[l]);
            ++(same ? counts_.kept : counts_.made);
            if (at->second.volume) counts_.bytes += at->second.volume->bytes();
            counts_.bytesAPolygon += at->second.bytesAPolygon;
        }
    for (const auto& [mesh, object] : objects_)
        if (object.points) counts_.pointBytes += object.points->bytes();
}

std::vector<PlacedShadowVolume> SceneShadowVolumes::of(std::size_t light) const {
    std::vector<PlacedShadowVolume> out;
    for (auto at = stored_.lower_bound({light, 0}); at != stored_.end() && at->first.first == light; ++at)
        if (at->second.volume)
            out.push_back({&*at->second.volume, at->second.toWorld, at->second.box, at->second.mostLayers});
    return out;
}

}  // namespace nacre
