// Lobes that are not the same around their axis: summed directly, as no product of coefficients holds them.
#pragma once

#include "core/environment.hpp"
#include "envmaps/lobes.hpp"

namespace nacre {

/// The tangent of an anisotropic lobe about r: the lobe's axis without its part along r, unit; where they are parallel,
/// some direction across r.
Vec3 lobeTangent(const Vec3& axis, const Vec3& r);

/// L'(r) = Σ L_i w Ω_i / Σ w Ω_i over the map's texels, those merged that are finer than a quarter of the narrower
/// alpha. Negative only where the map is. Cost: texels · results. \param lobe  of kind GgxAnisotropic
EnvMap filterAnisotropic(const EnvMap& source, const Lobe& lobe, EnvLayout layout, int size, unsigned threads = 0);

}  // namespace nacre
