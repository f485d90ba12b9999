// One scene put into another: what scene files do with what they import.
#pragma once

#include "core/scene_description.hpp"

namespace nacre {

/// Where the shared parts of a merged scene begin.
struct MergedParts {
    int assets = 0, meshes = 0, volumes = 0, materials = 0;
};

/// Appends assets, meshes, volumes and materials of `from`, which keeps nodes, lights and tracks alone. \param prefix
/// of names
MergedParts mergeParts(SceneDescription& to, SceneDescription& from, const std::string& prefix);

/// Appends nodes, lights and tracks of `from` under the node `parent`; as often as there shall be instances, the first
/// time right after mergeParts. \param material  of all its nodes instead of their own; -1: their own
void mergeInstance(SceneDescription& to, const SceneDescription& from, const MergedParts& parts, int parent,
                   int material);

/// isStatic = false for nodes with a track, and below nodes that are not static.
void markMoving(SceneDescription& scene);

}  // namespace nacre
