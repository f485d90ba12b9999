// How `nacre render` is told of shadows and of light between meshes.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/progress.hpp"
#include "shading/hybrid/sampled_shadows.hpp"
#include "shading/scene_renderer.hpp"

namespace nacre::cli {

/// Words of --shadows, --soft and --quality. \throws UsageError that lists them
ShadowMethod shadowMethodOf(const std::string& text);
/// sampled-maps, sampled-volumes, sampled; none for other words
std::optional<SampledShadowMethod> sampledShadowsOf(const std::string& text);
SoftShadows softShadowsOf(const std::string& text);
int qualityOf(const std::string& text);

/// What of lamps' light a picture lacks. \param traced  specular surfaces are, and send none of it on \param maps  cast
/// the shadows
std::vector<std::string> lightNotes(const SceneDescription& scene, bool traced, bool maps);
/// A line each.
std::string notesText(const nlohmann::json& notes);
/// Of data["repeated"], when it is there.
std::string repeatedText(const nlohmann::json& data);

nlohmann::json volumesJson(const ShadowVolumeCounts& counts);

/// Of each material's unbaked BRDF at 45 degrees, at most 0.99; 0 without one.
std::vector<Rgb> albedosOf(const SceneDescription& scene);

/// Gives the renderer light between the scene's meshes as they stand at `time`: albedos of the unbaked BRDFs at 45
/// degrees, visibility by rays. \return  shots, the share of the power left unshot, seconds
nlohmann::json addRadiosity(SceneRenderer& renderer, double time, const Progress& progress = {});

}  // namespace nacre::cli
