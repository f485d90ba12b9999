// Lambert, and the models with one cosine power.
//   lambert      f = kd/π
//   phong        f = kd/π + ks (n + 2)/(2π) max(0, r·wo)^n,   r = mirror of wi: r·wo = −wi.x wo.x − wi.y wo.y + wi.z
//   wo.z
//                Phong 1975 with Lewis 1993's factor: at normal incidence ∫ f cosθ dω = kd + ks, less elsewhere.
//   blinn-phong  f = kd/π + ks N (n·h)^n,   N = (n + 2)(n + 4) / (8π (n + 2^(−n/2)))
//                Blinn 1977. N makes the albedo at normal incidence kd + ks: with wo = n and wi at twice the angle δ of
//                h, ∫ (n·h)^n cosθ dω = 8π ∫_{1/√2}^1 u^(n+1) (2u² − 1) du = 1/N. (n + 8)/(8π) is its usual
//                approximation.
//   cosine-lobe  f = kd/π + ks (n + 2)/(2π) max(0, cx wi.x wo.x + cy wi.y wo.y + cz wi.z wo.z)^n
//                Lafortune 1997 eq. 6, with Lewis's factor and coefficients in [-1, 1]; (−1, −1, 1) is phong. The
//                largest coefficient is not scaled to 1: |C| < 1 dims the lobe by |C|^n, as the formula says. cxy sets
//                cx and cy.
// `ambient` is a radiance added after shading: it is in SingleLobePieces, never in f.
#include "core/directions.hpp"
#include "factorize/models/model_spec.hpp"

namespace nacre {

constexpr double kMaxExponent = 1e6;

/// scale · s^n for s > 0, else 0 (pow(0, 0) is 1, and n = 0 must stay a hemisphere). s is at most 1 but for rounding.
struct PowerLobe {
    Rgb scale;
    double exponent;
    Rgb operator()(double s) const { return s > 0 ? scale * std::pow(std::min(s, 1.0), exponent) : Rgb(0); }
};

static double lewisFactor(double n) { return (n + 2.0) / (2.0 * kPi); }

static double blinnFactor(double n) { return (n + 2.0) * (n + 4.0) / (8.0 * kPi * (n + std::exp2(-0.5 * n))); }

static Reflectance singleLobe(const ParameterValues& p, const PowerLobe& lobe) {
    Reflectance out;
    SingleLobePieces pieces;
    pieces.lobe = lobe;
    pieces.exponent = lobe.exponent;
    pieces.diffuse = p.colour("kd") / kPi;
    pieces.ambient = p.colour("ambient");
    out.singleLobe = pieces;
    return out;
}

static Reflectance axisLobe(const ParameterValues& p, const Vec3& axis) {
    const PowerLobe lobe{p.colour("ks") * lewisFactor(p.number("n")), p.number("n")};
    Reflectance out = singleLobe(p, lobe);
    out.singleLobe->argument = SingleLobePieces::Argument::Axis;
    out.singleLobe->axis = axis;
    out.isotropic = axis.x == axis.y;
    out.f = [lobe, axis, diffuse = out.singleLobe->diffuse](const Vec3& wi, const Vec3& wo) {
        return aboveHorizon(wi, wo) ? diffuse + lobe(glm::dot(axis, wi * wo)) : Rgb(0);
    };
    return out;
}

static Reflectance blinnPhong(const ParameterValues& p) {
    const PowerLobe lobe{p.colour("ks") * blinnFactor(p.number("n")), p.number("n")};
    Reflectance out = singleLobe(p, lobe);
    out.singleLobe->argument = SingleLobePieces::Argument::Half;
    out.f = [lobe, diffuse = out.singleLobe->diffuse](const Vec3& wi, const Vec3& wo) {
        return aboveHorizon(wi, wo) ? diffuse + lobe(halfVector(wi, wo).z) : Rgb(0);
    };
    return out;
}

static Reflectance lambert(const ParameterValues& p) {
    Reflectance out;
    const Rgb diffuse = p.colour("kd") / kPi;
    out.f = [diffuse](const Vec3& wi, const Vec3& wo) { return aboveHorizon(wi, wo) ? diffuse : Rgb(0); };
    SingleLobePieces pieces;
    pieces.lobe = [](double) { return Rgb(0); };
    pieces.diffuse = diffuse;
    out.singleLobe = pieces;
    return out;
}

static std::vector<ParameterSpec> lobeParameters() {
    return {colourParameter("kd", "diffuse albedo", 0, 1, "0"),
            colourParameter("ks", "specular albedo at normal incidence", 0, 1, "1"),
            numberParameter("n", "exponent of the cosine", 0, kMaxExponent, "50"),
            colourParameter("ambient", "radiance added to every shaded point; not part of the BRDF", 0, 1, "0")};
}

static std::vector<ParameterSpec> cosineLobeParameters() {
    std::vector<ParameterSpec> list = lobeParameters();
    list.push_back(numberParameter("cx", "weight of wi.x wo.x", -1, 1, "-1"));
    list.push_back(numberParameter("cy", "weight of wi.y wo.y", -1, 1, "-1"));
    list.push_back(shorthand("cxy", "weight of wi.x wo.x + wi.y wo.y", -1, 1, {"cx", "cy"}));
    list.push_back(numberParameter("cz", "weight of wi.z wo.z", -1, 1, "1"));
    return list;
}

std::vector<ModelSpec> phongModels() {
    return {
        {"lambert", "constant", "Lambert 1760", {colourParameter("kd", "diffuse albedo", 0, 1, "0.5")}, lambert},
        {"phong", "cosine power about the mirror direction", "Phong 1975; normalised as Lewis 1993", lobeParameters(),
         [](const ParameterValues& p) { return axisLobe(p, Vec3(-1, -1, 1)); }},
        {"blinn-phong", "cosine power about the half vector", "Blinn 1977; normalised at normal incidence",
         lobeParameters(), blinnPhong},
        {"cosine-lobe", "cosine power about a generalised axis", "Lafortune 1997", cosineLobeParameters(),
         [](const ParameterValues& p) { return axisLobe(p, Vec3(p.number("cx"), p.number("cy"), p.number("cz"))); }}};
}

}  // namespace nacre
