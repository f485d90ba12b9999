// Edits of a scene that the panel offers, on values.
#pragma once

#include "core/scene_description.hpp"

namespace nacre {

/// The material for a typed text: an analytic model's (`ggx:alpha=0.2`), or a baked BRDF's file. The scene's own when
/// there is one alike already; else a new one, with the ambient of `like`.
/// \param like  a material, or -1
/// \return its index. \throws std::invalid_argument for a text that is neither: what makeModel says, or that the file
///         isn't there. Whether it is a BRDF is SceneRenderer::setScene's business
int materialFor(SceneDescription& scene, const std::string& text, int like);

/// The asset with this file; a new one, named after it, when there is none.
int assetFor(SceneDescription& scene, const std::filesystem::path& file);

/// What a baked file says of itself, without its textures.
struct FoundAsset {
    std::filesystem::path file;
    std::string kind;
};

/// The baked assets in these folders (not below), sorted by name; other files are passed over. Reads headers only.
std::vector<FoundAsset> findAssets(const std::vector<std::filesystem::path>& folders);

/// The node whose mesh is the first that a ray through a pixel meets, or -1.
/// \param pixel  from the picture's top left corner. \param nodes  nodeTransforms of the moment. O(triangles)
int nodeAt(const SceneDescription& scene, const std::vector<glm::dmat4>& nodes, const Camera& camera, Vec2 pixel,
           Vec2 size);

}  // namespace nacre
