// Scenes from files: our JSON (scene.schema.json), glTF 2.0, or a mesh alone.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "core/scene_description.hpp"

namespace nacre {

struct SceneOptions {
    bool needAssets = true;  ///< a missing asset file is an error
    /// Hears, one line each, what the files hold and the scene leaves out. Empty: nobody listens.
    std::function<void(const std::string&)> note;
};

/// A scene to draw. By the file's ending:
///   .json: a scene file. Without "camera" the first imported one, else one that sees everything.
///   .gltf, .glb: hierarchy, instances, materials, lights, camera, animation (scene_import.hpp);
///   any other that assimp reads: its meshes, one node each.
/// Files that are no scene files get what they lack to be looked at: a camera that sees everything, a light with a
/// shadow, and materials without light of their own a little ambient.
/// \throws nacre::Error naming file, the path in the JSON, expected and found; a list of names where one is unknown;
///         for cycles the names along it
SceneDescription readScene(const std::filesystem::path& path, const SceneOptions& options = {});

/// readScene of a scene file's text. \param path  where it would lie: what messages name and paths count from
SceneDescription parseScene(std::string_view text, const std::filesystem::path& path, const SceneOptions& options = {});

/// Whether readScene knows the ending of this name.
bool isSceneName(const std::filesystem::path& path);

}  // namespace nacre
