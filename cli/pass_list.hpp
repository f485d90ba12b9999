// What `nacre render --passes` prints.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "cli/scene_errors.hpp"
#include "shading/scene_programs.hpp"

namespace nacre::cli {

/// The passes that draw a scene (shading/multipass/pass_schedule.hpp), found without OpenGL, as text or JSON.
std::string passList(const SceneDescription& scene, const SceneShot& shot, const SceneSwitches& on, bool asJson);

/// How many images of lamps in mirrors and panes a picture took, and passes that add light.
nlohmann::json lightCountsJson(const PassSchedule& schedule);

}  // namespace nacre::cli
