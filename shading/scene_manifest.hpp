// The "assets" section that scene files and manifests share: baked-asset files and how the command bakes them.
#pragma once

#include "core/json_field.hpp"
#include "core/scene_description.hpp"

namespace nacre {

/// The section "assets" of `root`, by name; empty without it. Paths count from `folder`.
///   "gold": {"file": "gold.exr", "bake": {"verb": "factorize", "source": "sgd:gold-paint",
///            "options": {"--max-error": 0.01, "--json": false}}}
/// Options: true is a flag alone, false leaves it out, an array is joined by commas.
/// \throws nacre::Error as JsonField, and for two assets of one file of which one is baked
std::vector<SceneAsset> assetsIn(const JsonField& root, const std::filesystem::path& folder);

/// Every asset that a manifest names: a JSON file with a section "assets", as scene files are, of which nothing else is
/// read but the scenes (.json) that its nodes import. A file that two scenes bake alike is named once.
/// \throws nacre::Error when it can't be read, as assetsIn, for scenes that import themselves, and for one file that
///         two scenes bake in different ways
std::vector<SceneAsset> readManifest(const std::filesystem::path& path);

/// The file as JSON. \throws nacre::Error naming it (unreadable, larger than 64 MiB, wrong syntax)
nlohmann::json readSceneJson(const std::filesystem::path& path);

/// `file` of a scene in `folder`, without needless dots.
std::filesystem::path scenePath(const std::filesystem::path& folder, const std::string& file);

/// Scenes that are being read, outermost first, by their canonical paths.
using SceneStack = std::vector<std::filesystem::path>;
/// \throws nacre::Error at `field` when `path` is among them, or 16 are
void requireNoCycle(const SceneStack& open, const std::filesystem::path& path, const JsonField& field);

}  // namespace nacre
