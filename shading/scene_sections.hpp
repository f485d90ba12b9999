// The sections of a scene file, each read by itself: what scene_file.cpp puts together.
#pragma once

#include "core/error.hpp"
#include "core/json_field.hpp"
#include "core/scene_description.hpp"

namespace nacre {

/// What the file's own names stand for: the place of a name is its index.
struct SceneNames {
    JsonNames assets, meshes, volumes, materials, lights, nodes;
};

/// All throw nacre::Error as JsonField does. Paths count from `folder`. Keys are described in scene.schema.json.
SceneMesh sceneMesh(const std::string& name, const JsonField& field, const std::filesystem::path& folder);
SceneVolume sceneVolume(const std::string& name, const JsonField& field, const std::filesystem::path& folder);
SceneMaterial sceneMaterial(const std::string& name, const JsonField& field, const SceneNames& names,
                            const std::filesystem::path& folder);
SceneLight sceneLight(const std::string& name, const JsonField& field, const SceneNames& names);
/// A node but for what names other nodes: "children", "import".
SceneNode sceneNode(const std::string& name, const JsonField& field, const SceneNames& names);
SceneSky sceneSky(const JsonField& field, const SceneNames& names);
/// \return near and far are 0 where the file doesn't say
Camera sceneCamera(const JsonField& field);
SceneTrack sceneTrack(const JsonField& field, const SceneNames& names);

inline double radians(double degrees) { return degrees * kPi / 180; }

/// Takes what `key` says, if it is there.
template <typename Take>
void ifThere(const JsonField& field, const char* key, Take&& take) {
    if (const auto inner = field.find(key)) take(*inner);
}

/// call(), whose failure becomes one of `field`: what it says of a file or a model, after the place that names it.
template <typename Call>
auto named(const JsonField& field, Call&& call) {
    try {
        return call();
    } catch (const Error& error) {
        field.fail(error.what());
    } catch (const std::invalid_argument& error) {
        field.fail(error.what());
    }
}

/// The same of call(text), of a field that must be a text.
template <typename Call>
auto namedText(const JsonField& field, Call&& call) {
    const std::string text = field.text();
    return named(field, [&] { return call(text); });
}

}  // namespace nacre
