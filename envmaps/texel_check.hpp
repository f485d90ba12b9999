// Texels that are no radiance: counted, and handled by a stated rule. Nothing is repaired silently.
#pragma once

#include <span>
#include <string>

#include "core/image.hpp"

namespace nacre {

enum class NegativePolicy { Keep, Clamp, Error };

std::string toString(NegativePolicy policy);  ///< keep, clamp, error
/// \throws std::invalid_argument that lists the known names
NegativePolicy negativePolicyFromString(const std::string& name);

struct TexelReport {
    std::size_t texels = 0;
    std::size_t negative = 0;    ///< texels with a component below 0
    std::size_t nonFinite = 0;   ///< texels with NaN or an infinity
    std::size_t overflowed = 0;  ///< texels with a component of 65504 or more, or +infinity: what half can't tell apart
    double energyRemovedPercent = 0;  ///< −Σ negative components · dω over Σ |L| dω, in percent
    std::string firstBad;             ///< "(x, y) r g b" of the first negative or non-finite texel
};

/// How texels of an image are neighbours.
struct TexelTopology {
    int blockRows = 0;   ///< rows that belong together (a cube face); 0 = all
    bool wrapX = false;  ///< left and right edge meet
};

/// Counts and, as `policy` says, mends three-channel texels in place. Clamp: negative components become 0. Keep: they
/// stay. Under both a non-finite texel becomes the mean of its finite neighbours (of up to 8 in its block, as they
/// were in the file), or 0 when there is none.
/// \param weights  solid angle of each texel [sr]
/// \throws nacre::Error under Error when there is a negative or non-finite texel, naming `name`, counts and the first
/// one
TexelReport checkTexels(Image& image, std::span<const double> weights, const TexelTopology& topology,
                        NegativePolicy policy, const std::string& name);

}  // namespace nacre
