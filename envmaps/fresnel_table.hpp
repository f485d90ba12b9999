// Fresnel reflectance as a one-dimensional texture (HSE section 1.5), addressed by √cosθ: dielectrics of a high index
// drop to their Brewster angle within a degree of grazing, where a table linear in cosθ has no texels.
#pragma once

#include "core/texture.hpp"

namespace nacre {

/// Index η + ik per colour channel; k = 0 is a dielectric.
struct FresnelIndex {
    Rgb eta{1.5}, k{0};
};

/// Exact reflectance of unpolarised light. \param cosTheta  in [0, 1]
Rgb fresnelExact(const FresnelIndex& index, double cosTheta);

/// size × 1 texels, one channel when all channels are alike, else three. Mapping `sqrt_cos`: F(cosθ) is looked up at
/// u = (√cosθ · (size − 1) + 0.5)/size.
/// \param size  2 to 16384
/// \throws std::invalid_argument when η ≤ 0, k < 0, or either is not finite
AssetTexture bakeFresnelTable(const FresnelIndex& index, int size, TexelFormat format = TexelFormat::Half);

/// What a shader fetches. \param cosTheta  clamped to [0, 1]
Rgb lookupFresnel(const AssetTexture& table, double cosTheta);

/// HSE section 1.5: F·Lm + Ld, a mirror's reflection added to the diffuse light; and F·Lm + (1 − F)·Ld, a coat that
/// lets through what it doesn't reflect.
inline Rgb addReflection(const Rgb& f, const Rgb& mirror, const Rgb& diffuse) { return f * mirror + diffuse; }
inline Rgb blendReflection(const Rgb& f, const Rgb& mirror, const Rgb& diffuse) {
    return f * mirror + (Rgb(1) - f) * diffuse;
}

}  // namespace nacre
