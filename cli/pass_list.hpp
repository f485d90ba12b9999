// What `nacre render --passes` prints.
#pragma once

#include <string>

#include "cli/scene_errors.hpp"
#include "shading/multipass/specular_options.hpp"

namespace nacre::cli {

/// The passes that draw a scene (shading/multipass/pass_schedule.hpp), found without OpenGL, as text or JSON.
std::string passList(const SceneDescription& scene, const SceneShot& shot, const SpecularOptions& options, bool asJson);

}  // namespace nacre::cli
