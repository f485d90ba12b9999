// The error of Fresnel and scale-bias tables, against other formulas than the bakers'.
#pragma once

#include "envmaps/fresnel_table.hpp"
#include "envmaps/scale_bias.hpp"

namespace nacre {

struct TableError {
    double maxAbs = 0, rms = 0;
    int samples = 0;  ///< values compared
};

/// At 2000 angles uniform in θ ∈ [0, π/2], against the complex amplitudes of microfacet_terms.hpp.
TableError measureFresnel(const AssetTexture& table, const FresnelIndex& index);

/// At 6 × 6 pairs between the texels, scale and bias, against the midpoint rule over light directions (uniform in the
/// half vector's slope) of D G2 F/(4 n·v). alpha from 0.02, n·v from 0.02.
TableError measureScaleBias(const AssetTexture& table);

}  // namespace nacre
