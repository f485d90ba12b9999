// What glTF's JSON says of a scene, without its geometry: hierarchy, lights, cameras, materials, which key frames.
#pragma once

#include <functional>
#include <optional>

#include "core/scene_description.hpp"
#include "shading/gltf_file.hpp"

namespace nacre {

/// A channel of the file's animation; its key frames are assimp's.
struct GltfChannel {
    int gltfNode = -1;
    SceneTrack::Path path = SceneTrack::Path::Translation;
    bool step = false;
};

struct GltfScene {
    SceneDescription scene;              ///< nodes, lights, materials; SceneNode::mesh is glTF's own index
    std::vector<int> nodeOf;             ///< scene's index of each glTF node; -1: not in the scene
    std::vector<std::string> meshNames;  ///< of glTF's meshes
    std::vector<GltfChannel> channels;
    std::optional<int> cameraNode;  ///< in scene.nodes; scene.camera is then local to it
};

/// \throws nacre::Error with the path in the JSON: cycles, nodes under two parents, indices out of range, numbers out
///         of theirs, matrices that are no translation, rotation and scale
GltfScene gltfScene(const GltfFile& file, const std::function<void(const std::string&)>& note);

}  // namespace nacre
