// Light transfer of vertices by rays: ground truth for transfer/ (HEMI equation 3).
#pragma once

#include <span>
#include <vector>

#include "core/scene.hpp"

namespace nacre {

/// How far rays start over their vertex [of the mesh's extent]: past the vertex's own triangles, single precision being
/// 1e-7, and not past what the vertex touches.
inline constexpr double kTransferLift = 1e-6;

/// What rays are traced in: about the first position and of extent 1, as floats are coarse far from the origin, and
/// end.
Mesh meshOfExtentOne(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> positions);

/// V_i = ∫ y_i(s) V(s) max(0, n·s)/π ds of each vertex, in double: y_i of the world's directions as envmaps'
/// realHarmonics has them, V by rays from just over the vertex (kTransferLift along n) that any side of any
/// triangle stops. Rays are cosine-distributed, a low-discrepancy set turned anew for each vertex; what is hidden is
/// taken from the open hemisphere's transfer, which is known: less noise, the same mean. \param vertices  which \param
/// normals  unit, one a position; 0 where there is none: its transfer is 0
/// \param order  of the harmonics \param rays  a vertex, ≥ 1 \return [vertex][(order +
/// 1)²]
std::vector<double> tracedTransfer(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> positions,
                                   std::span<const glm::vec3> normals, std::span<const std::uint32_t> vertices,
                                   int order, std::size_t rays);

/// How far transfer vectors are from the truth.
struct TransferError {
    double mean = 0;             ///< mean over vertices of |V − truth| / |truth|: HEMI's "average L2 error"
    double median = 0, p95 = 0;  ///< of the same
    double total = 0;            ///< √(Σ |V − truth|² / Σ |truth|²)
    std::size_t vertices = 0;    ///< that count
    std::size_t buried = 0;      ///< left out of mean, median and p95: |truth| below a hundredth of an open vertex's
};
/// \param found, truth  [vertex][coefficients]
TransferError transferError(std::span<const float> found, std::span<const double> truth, std::size_t coefficients);

}  // namespace nacre
