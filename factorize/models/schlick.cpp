// Schlick 1994, "An inexpensive BRDF model for physically-based rendering" (first 1993), a single layer:
//   f = kd/π + S(u) · G(v) G(v') Z(t) A(w) / (4π v v'),
//   u = cosθd, t = n·h, v = cosα, v' = cosβ, w = x component of h's normalised projection into the surface,
//   S(u) = f0 + (1 − f0)(1 − u)⁵,   Z(t) = r/(1 + r t² − t²)²,   A(w) = √(p/(p² − p² w² + w²)),   G(v) = v/(r − r v +
//   v)
// r: roughness, 1 = rough; p: isotropy, 1 = isotropic, smaller concentrates h perpendicular to the tangent.
// Z/π is normalised (∫ Z t dω = π; it is GGX's D at α² = r). A averages to 1 only for p = 1: its mean over the azimuth
// is (2/π) √p K(√(1 − p²)) ≤ 1, as published. A has no value at h = n; here it is 1. The paper's re-emission of the
// blocked light, (1 − G G')/(4π v v'), is left out: its albedo grows as 1/v at grazing angles. Pieces: fresnel S,
// distribution Z A/π, visibility G G'/(4 v v') = 1/(4 (r + (1 − r) v)(r + (1 − r) v')).
#include "core/fresnel.hpp"
#include "factorize/models/distributions.hpp"
#include "factorize/models/model_spec.hpp"

namespace nacre {
namespace {

struct SchlickReflectance {
    Rgb f0;
    Rgb operator()(double u) const { return fresnelSchlick(u, f0); }
};

struct SchlickDistribution {
    double r, p;
    double operator()(const Vec3& h) const {
        const double s2 = sinSquared(h), q = s2 + r * h.z * h.z;  // 1 + r t² − t², without the cancellation
        const double zenith = r / (kPi * q * q);
        if (s2 == 0.0) return zenith;
        const double w2 = h.x * h.x / s2;
        return zenith * std::sqrt(p / (p * p * (1.0 - w2) + w2));
    }
};

struct SchlickVisibility {
    double r;
    double operator()(const Vec3& wi, const Vec3& wo) const {
        return 0.25 / ((r + (1.0 - r) * wi.z) * (r + (1.0 - r) * wo.z));
    }
};

Reflectance schlick(const ParameterValues& values) {
    const double r = values.number("r"), p = values.number("p");
    Reflectance out;
    out.microfacet = setMicrofacet(out, SchlickReflectance{values.colour("f0")}, SchlickDistribution{r, p},
                                   SchlickVisibility{r}, ConstantDiffuse{values.colour("kd") / kPi});
    out.microfacet->alphaX = out.microfacet->alphaY = std::sqrt(r);
    out.isotropic = p == 1.0;
    return out;
}

}  // namespace

ModelSpec schlickModel() {
    return {"schlick",
            "rational functions in place of micro-facet terms",
            "Schlick 1993, 1994",
            {numberParameter("r", "roughness, 1 = rough; sqrt(r) is the width of the lobe", 1e-8, 1, "0.04"),
             numberParameter("p", "isotropy, 1 = isotropic", 0.01, 1, "1"),
             colourParameter("f0", "reflectance at normal incidence", 0, 1, "0.5"),
             colourParameter("kd", "diffuse albedo", 0, 1, "0")},
            schlick};
}

}  // namespace nacre
