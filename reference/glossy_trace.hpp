// Glossy light transfer of vertices by rays: ground truth for transfer/glossy_transfer.hpp (HEMI equation 3).
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/scene.hpp"

namespace nacre {

/// f(wi, wo) [1/sr], both unit and in the local frame, z the normal; x is any tangent, so f must be isotropic.
using IsotropicBrdf = std::function<double(const Vec3& wi, const Vec3& wo)>;

/// (n + 2)/2π max(0, r·wi)^n about the mirrored view r.
IsotropicBrdf phongLobe(double exponent);

/// V_i = ∫ y_i(s) V(s) f(s, wo) max(0, n·s) ds of all vertices in double, wo towards `eye`: rays over the cosine, from
/// where tracedTransfer's start, that any side of any triangle stops. 0 for vertices that have no normal or face away.
/// \param normals  unit or 0 \param rays  a vertex, ≥ 1 \return [vertex][(order + 1)²]
std::vector<double> tracedGlossyTransfer(std::span<const glm::uvec3> triangles, std::span<const glm::vec3> positions,
                                         std::span<const glm::vec3> normals, const Vec3& eye, const IsotropicBrdf& f,
                                         int order, std::size_t rays);

}  // namespace nacre
