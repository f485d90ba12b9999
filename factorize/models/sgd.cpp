#include "factorize/models/sgd.hpp"

#include "core/fresnel.hpp"
#include "factorize/models/distributions.hpp"
#include "factorize/models/model_spec.hpp"

namespace nacre {

/// `theta` [rad] from the normal.
static double sgdMasking(const SgdMaterial& m, int i, double theta) {
    const double excess = theta - m.theta0[i];
    if (excess <= 0.0) return 1.0;
    return clamp01(1.0 - m.lambda[i] * std::expm1(m.c[i] * std::pow(excess, m.k[i])));
}

static double sgdDistribution(const SgdMaterial& m, int i, double tan2, double cos4) {
    const double y = m.alpha[i] + tan2 / m.alpha[i];
    return m.kap[i] * expNegative(y + m.p[i] * std::log(y)) / (kPi * cos4);
}

static double sgdFresnel(const SgdMaterial& m, int i, double c) {
    return std::max(0.0, m.f0[i] - m.f1[i] * c + (1.0 - m.f0[i]) * schlickWeight(c));
}

Rgb evaluateSgd(const SgdMaterial& m, const Vec3& wi, const Vec3& wo) {
    if (!aboveHorizon(wi, wo)) return Rgb(0);
    const Vec3 sum = wi + wo;
    const double length = glm::length(sum), cosD = std::min(1.0, 0.5 * length);
    const Vec3 h = sum / length;
    const double cos2 = h.z * h.z, tan2 = sinSquared(h) / cos2;
    const double alpha = std::atan2(std::sqrt(sinSquared(wi)), wi.z),
                 beta = std::atan2(std::sqrt(sinSquared(wo)), wo.z);
    Rgb out = m.rhoD / kPi;
    for (int i = 0; i < 3; ++i) {
        const double d = sgdDistribution(m, i, tan2, cos2 * cos2);
        if (d == 0.0) continue;  // far from the lobe: spares the masking
        const double g = sgdMasking(m, i, alpha) * sgdMasking(m, i, beta);
        out[i] += m.rhoS[i] * sgdFresnel(m, i, cosD) * d * g / (kPi * wi.z * wo.z);
    }
    return out;
}

static Reflectance sgd(const ParameterValues& p) {
    Reflectance out;
    for (const SgdMaterial& material : sgdMaterials())
        if (material.name == p.choice("material"))
            out.f = [material](const Vec3& wi, const Vec3& wo) { return evaluateSgd(material, wi, wo); };
    return out;
}

ModelSpec sgdModel() {
    std::vector<std::string> names;
    for (const SgdMaterial& material : sgdMaterials()) names.push_back(material.name);
    return {"sgd",
            "published fits of measured materials (MERL); sgd:NAME is short for sgd:material=NAME",
            "Bagher, Soler & Holzschuch 2012",
            {choiceParameter("material", "measured material", names, "gold-paint")},
            sgd,
            "material"};
}

}  // namespace nacre
