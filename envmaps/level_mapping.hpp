// What a level of a chain stands for: a named pair of inverse functions between lod and a lobe's parameter.
#pragma once

#include <string>
#include <vector>

namespace nacre {

/// Level m holds the lobe of parameter values[m] (alpha of a microfacet lobe, exponent of a cosine power, …), strictly
/// monotone. Between levels the lod is linear in
///   linear  the value    sqrt  its square root (perceptual roughness of alpha)    log2  its logarithm (exponents)
/// and values beyond the ends are those of the ends. A single level has lod 0 for all.
struct LevelMapping {
    std::string name = "linear", parameter = "alpha";
    std::vector<double> values;
};

/// \throws std::invalid_argument on an unknown name, no values, values that are not finite or not monotone, or outside
/// the
///         function's domain (sqrt: ≥ 0, log2: > 0)
void requireValid(const LevelMapping& mapping);

double lodOf(const LevelMapping& mapping, double value);  ///< 0 … levels − 1
double valueOf(const LevelMapping& mapping, double lod);  ///< inverse of lodOf within the ends

}  // namespace nacre
