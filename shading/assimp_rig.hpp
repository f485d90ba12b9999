// A file's skeleton, meshes and clips through assimp.
#pragma once

#include <filesystem>

#include "shading/rig.hpp"

namespace nacre {

/// Polygons triangulated, lines and points left out; vertices as assimp gives them, not joined. A mesh with bones comes
/// once, one without for each node that holds it. Clips without a name are named by their number. A clip's rate is the
/// file's ticks a second where those are a rate (1 to 120; glTF counts milliseconds, .X often 1/4800 s).
/// glTF: rows of STEP and CUBICSPLINE keys are read as linear ones, because assimp 5.2 doesn't say which they are.
/// \param note  is told of such keys, of channels without a node, and of nodes that share an animated name
/// \param keyFrame  of a format whose key frames are meshes (MD2): the one that is read
/// \throws nacre::Error naming the file: unreadable or unknown format (with assimp's message), bones without a node,
///         indices out of range
Rig readAssimpRig(const std::filesystem::path& path, const std::function<void(const std::string&)>& note,
                  int keyFrame = 0);

}  // namespace nacre
