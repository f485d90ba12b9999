// Ashikhmin & Shirley 2000, "An anisotropic Phong BRDF model":
//   f = ρd + ρs,
//   ρs = √((nu+1)(nv+1))/(8π) · (n·h)^e · F(h·w) / ((h·w) max(cosα, cosβ)),   e = (nu h.x² + nv h.y²)/(1 − h.z²)   (eq.
//   4) F  = rs + (1 − rs)(1 − h·w)⁵                                                                                (eq.
//   3) ρd = 28 rd/(23π) (1 − rs)(1 − (1 − cosα/2)⁵)(1 − (1 − cosβ/2)⁵)                                             (eq.
//   5)
// h·w = wi·h = wo·h = cosθd; nu goes with the tangent x, nv with the bitangent y.
// Pieces: distribution = √((nu+1)(nv+1))/(2π) · (n·h)^e, whose ∫ D cosδ dω is (n + 1)/(n + 2) for nu = nv = n as
// published; fresnel = F/cosθd; visibility = 1/(4 max(cosα, cosβ)); diffuse = ρd, which depends on both directions.
#include "core/fresnel.hpp"
#include "factorize/models/distributions.hpp"
#include "factorize/models/model_spec.hpp"

namespace nacre {
namespace {

/// (n·h)^e through e·log(h.z) = (nu h.x² + nv h.y²) · log(1 − s²)/(2 s²), s² = sin²δ: no 0/0 at the pole.
struct PhongEllipse {
    double nu, nv, scale;
    double operator()(const Vec3& h) const {
        const double s2 = sinSquared(h);
        if (s2 == 0.0) return scale;
        const double logCos = s2 < 0.5 ? 0.5 * std::log1p(-s2) : std::log(std::max(h.z, 1e-300));
        return scale * expNegative((nu * h.x * h.x + nv * h.y * h.y) * (-logCos / s2));
    }
};

/// F(cosθd)/cosθd. Pairs above kHorizon have cosθd ≥ kHorizon: the bound only keeps a caller's exact 0 finite.
struct FresnelOverCos {
    Rgb rs;
    Rgb operator()(double c) const { return fresnelSchlick(c, rs) / std::max(c, kHorizon); }
};

struct MaxVisibility {
    double operator()(const Vec3& wi, const Vec3& wo) const { return 0.25 / std::max(wi.z, wo.z); }
};

struct CoupledDiffuse {
    Rgb scale;
    static double rise(double c) { return 1.0 - schlickWeight(0.5 * c); }
    Rgb operator()(const Vec3& wi, const Vec3& wo) const { return scale * (rise(wi.z) * rise(wo.z)); }
};

Reflectance ashikhminShirley(const ParameterValues& p) {
    const double nu = p.number("nu"), nv = p.number("nv");
    const Rgb rs = p.colour("rs"), rd = p.colour("rd");
    const PhongEllipse d{nu, nv, std::sqrt((nu + 1.0) * (nv + 1.0)) / (2.0 * kPi)};
    const CoupledDiffuse diffuse{28.0 / (23.0 * kPi) * rd * (Rgb(1.0) - rs)};
    Reflectance out;
    out.microfacet = setMicrofacet(out, FresnelOverCos{rs}, d, MaxVisibility{}, diffuse);
    // (cosδ)^n ≈ exp(−n tan²δ/2) is Beckmann's exp(−tan²δ/α²)/cos⁴δ for α² = 2/(n + 2) near the pole
    out.microfacet->alphaX = std::sqrt(2.0 / (nu + 2.0));
    out.microfacet->alphaY = std::sqrt(2.0 / (nv + 2.0));
    out.microfacet->diffuseIsConstant = rd == Rgb(0);
    out.isotropic = nu == nv;
    return out;
}

}  // namespace

ModelSpec ashikhminShirleyModel() {
    return {"ashikhmin-shirley",
            "anisotropic Phong with Fresnel and a coupled diffuse term",
            "Ashikhmin & Shirley 2000",
            {numberParameter("nu", "exponent along the tangent", 0, 1e6, "100"),
             numberParameter("nv", "exponent along the bitangent", 0, 1e6, "100"),
             shorthand("n", "exponent both ways", 0, 1e6, {"nu", "nv"}),
             colourParameter("rs", "specular reflectance at normal incidence", 0, 1, "0.5"),
             colourParameter("rd", "diffuse reflectance", 0, 1, "0")},
            ashikhminShirley};
}

}  // namespace nacre
