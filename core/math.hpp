// Vectors and scalars every part shares. GLM is the vector library; bakers work in double, textures hold float.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace nacre {

using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;
using Vec4 = glm::dvec4;
using Mat3 = glm::dmat3;  ///< column-major, as GLM and GLSL
using Rgb = glm::dvec3;   ///< linear Rec. 709

inline constexpr double kPi = 3.14159265358979323846;

inline double sqr(double x) { return x * x; }
inline double clamp01(double x) { return std::min(1.0, std::max(0.0, x)); }

inline bool isFinite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
inline double maxComponent(const Vec3& v) { return std::max(v.x, std::max(v.y, v.z)); }
inline double mean(const Vec3& v) { return (v.x + v.y + v.z) / 3.0; }
/// Rec. 709 luminance of linear RGB.
inline double luminance(const Rgb& c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; }

}  // namespace nacre
