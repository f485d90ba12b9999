// How far scattered light (bump/scattered_light.hpp) is from paths traced over the same surface.
#pragma once

#include "bump/scattered_light.hpp"
#include "reference/relief_light.hpp"

namespace nacre {

/// Random texels that are no holes, with their light.
struct ReliefLightSamples {
    std::vector<glm::ivec2> texels;
    std::vector<TexelLight> truth;
};
/// \param options  of the truth; its light, sky, albedo, bounces must be those of the scattered light measured
/// \param count  ≥ 1; texels are uniform and may repeat
/// \throws std::invalid_argument for a bad map, a map of holes alone, or a bad number
ReliefLightSamples drawReliefLightSamples(const HeightMap& map, const ReliefLightOptions& options, int count = 300,
                                          std::uint64_t seed = 1);

/// √(Σ(a−b)²/Σb²) over texels and channels, b the truth; 0 when all of both is 0.
struct ScatteredLightError {
    double indirect = 0;  ///< of sky + indirect, all that isn't direct
    double total = 0;
    double noise =
        0;  ///< √(Σ standardError²/Σb²) of sky + indirect: what `indirect` would be by the truth's noise alone
    double bias = 0;   ///< Σ(a−b)/Σb of sky + indirect
    double share = 0;  ///< Σ(sky + indirect)/Σ total of the truth
    int samples = 0;
};
/// \throws std::invalid_argument when a texel isn't inside
ScatteredLightError measureScatteredLight(const ReliefLightSamples& samples, const ScatteredLight& light);

}  // namespace nacre
