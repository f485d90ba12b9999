#include "reference/fresnel_error.hpp"

#include "core/fresnel.hpp"
#include "reference/microfacet_terms.hpp"

namespace nacre {

namespace {
struct Tally {
    double squares = 0;
    TableError error;
    void add(double difference) {
        error.maxAbs = std::max(error.maxAbs, std::abs(difference));
        squares += difference * difference;
        ++error.samples;
    }
    TableError result() {
        error.rms = std::sqrt(squares / error.samples);
        return error;
    }
};

/// With h = (slope t = α s, azimuth φ): D cosθh dωh = 2s/(1 + s²)² ds dφ/2π, dωl = 4 v·h dωh.
ScaleBias integrate(double cosV, double alpha) {
    constexpr int kRadii = 400, kAngles = 128;
    const Vec3 v(std::sqrt(1 - cosV * cosV), 0, cosV);
    const double lambdaV = terms::ggxLambda(std::acos(cosV), 0, alpha, alpha);
    ScaleBias out{0, 0};
    for (int i = 0; i < kRadii; ++i) {
        const double rest = 1 - (i + 0.5) / kRadii, share = 3 * rest * rest / kRadii;  // 1 − cumulative D cosθ = rest³
        const double cumulative = 1 - rest * rest * rest,
                     theta = std::atan(alpha * std::sqrt(cumulative / (1 - cumulative)));
        for (int j = 0; j < kAngles; ++j) {
            const double phi = 2 * kPi * (j + 0.5) / kAngles;
            const Vec3 h(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
            const double voh = glm::dot(v, h), cosL = 2 * voh * h.z - cosV;
            if (voh <= 0 || cosL <= 0) continue;
            const double g = 1 / (1 + lambdaV + terms::ggxLambda(std::acos(std::min(1.0, cosL)), 0, alpha, alpha));
            const double weight = g * voh / (cosV * h.z) * share / kAngles, fresnel = schlickWeight(voh);
            out.scale += weight * (1 - fresnel);
            out.bias += weight * fresnel;
        }
    }
    return out;
}
}  // namespace

TableError measureFresnel(const AssetTexture& table, const FresnelIndex& index) {
    constexpr int kAngles = 2000;
    Tally tally;
    for (int i = 0; i < kAngles; ++i) {
        const double theta = kPi / 2 * (i + 0.5) / kAngles;
        const Rgb found = lookupFresnel(table, std::cos(theta));
        for (int c = 0; c < 3; ++c) tally.add(found[c] - terms::fresnel(theta, index.eta[c], index.k[c]));
    }
    return tally.result();
}

TableError measureScaleBias(const AssetTexture& table) {
    Tally tally;
    for (const double alpha : {0.02, 0.07, 0.19, 0.37, 0.66, 1.0})
        for (const double cosV : {0.02, 0.11, 0.29, 0.53, 0.81, 1.0}) {
            const ScaleBias found = lookupScaleBias(table, cosV, std::sqrt(alpha)), expected = integrate(cosV, alpha);
            tally.add(found.scale - expected.scale);
            tally.add(found.bias - expected.bias);
        }
    return tally.result();
}

}  // namespace nacre
