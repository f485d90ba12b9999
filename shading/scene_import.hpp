// What other formats hold, as a scene: glTF 2.0 with KHR_lights_punctual, and meshes alone.
#pragma once

#include "shading/scene_file.hpp"

namespace nacre {

struct ImportedScene {
    SceneDescription scene;  ///< no assets; a camera when hasCamera
    bool hasCamera = false;
    std::optional<SceneLight> lamp{};  ///< instead of a key light, for one who looks at the file alone
    bool isComplete = false;           ///< lights and surroundings are as its author wants them, even if there are none
};

/// glTF: geometry and key frames through assimp; hierarchy, names, materials, lights and cameras from the file's JSON,
/// because assimp 5.2 keeps one node of a light that several have, confuses nodes of one name, and rounds matrices.
/// Metallic-roughness materials become ggx with Schlick's Fresnel: alpha = roughness², f0 = mix(0.04, base, metallic),
/// kd = (1 − metallic) base; emission becomes ambient. Intensities are taken as they are: lux as W/m², candela as W/sr.
/// A mesh of several primitives becomes nodes "name/1", … under its node.
/// Noted and left out: textures, skins, morph targets, more cameras than one, light ranges, alpha, lines and points.
/// Other formats: one node a material, in world coordinates; Kd of their materials, grey where there is none.
/// \throws nacre::Error naming the file: unreadable, wrong JSON (with its path), cycles, no triangle at all
ImportedScene importScene(const std::filesystem::path& path, const std::function<void(const std::string&)>& note);

/// Whether assimp reads files with this ending.
bool isImportName(const std::filesystem::path& path);

}  // namespace nacre
