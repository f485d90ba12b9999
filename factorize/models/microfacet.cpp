// The micro-facet family: f = kd/π + ks F(cosθd) D(h) G / (C cosα cosβ).
//
// The constant C. Facets with normals in dω_h about h cover the area D(h) dω_h per unit of surface; light from wi meets
// (wi·h) D dω_h dA of them, F of it is sent to wo, and dω_o = 4 (wo·h) dω_h. So, per projected area and solid angle,
// f = F D G (wi·h) / (cosα cosβ · 4 (wo·h)) = F D G / (4 cosα cosβ) with ∫ D cosδ dω = 1.
//   torrance-sparrow, ggx   C = 4, as derived (Torrance & Sparrow 1967; Walter 2007, eq. 20)
//   cook-torrance           C = π, as printed by Cook & Torrance 1982 and HSE eq. 1. With a normalised D it reflects
//   4/π
//                           of what the derivation allows, so it can exceed albedo 1; kept for comparison with pictures
//                           made by that formula, and with G of V-cavities by default, as published.
// D: beckmann, ggx, gaussian (distributions.hpp). G (geometry.hpp): smith = G1(wi) G1(wo), smith-correlated (GGX only),
// v-cavity. smith is exact for Beckmann and GGX; for `gaussian`, whose Λ has no closed form, it is Beckmann's at the
// same alpha. F (core/fresnel.hpp): dielectric (eta), conductor (eta, k), schlick (f0), none (F = 1); colours per
// channel.
#include "core/fresnel.hpp"
#include "factorize/models/distributions.hpp"
#include "factorize/models/geometry.hpp"
#include "factorize/models/model_spec.hpp"

namespace nacre {
namespace {

/// ks · F(cosθd); names are resolved once, in the constructor.
struct SpecularFresnel {
    enum class Kind { Dielectric, Conductor, Schlick, None } kind = Kind::None;
    Rgb ks, eta, k, f0;
    bool gray = false;  // one evaluation serves all channels

    explicit SpecularFresnel(const ParameterValues& p)
        : ks(p.colour("ks")), eta(p.colour("eta")), k(p.colour("k")), f0(p.colour("f0")) {
        const std::string& name = p.choice("f");
        kind = name == "dielectric"  ? Kind::Dielectric
               : name == "conductor" ? Kind::Conductor
               : name == "schlick"   ? Kind::Schlick
                                     : Kind::None;
        gray = eta == Rgb(eta.x) && (kind == Kind::Dielectric || k == Rgb(k.x));
    }
    double exact(double c, int i) const {
        return kind == Kind::Dielectric ? fresnelDielectric(c, eta[i]) : fresnelConductor(c, eta[i], k[i]);
    }
    Rgb operator()(double c) const {
        if (kind == Kind::None) return ks;
        if (kind == Kind::Schlick) return ks * fresnelSchlick(c, f0);
        if (gray) return ks * exact(c, 0);
        return ks * Rgb(exact(c, 0), exact(c, 1), exact(c, 2));
    }
};

/// Visibility with another constant in place of the 4.
template <class Visibility>
struct Scaled {
    double scale;
    Visibility visibility;
    double operator()(const Vec3& wi, const Vec3& wo) const { return scale * visibility(wi, wo); }
};

template <class Distribution, class Visibility>
Reflectance assemble(const ParameterValues& p, double constant, const Distribution& d, const Visibility& v) {
    Reflectance out;
    out.microfacet = setMicrofacet(out, SpecularFresnel(p), d, Scaled<Visibility>{4.0 / constant, v},
                                   ConstantDiffuse{p.colour("kd") / kPi});
    return out;
}

Reflectance finish(Reflectance out, double alphaX, double alphaY, bool elevationsAlone) {
    out.isotropic = alphaX == alphaY;
    out.microfacet->alphaX = alphaX;
    out.microfacet->alphaY = alphaY;
    out.microfacet->visibilityIsIsotropic = elevationsAlone && alphaX == alphaY;
    return out;
}

template <class Smith, class Distribution>
Reflectance isotropicFacets(const ParameterValues& p, double constant, const Distribution& d, const Smith& smith) {
    const double alpha = p.number("alpha");
    if (p.choice("g") == "smith") return finish(assemble(p, constant, d, smith), alpha, alpha, true);
    return finish(assemble(p, constant, d, VCavity{}), alpha, alpha, false);
}

Reflectance torranceSparrow(const ParameterValues& p, double constant) {
    const double alpha = p.number("alpha");
    const std::string& d = p.choice("d");
    if (d == "ggx") return isotropicFacets(p, constant, GgxDistribution{alpha, alpha}, GgxSmith{alpha, alpha});
    if (d == "gaussian") return isotropicFacets(p, constant, GaussianDistribution(alpha), BeckmannSmith{alpha});
    return isotropicFacets(p, constant, BeckmannDistribution{alpha}, BeckmannSmith{alpha});
}

Reflectance anisotropicGgx(const ParameterValues& p) {
    const double ax = p.number("alphax"), ay = p.number("alphay");
    const GgxDistribution d{ax, ay};
    if (p.choice("g") == "smith") return finish(assemble(p, 4.0, d, GgxSmith{ax, ay}), ax, ay, true);
    return finish(assemble(p, 4.0, d, GgxSmithCorrelated{ax, ay}), ax, ay, true);
}

std::vector<ParameterSpec> surfaceParameters() {
    return {choiceParameter("f", "Fresnel reflectance", {"dielectric", "conductor", "schlick", "none"}, "dielectric"),
            colourParameter("eta", "index of refraction (dielectric, conductor)", 0.01, 200, "1.5"),
            colourParameter("k", "extinction (conductor)", 0, 200, "3"),
            colourParameter("f0", "reflectance at normal incidence (schlick)", 0, 1, "0.04"),
            colourParameter("ks", "factor of the specular term", 0, 1, "1"),
            colourParameter("kd", "diffuse albedo", 0, 1, "0")};
}

std::vector<ParameterSpec> torranceSparrowParameters(const std::string& defaultG) {
    std::vector<ParameterSpec> list = {
        choiceParameter("d", "distribution of facets", {"beckmann", "ggx", "gaussian"}, "beckmann"),
        choiceParameter("g", "masking and shadowing", {"smith", "v-cavity"}, defaultG),
        numberParameter("alpha", "roughness: width of the distribution", 1e-4, 1, "0.2")};
    for (ParameterSpec& spec : surfaceParameters()) list.push_back(std::move(spec));
    return list;
}

std::vector<ParameterSpec> ggxParameters() {
    std::vector<ParameterSpec> list = {
        choiceParameter("g", "masking and shadowing", {"smith-correlated", "smith"}, "smith-correlated"),
        numberParameter("alphax", "roughness along the tangent", 1e-4, 1, "0.2"),
        numberParameter("alphay", "roughness along the bitangent", 1e-4, 1, "0.2"),
        shorthand("alpha", "roughness both ways", 1e-4, 1, {"alphax", "alphay"})};
    for (ParameterSpec& spec : surfaceParameters()) list.push_back(std::move(spec));
    return list;
}

}  // namespace

std::vector<ModelSpec> microfacetModels() {
    return {{"torrance-sparrow", "micro-facets, F D G / (4 cos cos)", "Torrance & Sparrow 1967; HSE eq. 1",
             torranceSparrowParameters("smith"), [](const ParameterValues& p) { return torranceSparrow(p, 4.0); }},
            {"cook-torrance", "micro-facets with the published constant, F D G / (pi cos cos)", "Cook & Torrance 1982",
             torranceSparrowParameters("v-cavity"), [](const ParameterValues& p) { return torranceSparrow(p, kPi); }},
            {"ggx", "anisotropic micro-facets, F D G / (4 cos cos)", "Walter 2007; Heitz 2014", ggxParameters(),
             anisotropicGgx}};
}

}  // namespace nacre
