// Colours for the pixels that a shadow map misjudges.
#pragma once

#include "reference/shadow_error.hpp"

namespace nacre {

/// Misjudged pixels in full colour over the truth in grey: acne red, leaks blue, at boundaries yellow.
/// \param truth    ShadowTruth::picture; \param verdict  ShadowTruth::judge, of the same size
/// \param white    radiance that will be shown as white
/// \throws std::invalid_argument when sizes differ
Image verdictPicture(const Image& truth, const Image& verdict, double white);

}  // namespace nacre
