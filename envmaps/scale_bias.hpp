// The reflectance of a rough GGX surface under white light, split so that the colour at normal incidence can be chosen
// in the shader (Karis 2013, "Real shading in Unreal Engine 4"): ∫ f cosθ dω = f0 · scale + bias.
#pragma once

#include "core/texture.hpp"

namespace nacre {

/// For f = D G2 F/(4 n·l n·v) with GGX, Smith's height-correlated G2 and Schlick's F = f0 + (1 − f0)(1 − v·h)⁵:
/// scale = ∫ (1 − (1 − v·h)⁵) …, bias = ∫ (1 − v·h)⁵ …; scale + bias is what is reflected where f0 = 1.
struct ScaleBias {
    double scale = 1, bias = 0;
};

/// By quadrature over visible half vectors (Heitz 2018), `points`² of them. \param cosV  n·v in (0, 1];  \param alpha
/// in (0, 1] Error below 3e-4 with 64 points. \throws std::invalid_argument outside these ranges
ScaleBias integrateScaleBias(double cosV, double alpha, int points = 64);

/// size² texels of two channels (scale, bias). Mapping `cos_perceptual`: u = (√(n·v) (size − 1) + 0.5)/size,
/// v = (p (size − 1) + 0.5)/size with alpha = p². The first column holds n·v = 1e-4, the first row alpha = 1e-4.
AssetTexture bakeScaleBias(int size, TexelFormat format = TexelFormat::Half, unsigned threads = 0);

/// What a shader fetches. \param perceptualRoughness  √alpha
ScaleBias lookupScaleBias(const AssetTexture& table, double cosV, double perceptualRoughness);

/// f0 · scale + bias, and what the facets reflect among themselves beyond the first time (Fdez-Agüera 2019): with
/// E = scale + bias, F̄ = f0 + (1 − f0)/21 and S = f0 scale + bias, the sum S + S F̄ (1 − E)/(1 − F̄ (1 − E)).
/// 1 where f0 = 1.
Rgb multipleScattering(const Rgb& f0, const ScaleBias& single);

}  // namespace nacre
