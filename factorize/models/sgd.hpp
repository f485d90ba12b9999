// The shifted gamma distribution of micro-facets (SGD): published fits of measured materials.
#pragma once

#include <span>

#include "core/math.hpp"

namespace nacre {

/// One material of Bagher, Soler & Holzschuch 2012; every figure per colour channel.
struct SgdMaterial {
    const char* name;
    Rgb rhoD, rhoS, alpha, p, f0, f1, kap, lambda, c, k, theta0;
};

/// The materials that are built in, by name in alphabetical order (sgd_materials.cpp).
std::span<const SgdMaterial> sgdMaterials();

/// f(wi, wo) [1/sr] of a material, per channel (Bagher 2012, with the distribution's constant spelled out in `kap`):
///   f = ρd/π + ρs F(cosθd) D(δ) G1(α) G1(β) / (π cosα cosβ)
///   D(δ) = kap exp(−y) y^(−p) / (π cos⁴δ),  y = alpha + tan²δ/alpha;   ∫ D cosδ dω = 1: kap = 1/(alpha Γ(1 − p,
///   alpha)) F(c) = f0 − f1 c + (1 − f0)(1 − c)⁵, not below 0 G1(θ) = 1 for θ ≤ theta0, else 1 + lambda (1 − exp(c (θ −
///   theta0)^k)), kept in [0, 1];  θ in radians
/// The constant is π (not 4): ρs absorbs the difference. Fits, so nothing promises an albedo below 1 at grazing angles.
/// 0 when either direction is at or below the horizon.
Rgb evaluateSgd(const SgdMaterial& material, const Vec3& wi, const Vec3& wo);

}  // namespace nacre
