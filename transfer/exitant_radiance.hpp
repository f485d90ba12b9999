// Vertex colours from transfer vectors and light, both as coefficients of spherical harmonics (HEMI equation 2).
#pragma once

#include <span>
#include <vector>

#include "core/math.hpp"
#include "transfer/harmonic_rotation.hpp"

namespace nacre {

/// Radiance that comes from afar: (order + 1)² coefficients, index l² + l + m, in the world's axes; the coefficients of
/// envmaps' SphericalHarmonics.
using LightCoefficients = std::vector<Rgb>;

/// The light turned by `angle` [rad] about `axis`, counter-clockwise seen against it: L'(R s) = L(s). In float, as
/// HarmonicRotation. \param axis  of any length but 0
/// \throws std::invalid_argument when the number of coefficients isn't the rotation's, or a number isn't finite
LightCoefficients turnedLight(const HarmonicRotation& rotation, const LightCoefficients& light, const Vec3& axis,
                              double angle);

/// Σ w_k L_k. \throws std::invalid_argument for no light, one of another order, or not one finite weight a light
LightCoefficients blendedLights(std::span<const LightCoefficients> lights, std::span<const double> weights);

/// Radiance albedo Σ_i L_i V_i of each vertex, whichever way it is seen: the surface is matt. Light cut at an order
/// rings: small negative values are what the coefficients say, and stay. \param transfer  [vertex][light.size()]
/// \throws std::invalid_argument when it isn't a whole number of vertices
std::vector<glm::vec3> exitantRadiance(std::span<const float> transfer, const LightCoefficients& light,
                                       const Rgb& albedo = Rgb(1), unsigned threads = 0);

}  // namespace nacre
