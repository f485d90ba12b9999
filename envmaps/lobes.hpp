// The lobes that radiance is prefiltered with. All but the anisotropic ones are zonal: the same around their axis,
// which is the direction that the prefiltered map is looked up with.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/math.hpp"

namespace nacre {

/// With r the axis, l the light's direction, θ = angle(r, l), h the half vector, D a distribution of facets:
enum class LobeKind {
    Mirror,    ///< none: the radiance itself
    Diffuse,   ///< max(0, cosθ): irradiance/π; r = normal (Greene 1986)
    Phong,     ///< max(0, cosθ)^exponent, exponent = 1/r of HSE section 1.6, eq. 6; r = mirrored viewer
    Ggx,       ///< D(θ/2) · max(0, cosθ): n = v = r, weight D(n·h) · n·l
    Beckmann,  ///< the same with Beckmann's D
    GgxRefraction,  ///< D(θh) cosθh · dωh/dωl · cosθ: n = v, r = refracted viewer, θ = θh − θt (Walter 2007, eq. 17)
    BeckmannRefraction,  ///< the same with Beckmann's D
    GgxAnisotropic  ///< D(h) · max(0, cosθ): alpha along the tangent, alphaY across; tangent = `axis` without its part
                    ///< along r
};

std::string toString(LobeKind kind);  ///< mirror, diffuse, phong, ggx, … as lobeNames() lists them
/// \throws std::invalid_argument that lists the known names
LobeKind lobeKindFromString(const std::string& name);
std::vector<std::string> lobeNames();

struct Lobe {
    LobeKind kind = LobeKind::Mirror;
    double exponent = 0;  ///< Phong: ≥ 0
    double alpha = 0;     ///< microfacet lobes: width of the slopes, in (0, 1]
    double ior = 1;       ///< refraction: index beyond the surface relative to the viewer's side, > 0; 1 is Mirror
    double alphaY = 0;    ///< anisotropic: in (0, 1]
    Vec3 axis{0, 1, 0};   ///< anisotropic: any length > 0
};

/// \throws std::invalid_argument naming the value and its range
void validateLobe(const Lobe& lobe);
bool usesAlpha(LobeKind kind);

/// A lobe by the angle from its axis.
struct ZonalKernel {
    std::function<double(double theta)> value;  ///< ≥ 0, per solid angle, not normalised; 1 at its largest or so
    double width = 1;                           ///< the angle at which it has changed [rad]
    double support = kPi;                       ///< 0 beyond [rad]
};

bool isMirror(const Lobe& lobe);  ///< of kind Mirror, or a refraction of index 1, which bends nothing
bool isZonal(LobeKind kind);      ///< false for Mirror and GgxAnisotropic

/// The lobe's kernel. \throws std::invalid_argument when it is not zonal, and for bad parameters
ZonalKernel zonalKernel(const Lobe& lobe);

/// Funk–Hecke: k_l = ∫ k(θ) P_l(cosθ) sinθ dθ / ∫ k(θ) sinθ dθ, l = 0…order; k_0 = 1. A harmonic of degree l filtered
/// with the normalised kernel is k_l times itself.
std::vector<double> zonalCoefficients(const ZonalKernel& kernel, int order);

/// 2π ∫ k(θ) sinθ dθ [sr].
double zonalIntegral(const ZonalKernel& kernel);

}  // namespace nacre
