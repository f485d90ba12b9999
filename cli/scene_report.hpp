// What `nacre info` says of a scene.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/scene_description.hpp"

namespace nacre::cli {

/// Counts, triangles, materials with what they use, lights, camera, animation, and assets with their state
/// (cli/bake_record.hpp: sources are hashed), and the programs that draw it. \param notes  what the files hold and the
/// scene leaves out
nlohmann::json sceneReport(const SceneDescription& scene, const std::vector<std::string>& notes);

/// The same for people.
std::string sceneText(const nlohmann::json& report);

}  // namespace nacre::cli
