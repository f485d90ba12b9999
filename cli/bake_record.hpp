// Whether a manifest's asset is what its recipe makes: by what is written beside it when it is baked.
#pragma once

#include "core/scene_description.hpp"

namespace nacre::cli {

/// Names verb, options, model text or the contents of all inputs, and this version: not where the files lie, so that a
/// folder that moves stays baked. \throws nacre::Error naming an input that can't be read
std::string recipeHash(const BakeRecipe& recipe);

struct AssetState {
    enum class Kind { Baked, Stale, Missing, Given } kind = Kind::Missing;  ///< given: there, and no recipe
    std::string why;  ///< of stale ones, and of what can't be told
};
const char* toString(AssetState::Kind kind);

/// \param hash  recipeHash of the asset's recipe, if it has one
AssetState stateOf(const SceneAsset& asset, const std::string& hash);
/// The same with the hash worked out; an input that can't be read makes it stale.
AssetState stateOf(const SceneAsset& asset);

/// FILE.exr.bake.json. Beside the asset and not in it: verbs know nothing of manifests, the asset's bytes stay those
/// that the verb wrote, and no picture has to be opened to know that nothing is to be done. Written after the asset,
/// so that a kill in between means baking again, never a wrong "up to date".
std::filesystem::path recordPath(const SceneAsset& asset);
/// \throws nacre::Error as writeFile
void writeRecord(const SceneAsset& asset, const std::string& hash, double seconds);
/// Removes the temporary files of the asset and its record that processes left which are gone: killed half-way.
void removeLeftovers(const SceneAsset& asset);

}  // namespace nacre::cli
