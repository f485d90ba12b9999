// The factorization methods, one function each; factorize.cpp names them and searches among them.
#pragma once

#include "factorize/factored_brdf.hpp"
#include "factorize/factorize.hpp"
#include "factorize/reflectance.hpp"

namespace nacre {

/// Sizes of one bake. A method reads what it needs; 0 × 0 = the method has no such texture.
struct TextureSizes {
    glm::ivec2 first{64, 64}, second{64, 64};
};

/// HSE section 1.1 as printed: A(cosθ, cosδ) = F·D and B(cosα, cosβ) = visibility · cosα, linear in the cosines and in
/// value. Needs isotropic microfacet pieces with a constant diffuse term.
FactoredBrdf factorizeCosine(const Reflectance& r, const TextureSizes& sizes, const FactorizeOptions& options);

/// The same two factors in logarithms and adaptive coordinates, then refined through the bilinear filter.
FactoredBrdf factorizeAnalytic(const Reflectance& r, const TextureSizes& sizes, const FactorizeOptions& options);

/// Any isotropic input: tables over (θh, θd) with harmonics in cos²φd and a colour basis of the material's own.
FactoredBrdf factorizeFit(const Reflectance& r, HalfDiffLayout layout, const TextureSizes& sizes,
                          const FactorizeOptions& options);

/// f = diffuse + exp(P(wi) + P(wo) + Q(h) + polynomial(θd) + known elevations): McCool, Ang & Ahmad 2001 with a slope
/// map for h, a polynomial for Fresnel, and the diffuse term apart. Isotropic or anisotropic.
FactoredBrdf factorizeHomomorphic(const Reflectance& r, const TextureSizes& sizes, const FactorizeOptions& options);

inline constexpr int kLargestSeparable = 256;  ///< edge: more texels than the fit's samples can fill

/// Sums of products, Kautz & McCool 1999: terms 1 or 2, over (h, d), (wi, wo), or symmetric in those. Weighted SVD on a
/// coarse grid, then fitted through the bilinear filter; values, or logarithms where those come nearer.
FactoredBrdf factorizeSeparable(const Reflectance& r, const TextureSizes& sizes, const FactorizeOptions& options);

/// One texture for Phong, Blinn–Phong and cosine lobes, diffuse and ambient terms inside.
FactoredBrdf factorizeSingleLobe(const Reflectance& r, const TextureSizes& sizes, const FactorizeOptions& options);

/// Banks' model over the two tangent angles (HSE eq. 4).
FactoredBrdf factorizeTangent(const Reflectance& r, const TextureSizes& sizes, const FactorizeOptions& options);

/// makeTexture for values that may exceed half floats' range: divides by a constant that the lookup multiplies back, as
/// HSE section 1.1 proposes for fixed point.
AssetTexture makeScaledTexture(std::string name, std::string mapping, Image values, TexelFormat format);

}  // namespace nacre
