// Meshes from files: OBJ, PLY, OFF, glTF and whatever else assimp reads.
#pragma once

#include <filesystem>

#include "core/scene.hpp"

namespace nacre {

/// What loadMesh had to do to the file's mesh.
struct MeshReport {
    std::size_t degenerateTriangles = 0;  ///< left out
    bool madeNormals = false;             ///< the file has none, or one of them is no direction
    std::size_t standInNormals = 0;       ///< vertices with the stand-in of makeNormals
};

struct LoadedMesh {
    Mesh mesh;
    MeshReport report;
};

/// All meshes of the file as one, in the scene's coordinates; polygons triangulated, lines and points left out.
/// \throws nacre::Error naming the path: unreadable or unknown format (with assimp's message), no triangle with area,
///         non-finite positions, indices out of range
LoadedMesh loadMesh(const std::filesystem::path& path);

/// Moves and scales a mesh so that its bounding box is centred at the origin and its longest edge is `size`.
/// \throws std::invalid_argument on an empty mesh or one without extent
void fitToBox(Mesh& mesh, float size = 2.0f);

}  // namespace nacre
