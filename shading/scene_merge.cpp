#include "shading/scene_merge.hpp"

#include <algorithm>
#include <utility>

namespace nacre {

static void shift(int& index, int by) {
    if (index >= 0) index += by;
}

MergedParts mergeParts(SceneDescription& to, SceneDescription& from, const std::string& prefix) {
    const MergedParts parts{static_cast<int>(to.assets.size()), static_cast<int>(to.meshes.size()),
                            static_cast<int>(to.volumes.size()), static_cast<int>(to.materials.size())};
    const int lights = static_cast<int>(to.lights.size());  // of the instance that comes next
    for (SceneAsset& asset : std::exchange(from.assets, {})) {
        asset.name = prefix + asset.name;
        to.assets.push_back(std::move(asset));
    }
    for (SceneMesh& mesh : from.meshes) {
        mesh.name = prefix + mesh.name;
        to.meshes.push_back(std::move(mesh));
    }
    from.meshes.clear();
    for (SceneVolume& volume : std::exchange(from.volumes, {})) {
        volume.name = prefix + volume.name;
        to.volumes.push_back(std::move(volume));
    }
    for (SceneMaterial& material : std::exchange(from.materials, {})) {
        material.name = prefix + material.name;
        shift(material.brdf, parts.assets);
        if (material.relief) {
            shift(material.relief->asset, parts.assets);
            shift(material.relief->indirectLight, lights);
        }
        if (SceneSurrounding* s = material.surrounding ? &*material.surrounding : nullptr)
            for (int* asset : {&s->reflection.asset, &s->transmission.asset, &s->diffuse.asset, &s->table})
                shift(*asset, parts.assets);
        to.materials.push_back(std::move(material));
    }
    return parts;
}

void mergeInstance(SceneDescription& to, const SceneDescription& from, const MergedParts& parts, int parent,
                   int material) {
    const int nodes = static_cast<int>(to.nodes.size());
    const std::string prefix = to.nodes[static_cast<std::size_t>(parent)].name + "/";
    for (SceneNode node : from.nodes) {
        node.name = prefix + node.name;
        node.parent = node.parent < 0 ? parent : node.parent + nodes;
        shift(node.mesh, parts.meshes);
        shift(node.volume, parts.volumes);
        if (node.material >= 0) node.material = material >= 0 ? material : node.material + parts.materials;
        to.nodes.push_back(std::move(node));
    }
    for (SceneLight light : from.lights) {
        light.name = prefix + light.name;
        light.node = light.node < 0 ? parent : light.node + nodes;
        to.lights.push_back(std::move(light));
    }
    for (SceneTrack track : from.tracks) {
        track.node += nodes;
        to.tracks.push_back(std::move(track));
    }
    to.duration = std::max(to.duration, from.duration);
}

void markMoving(SceneDescription& scene) {
    for (const SceneTrack& track : scene.tracks) scene.nodes[static_cast<std::size_t>(track.node)].isStatic = false;
    for (SceneNode& node : scene.nodes)
        if (node.parent >= 0 && !scene.nodes[static_cast<std::size_t>(node.parent)].isStatic) node.isStatic = false;
}

}  // namespace nacre
