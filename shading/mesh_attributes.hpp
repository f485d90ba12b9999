// Normals and tangents for meshes that lack them.
#pragma once

#include "core/scene.hpp"

namespace nacre {

/// Removes triangles without area: two equal corners, or corners on a line. \return how many
/// \throws std::invalid_argument on an index out of range
std::size_t removeDegenerateTriangles(Mesh& mesh);

/// Sets every normal to the sum of its triangles' unit normals, each weighted by its angle at the vertex (Thürmer &
/// Wüthrich 1998). Vertices at the same position share one sum, so that seams of uv stay smooth. Where no
/// triangle gives a direction (unused vertices, or sums that cancel) the normal is (0, 0, 1).
/// \return how many vertices got that stand-in
std::size_t makeNormals(Mesh& mesh);

/// Sets every tangent: ∂P/∂u of the triangles around a vertex where uv has area, made orthogonal to the normal, with w
/// the sign of the uv area; elsewhere tangentAround(normal).
void makeTangents(Mesh& mesh);

/// Whether the uv of some triangle has area: without one a relief or any other picture on the mesh is a single texel,
/// or a line of them.
bool hasUv(const Mesh& mesh);

/// A unit tangent for a normal that has none: along the parallels about y, normalize(y × n), and +x where n is ±y.
glm::vec4 tangentAround(const glm::vec3& normal);

}  // namespace nacre
