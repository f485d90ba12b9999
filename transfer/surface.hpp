// What a moving mesh is as a surface: which vertices are the same point, and where it faces.
#pragma once

#include <span>

#include "core/animation.hpp"
#include "transfer/memory.hpp"

namespace nacre {

/// A mesh whose seams are closed: vertices that lie at one place (within 1e-5 of the frame's extent)
/// in every finite frame are one.
struct WeldedMesh {
    std::vector<std::uint32_t> weldOf;   ///< of each of the animation's vertices: its number here
    std::vector<std::uint32_t> firstOf;  ///< of each vertex here: the first of the animation's
    std::vector<glm::uvec3> triangles;   ///< of vertices here; those with a repeated vertex are left out
    bool closed = false;  ///< every edge belongs to two triangles that run along it in opposite directions
    std::size_t vertexCount() const { return firstOf.size(); }
};

/// \throws nacre::Error as checkAnimation
WeldedMesh weldMesh(const AnimatedMesh& animation, const std::string& name);

/// One frame's positions by the welded numbers.
std::vector<glm::vec3> weldedPositions(const WeldedMesh& mesh, std::span<const glm::vec3> frame);

/// The corners around each vertex: corner 3 t + c is triangle t's c-th. Those of v are order[first[v]] … order[first[v
/// + 1]].
struct CornersOfVertices {
    std::vector<std::uint32_t> first, order;
    std::vector<glm::uvec2> others;  ///< beside order: the triangle's other vertices, in its direction
    std::size_t bytes() const { return bytesOf(first) + bytesOf(order) + bytesOf(others); }
};
CornersOfVertices cornersOfVertices(std::span<const glm::uvec3> triangles, std::size_t vertices);

/// Of each vertex the first of those that triangles connect it with: a number for each connected part.
std::vector<std::uint32_t> connectedParts(std::span<const glm::uvec3> triangles, std::size_t vertices);

/// Unit normals Σ (a × b)/(|a|²|b|²) over the corners' edges a, b (Max 1999: exact on spheres, and however flat faces
/// are cut into triangles); (0,0,0) where no triangle has area or the sum vanishes. \param positions  finite
std::vector<glm::vec3> vertexNormals(std::span<const glm::uvec3> triangles, const CornersOfVertices& corners,
                                     std::span<const glm::vec3> positions, unsigned threads = 0);

/// One of them.
glm::vec3 vertexNormal(const CornersOfVertices& corners, std::size_t vertex, std::span<const glm::vec3> positions);

}  // namespace nacre
