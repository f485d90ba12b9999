// A surrounding as a few numbers: real spherical harmonics (Ramamoorthi & Hanrahan 2001).
#pragma once

#include <string>
#include <vector>

#include "core/environment.hpp"
#include "envmaps/lobes.hpp"

namespace nacre {

/// f(d) = Σ c_lm y_lm(d), orthonormal, with the world's x, y, z and no phase (−1)^m: y_00 = 0.282095,
/// y_1,−1 = 0.488603 y, y_10 = 0.488603 z, y_11 = 0.488603 x, y_2,−2 = 1.092548 xy, … Entry l² + l + m.
struct SphericalHarmonics {
    int order = 0;
    std::vector<Rgb> coefficients;  ///< (order + 1)²
    const Rgb& at(int l, int m) const { return coefficients[static_cast<std::size_t>(l * l + l + m)]; }
    Rgb& at(int l, int m) { return coefficients[static_cast<std::size_t>(l * l + l + m)]; }
};

/// y_lm(d) for all l ≤ order, in the order of SphericalHarmonics. \param d  unit
std::vector<double> realHarmonics(int order, const Vec3& d);

/// c_lm = Σ L_i Ω_i y_lm(d_i) over the texels' centres, exact solid angles, in double precision; beyond order 16 by the
/// fast transform (1e-6 of the largest coefficients).
/// \param order  0 to kMaxHarmonicOrder
SphericalHarmonics projectEnvironment(const EnvMap& map, int order, unsigned threads = 0);

/// The map prefiltered with a zonal lobe: c_lm k_l. Diffuse gives irradiance/π by the normal.
SphericalHarmonics filterHarmonics(const SphericalHarmonics& in, const Lobe& lobe);

/// Windows damp the ringing that a cut at the order leaves: Hann (1 + cos(πl/(order + 1)))/2,
/// Lanczos sin(x)/x with x = πl/(order + 1).
enum class HarmonicWindow { None, Hann, Lanczos };
/// none, hann, lanczos \throws std::invalid_argument that lists them
HarmonicWindow harmonicWindowFromString(const std::string& name);
SphericalHarmonics windowHarmonics(const SphericalHarmonics& in, HarmonicWindow window);

/// f(d). \param d  unit
Rgb evaluateHarmonics(const SphericalHarmonics& harmonics, const Vec3& d);

}  // namespace nacre
