// Banks 1994 for a surface of fibres along the tangent t (the x axis), HSE eq. 4 without its cosα (which is the cosine
// of the rendering equation):
//   f = kd (n'·l) + ks (n'·h)^n,   n = 1/r in HSE
// n' is the projection of l into the plane perpendicular to t, so n'·l = √(1 − (t·l)²) =: sl.
// n'·h taken literally also depends on the azimuth of v about the fibre. A fibre has every normal perpendicular to t,
// and the highlight is that of the normal where it is brightest: there v lies in the plane of t and l. Then l = (t·l,
// sl), v = (t·v, sv) in that plane, at angles φl = asin(t·l) and φv = asin(t·v) from n', and h is halfway:
//   n'·h = cos((φl + φv)/2) = √((1 + sl sv − (t·l)(t·v))/2)
// which is a function of t·l and t·v alone, as HSE says after [28] (Zöckler, Stalling & Hege 1996).
// An ad-hoc model: kd and ks are values of f [1/sr], not albedos, and the kd term is not reciprocal.
#include "factorize/models/model_spec.hpp"

namespace nacre {
namespace {

struct BanksValue {
    Rgb kd, ks;
    double exponent;
    /// √(1 − t²), for |t| ≤ 1 but for rounding.
    static double sine(double t) { return std::sqrt(std::max(0.0, (1.0 - t) * (1.0 + t))); }
    Rgb operator()(double tl, double tv) const {
        const double sl = sine(tl), cos2 = clamp01(0.5 * (1.0 + sl * sine(tv) - tl * tv));
        return kd * sl + ks * std::pow(cos2, 0.5 * exponent);
    }
};

Reflectance banks(const ParameterValues& p) {
    const BanksValue value{p.colour("kd"), p.colour("ks"), p.number("n")};
    Reflectance out;
    out.f = [value](const Vec3& wi, const Vec3& wo) { return aboveHorizon(wi, wo) ? value(wi.x, wo.x) : Rgb(0); };
    out.tangent = TangentPieces{value, value.exponent};
    out.isotropic = false;
    return out;
}

}  // namespace

ModelSpec banksModel() {
    return {"banks",
            "fibres along the tangent, brightest normal (not reciprocal)",
            "Banks 1994; HSE eq. 4",
            {colourParameter("kd", "diffuse factor [1/sr]", 0, 10, "0.1"),
             colourParameter("ks", "specular factor [1/sr]", 0, 10, "0.5"),
             numberParameter("n", "exponent", 1e-6, 1e6, "30"),
             shorthand("r", "roughness, n = 1/r", 1e-6, 1e6, {"n"}, true)},
            banks};
}

}  // namespace nacre
