// Tangent-space normals of the surface, and levels of them that keep its mean slope.
#pragma once

#include <vector>

#include "bump/height_map.hpp"

namespace nacre {

/// (∂z/∂x, ∂z/∂y) of the surface at texel centres, two channels: the mean of the gradients that the patches about the
/// texel have at it. Four patches: central differences. Beside holes fewer: one-sided ones. None: 0.
/// \throws std::invalid_argument for a bad map
Image surfaceSlopes(const HeightMap& map, unsigned threads = 0);

/// Levels, finest first, level l of max(1, ⌊size / 2ˡ⌋) texels: unit normals (x, y, z), z > 0.
struct NormalMap {
    std::vector<Image> levels;  ///< 3 channels, or 4 with the roughness
};

struct NormalOptions {
    bool levels = true;      ///< false: the finest only
    bool roughness = false;  ///< a fourth channel alpha
    unsigned threads = 0;    ///< same bits for any
};

/// A level's normal is that of the mean slope of the texels that it stands for, by area (odd sizes share a texel
/// between two); holes count nothing, and where there are only holes the normal is (0, 0, 1). So the mean slope of
/// every level is that of the finest. Roughness: alpha² = 2 σ², with σ² the variance of the slopes about that mean,
/// averaged over x and y: the Beckmann distribution of the slopes' covariance that a level loses (Olano & Baker 2010,
/// section 3: Σ = E[s sᵀ] − E[s] E[s]ᵀ), made isotropic; GGX takes the same alpha as an approximation. Add it to the
/// material's: alpha² + alphaMaterial². Not limited to 1; 0 at the finest level. \throws std::invalid_argument for a
/// bad map
NormalMap makeNormals(const HeightMap& map, const NormalOptions& options = {});

}  // namespace nacre
