// Where a direction pair falls in the textures: every mapping by name, in single precision, as the shader computes it.
// GLSL twins: shaders/nacre/mappings.glsl. All coordinates are in [0,1] and run from first to last texel centre.
#pragma once

#include <glm/glm.hpp>

namespace nacre {

/// Lengths and products every isotropic mapping needs. `tanH` keeps its precision near the normal because the length
/// of h's tangential part is taken directly, never as √(1 − hz²).
struct HalfGeometry {
    glm::vec3 h;       ///< unit half vector
    float lengthXY;    ///< |(hx, hy)| = sinθh
    float oneMinusLh;  ///< 1 − l·h, as |l − h|²/2: exact near 0
};
HalfGeometry halfGeometry(const glm::vec3& wi, const glm::vec3& wo);

/// mapping `half_diff`: (√(t/(t+s)), √(1 − l·h)), t = tanθh. s > 0 is the slope that falls in the middle (u = 1/√2).
glm::vec2 mapHalfDiff(const HalfGeometry& g, float s);
/// cos²φd, clamped to [0,1]; 0/0 at θh = 0 or θd = 0 is kept finite by the floor 1e-4 of the denominator.
float cosSquaredPhiD(const HalfGeometry& g, const glm::vec3& wi, const glm::vec3& wo);

/// mapping `elevations`: U = √(1 − min(nl, nv)), V = √(1 − max(nl, nv))/U: reciprocal by construction.
glm::vec2 mapElevations(float cosI, float cosO);

/// mapping `cosine`: (cosθd, cosθh) or (cosα, cosβ) as they are (HSE eq. 2 and 3).
inline glm::vec2 mapCosine(float a, float b) { return glm::clamp(glm::vec2(a, b), 0.0f, 1.0f); }

/// mapping `scaled_slope`: the half vector's slopes over their widths on the unit disk, m = (hx/αx, hy/αy)/hz,
/// ρ = √(|m|/(|m|+1.5)); quadrant: (|X|,|Y|), else (1 + (X,Y))/2. \param inverseWidth  1/(αx), 1/(αy)
glm::vec2 mapScaledSlope(const glm::vec3& h, const glm::vec2& inverseWidth, bool quadrant);

/// mapping `lambert_disk`: a direction of the hemisphere on the unit disk of radius √(1 − z), equal-area;
/// quadrant: (|X|,|Y|), else (1 + (X,Y))/2.
glm::vec2 mapLambertDisk(const glm::vec3& w, bool quadrant);

/// mapping `lobe`: u of a lobe's cosine s: w = √(1 − s), u = w/(w + w0)·(1 + w0); s = 1 → 0, s ≤ 0 → 1. Takes 1 − s,
/// which callers compute without cancellation: exponents reach 1e6.
float mapLobe(float oneMinusS, float w0);

/// mapping `tangent`: ((1 + t·l)/2, (1 + t·v)/2).
inline glm::vec2 mapTangent(float tDotL, float tDotV) {
    return glm::clamp(0.5f * glm::vec2(tDotL, tDotV) + 0.5f, 0.0f, 1.0f);
}

/// wi in the half vector's frame (pole h, x axis towards the normal's projection): Rusinkiewicz's d, for separable
/// tables over (h, d).
glm::vec3 differenceVector(const glm::vec3& h, const glm::vec3& wi);
/// wi turned by the smallest rotation that takes h to the normal: d's azimuth is then nearly wi's where h is near the
/// normal, which suits anisotropic lobes. Smooth at h = n.
glm::vec3 carriedDifference(const glm::vec3& h, const glm::vec3& wi);

/// Texture coordinate of a mapping's value: 0 → centre of the first texel, 1 → of the last.
inline float toTexelCentres(float u, int size) {
    return (u * static_cast<float>(size - 1) + 0.5f) / static_cast<float>(size);
}

/// Smith's shadowing of an anisotropic GGX distribution as arithmetic (Heitz 2014): what 4 cosα cosβ / G comes to, up
/// to a constant. S(w) = |(αx x, αy y, z)|.
enum class SmithShadowing {
    None,        ///< 1
    Correlated,  ///< zo S(wi) + zi S(wo): heights of light and viewer correlated
    Separable    ///< (zi + S(wi)) (zo + S(wo))
};
float smithDenominator(SmithShadowing shadowing, const glm::vec2& width, const glm::vec3& wi, const glm::vec3& wo);

// Inverses, for filling tables from formulas.

struct ElevationPair {
    double cosMin, cosMax;
};
double inverseHalfDiffSlope(double u, double s);  ///< tanθh of u; +inf at u = 1
double inverseHalfDiffCosine(double v);           ///< cosθd of v
ElevationPair inverseElevations(double U, double V);
glm::dvec3 inverseScaledSlope(const glm::dvec2& uv, const glm::dvec2& width, bool quadrant);
glm::dvec3 inverseLambertDisk(const glm::dvec2& uv, bool quadrant);
double inverseLobe(double u, double w0);  ///< s of u

}  // namespace nacre
