// What mesh_file.cpp and scene_import.cpp share: assimp's meshes as ours. Not for applications: it names assimp's
// types.
#pragma once

#include <assimp/mesh.h>

#include <string>

#include "shading/mesh_file.hpp"

namespace nacre {

/// Appends vertices and triangles; normals that the mesh lacks become 0. \param path  what messages name
/// \return whether the mesh has normals
/// \throws nacre::Error for positions that aren't finite and indices out of range
bool appendAssimpMesh(Mesh& out, const aiMesh& in, const std::string& path);

/// Leaves out triangles without area, makes normals where they are missing or no directions, and tangents always:
/// assimp's own would follow its own smoothing, and need uv.
MeshReport completeMesh(Mesh& mesh, bool hasNormals);

}  // namespace nacre
