// The baked form of a BRDF: one to three small textures, a handful of constants, and a lookup formula named by `form`.
// This file is the C++ twin of shaders/nacre/factored_*.glsl: same formula, single precision, same filter.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/math.hpp"
#include "core/texture.hpp"

namespace nacre {

struct Asset;  // core/asset.hpp

/// The lookup formulas. Each has one GLSL function of the same name, and one section in factorize/README.md.
enum class FactoredForm {
    HalfDiff,     ///< f = kd + exp(M·(T(u,v) ⊗ powers of cos²φd + B(U,V)))         isotropic
    Cosine,       ///< f = kd + A(cosθ, cosδ) · B(cosα, cosβ), linear               HSE section 1.1, eq. 2, 3
    SingleLobe,   ///< f = (T(s, cosα) − ambient) / cosα                            HSE section 1.1
    Tangent,      ///< f = T(t·l, t·v)                                              Banks, HSE eq. 4
    Homomorphic,  ///< f = D(U,V) + exp(P(i) + P(o) + Q(h) + polynomial(θd) …)      McCool 2001; anisotropic
    Separable     ///< f = Σ_k U_k(x) · V_k(y), or its exponential                  Kautz & McCool 1999
};

std::string toString(FactoredForm form);  ///< half_diff, cosine, single_lobe, tangent, homomorphic, separable
/// \throws std::invalid_argument that lists the known names
FactoredForm factoredFormFromString(const std::string& name);

/// How the channels of HalfDiff's textures add up; x = cos²φd, c_k = colour columns.
enum class HalfDiffLayout {
    Product,  ///< two fetches: Σ c_k T0_k(u,v) + T1.r(U,V)                                    HSE eq. 1 in logarithms
    Harmonics,  ///< two fetches: c0 (T0.r + x T0.g + x² T0.b + x³ T1.r) + c1 (T0.a + x T1.g) + c2 (T1.b + x T1.a)
    Compact,    ///< one fetch:   c0 (T0.r + x T0.g) + c1 T0.b + c2 T0.a
    Grazing     ///< two fetches: Compact + Σ c_k T1_k(U,V)
};

/// What the two arguments of Separable's factors are.
enum class SeparableArguments {
    HalfDifference,  ///< half vector, difference vector: U_k(h) V_k(d), RGB
    InOut,           ///< U_k(wi) V_k(wo), RGB
    Symmetric,   ///< A_k(wi) A_k(wo), each of four channels with a colour of either sign: reciprocal by construction
    HalfCarried  ///< as HalfDifference, the frame of d carried along from the normal: anisotropic lobes
};
/// What Separable's textures hold.
enum class SeparableStorage {
    Values,     ///< f = max(0, Σ products)
    Logarithm,  ///< f = exp(Σ products)
    Factors     ///< logarithms of the factors: each product is exp(U_k + V_k); not for Symmetric, whose have signs
};
/// Texture coordinates of both. \param quadrant  of half and difference vector: mirror images share texels
/// \param inverseWidth  1/width of the half vector's slope map along x and y
std::pair<glm::vec2, glm::vec2> separableCoordinates(SeparableArguments arguments, bool quadrant,
                                                     const glm::vec2& inverseWidth, const glm::vec3& wi,
                                                     const glm::vec3& wo);

inline constexpr int kMaxFactoredTextures = 4;
inline constexpr int kFactoredParams = 16;  ///< vec4s of constants a form may use

/// A factored BRDF as the shader sees it.
struct FactoredBrdf {
    FactoredForm form = FactoredForm::HalfDiff;
    std::string method;                  ///< how it was made: analytic, fit, svd, …
    std::vector<AssetTexture> textures;  ///< in the order of the shader's samplers; size ≤ kMaxFactoredTextures
    std::array<glm::vec4, kFactoredParams> params{};  ///< meaning per form: factorize/README.md
    int fetches = 0;                                  ///< texture lookups per evaluation

    std::size_t bytes() const;
};

/// f̂(wi, wo) [1/sr] as the shader computes it: single precision, bilinear filter, stored values.
/// 0 when either direction is at or below the horizon.
Rgb evaluate(const FactoredBrdf& brdf, const Vec3& wi, const Vec3& wo);

Asset toAsset(const FactoredBrdf& brdf);
/// \throws nacre::Error when the asset is no factored BRDF or lacks a texture or constant of its form
FactoredBrdf factoredFromAsset(const Asset& asset, const std::string& path);

}  // namespace nacre
