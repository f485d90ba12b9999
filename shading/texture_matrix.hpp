// The texture matrices of HSE section 1.1 (Heidrich & Seidel 1999): lookups addressed by the fixed-function way, for a
// directional light and an orthographic camera.
#pragma once

#include "core/math.hpp"

namespace nacre {

/// Equation 2: (n, 1) → (cosθ, cosδ, 0, 1), cosθ = h·l constant, cosδ = h·n.
/// \param toLight, toView  unit, world space
/// \throws std::invalid_argument when one is not unit length (1e-6), or they are opposite
glm::dmat4 textureMatrixHalf(const Vec3& toLight, const Vec3& toView);

/// Equation 3: (n, 1) → (cosα, cosβ, 0, 1), cosα = l·n, cosβ = v·n. With a tangent in place of the normal it gives the
/// coordinates of Banks' form, (t·l, t·v) (equation 4). \throws std::invalid_argument as above, opposite ones are fine
glm::dmat4 textureMatrixLightView(const Vec3& toLight, const Vec3& toView);

}  // namespace nacre
